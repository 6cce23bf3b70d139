//! JSON Schema of the study file: made from the types, with the keys that must be there.

use super::StudyFile;
use serde_json::{Value, json};

/// Keys without a default, by section.
const REQUIRED: &[(&str, &[&str])] = &[
    ("StudyFile", &["format", "title", "bearings", "oil"]),
    ("MachineFile", &["bore", "throw", "oscillating_mass", "rotating_mass"]),
    ("CylinderPressureFile", &["source"]),
    ("BearingFile", &["kind", "width", "diameter", "diametral_clearance"]),
    ("OilFile", &["inlet_temperature"]),
    ("ViscosityPointFile", &["temperature", "dynamic_viscosity"]),
    ("GradeFile", &["kinematic_viscosity_40c", "kinematic_viscosity_100c", "density_15c"]),
    ("SupplyFile", &["pressure", "openings"]),
    ("OpeningFile", &["kind"]),
    ("RoughnessFile", &["journal", "shell"]),
    ("ShapeFile", &["name", "kind"]),
    ("CharacteristicFile", &["vary"]),
    ("ObjectiveFile", &["operating_points"]),
    ("OperatingPointFile", &["name", "speed"]),
    ("ParameterFile", &["name", "lower", "upper"]),
    ("ConstraintFile", &["quantity"]),
];

/// JSON Schema (2020-12) of the study file. What depends on several keys is left to the check.
pub fn schema() -> Value {
    let mut schema = schemars::schema_for!(StudyFile).to_value();
    without_null_defaults(&mut schema);
    for (section, keys) in REQUIRED {
        let at = match *section {
            "StudyFile" => Some(&mut schema),
            name => schema.get_mut("$defs").and_then(|d| d.get_mut(name)),
        };
        if let Some(object) = at {
            object["required"] = json!(keys);
        }
    }
    // A study searches a design (or compares engines at its start), or tabulates a characteristic.
    schema["anyOf"] =
        json!([{ "required": ["objective", "parameters"] }, { "required": ["characteristic"] }]);
    schema["properties"]["format"]["const"] = json!(super::FORMAT);
    schema
}

/// An absent key has no value, not the value null.
fn without_null_defaults(value: &mut Value) {
    match value {
        Value::Object(map) => {
            if map.get("default").is_some_and(Value::is_null) {
                map.remove("default");
            }
            map.values_mut().for_each(without_null_defaults);
        }
        Value::Array(list) => list.iter_mut().for_each(without_null_defaults),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn required_keys_exist() {
        let schema = schema();
        for (section, keys) in REQUIRED {
            let object = if *section == "StudyFile" { &schema } else { &schema["$defs"][*section] };
            for key in *keys {
                assert!(object["properties"].get(*key).is_some(), "{section}.{key}");
            }
        }
        assert!(!schema.to_string().contains("\"default\":null"));
    }
}
