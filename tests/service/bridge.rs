//! UM-Bridge: studies as functions.

use super::common::{Service, tiny};
use serde_json::{Value, json};

/// The example with a short-bearing film.
fn smooth() -> String {
    let without = |text: &str, section: &str| {
        let from = text.find(section).unwrap();
        let to = text[from + 1..].find("\n[").map_or(text.len(), |k| from + 1 + k);
        format!("{}{}", &text[..from], &text[to..])
    };
    let mut text = tiny();
    for section in [
        "\n[bearings.big_end.supply]",
        "\n[[bearings.big_end.supply.openings]]",
        "\n[bearings.big_end.roughness]",
    ] {
        text = without(&text, section);
    }
    text.replace("cells_around = 36\ncells_across_half = 3", "model = \"mobility\"")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

#[test]
fn a_stored_study_is_a_function_with_its_derivatives() {
    let service = Service::start(0);
    // Without cells there are no kinks that a difference could cross.
    let name = service.submit(&json!({ "study": smooth() }));
    let info = service.get("/Info").ok(200);
    assert_eq!(info, json!({ "protocolVersion": 1.0, "models": [name] }));
    let ask = |what: &str, more: Value| {
        let mut body = json!({ "name": name, "config": {} });
        body.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        service.post(&format!("/{what}"), &body).ok(200)
    };
    assert_eq!(ask("ModelInfo", json!({}))["support"]["ApplyHessian"], true);
    assert_eq!(ask("InputSizes", json!({})), json!({ "inputSizes": [2] }));
    assert_eq!(ask("OutputSizes", json!({})), json!({ "outputSizes": [3] }));
    let x = [210.0, 92.0];
    let values = |x: [f64; 2]| numbers(&ask("Evaluate", json!({ "input": [x] }))["output"][0]);
    let gradient = |x: [f64; 2], sens: [f64; 3]| {
        numbers(&ask("Gradient", json!({ "outWrt": 0, "inWrt": 0, "input": [x], "sens": sens }))["output"])
    };
    let (y, sens) = (values(x), [1.0, 100.0, -3.0]);
    assert!(y[0] > 100.0 && y[1] > 0.1 && y[1] < 20.0 && y[2] > 1.0, "{y:?}");
    let vec = [0.7, -0.2];
    let along = numbers(
        &ask("ApplyJacobian", json!({ "outWrt": 0, "inWrt": 0, "input": [x], "vec": vec }))["output"],
    );
    let (h, ahead) = (1e-3, |s: f64| [x[0] + s * vec[0], x[1] + s * vec[1]]);
    let (low, high) = (values(ahead(-h)), values(ahead(h)));
    for q in 0..3 {
        let difference = (high[q] - low[q]) / (2.0 * h);
        assert!((along[q] - difference).abs() < 1e-4 * along[q].abs(), "{q}: {} {difference}", along[q]);
    }
    // Gradient and Jacobian are the same numbers.
    let (g, sum) = (gradient(x, sens), (0..3).map(|q| sens[q] * along[q]).sum::<f64>());
    assert!((g[0] * vec[0] + g[1] * vec[1] - sum).abs() < 1e-9 * sum.abs());
    let hessian = |sens: [f64; 3], vec: [f64; 2]| {
        let more = json!({ "outWrt": 0, "inWrt1": 0, "inWrt2": 0, "input": [x], "sens": sens, "vec": vec });
        numbers(&ask("ApplyHessian", more)["output"])
    };
    let (a, b) = (hessian(sens, [1.0, 0.0]), hessian(sens, [0.0, 1.0]));
    assert!((a[1] - b[0]).abs() < 1e-5 * a[1].abs().max(b[0].abs()), "symmetric: {a:?} {b:?}");
    assert_eq!(hessian(sens, [0.0, 0.0]), [0.0, 0.0]);
    let (h, loss) = (1e-2, [1.0, 0.0, 0.0]);
    let (low, high, a) =
        (gradient([x[0] - h, x[1]], loss), gradient([x[0] + h, x[1]], loss), hessian(loss, [1.0, 0.0]));
    for j in 0..2 {
        let difference = (high[j] - low[j]) / (2.0 * h);
        println!("{j}: {} {difference}", a[j]);
        assert!((a[j] - difference).abs() < 1e-4 * a[j].abs(), "{j}: {} {difference}", a[j]);
    }
}

#[test]
fn refusals_have_the_form_of_the_protocol() {
    let service = Service::start(0);
    let name = service.submit(&json!({ "study": tiny() }));
    let x = json!([[210.0, 92.0]]);
    for (what, body, kind) in [
        ("Evaluate", json!({ "name": "nobody", "input": x }), "ModelNotFound"),
        ("Evaluate", json!({ "input": x }), "InvalidInput"),
        ("Evaluate", json!({ "name": name, "input": [210.0, 92.0] }), "InvalidInput"),
        ("Evaluate", json!({ "name": name, "input": [[210.0]] }), "InvalidInput"),
        ("Evaluate", json!({ "name": name, "input": [[210.0, -5.0]] }), "InvalidEvaluation"),
        (
            "Gradient",
            json!({ "name": name, "input": x, "outWrt": 1, "inWrt": 0, "sens": [1, 0, 0] }),
            "InvalidInput",
        ),
        (
            "Gradient",
            json!({ "name": name, "input": x, "outWrt": 0, "inWrt": 0, "sens": [1] }),
            "InvalidInput",
        ),
        ("ApplyJacobian", json!({ "name": name, "input": x, "outWrt": 0, "inWrt": 0 }), "InvalidInput"),
    ] {
        let answer = service.post(&format!("/{what}"), &body);
        assert_eq!(answer.status, 400, "{}", answer.text);
        assert_eq!(answer.json()["error"]["type"], kind, "{what} {body}: {}", answer.text);
    }
    let study = format!(
        "{}\n[running_in]\nminimise = \"mean-loss\"\n[[running_in.stages]]\nname = \"rated\"\nduration = \"1 h\"\nspeed = \"1000 rpm\"\n",
        tiny()
    );
    let name = service.submit(&json!({ "study": study }));
    let answer = service.post("/Evaluate", &json!({ "name": name, "input": x }));
    assert_eq!(answer.json()["error"]["type"], "UnsupportedFeature", "{}", answer.text);
}
