//! Places in documents: paths like `parameters[2].lower`, what stands there, and another value put there.
//!
//! In reports, whose lists have no fixed order, an entry may be named by what it holds: `design[name=big_end.width].value`, also by
//! several keys: `constraints[quantity=specific-load,bearing=main].value`.

use serde_json::Value;

/// One step of a path.
#[derive(Debug, PartialEq, Eq)]
enum Step<'a> {
    /// A key of a table.
    Key(&'a str),
    /// An entry of a list by its number.
    Entry(usize),
    /// The first entry of a list that has keys with these texts.
    Holding(Vec<(&'a str, &'a str)>),
}

/// The steps of a path; none if it is not well written.
fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    let (mut all, mut rest) = (Vec::new(), path);
    while !rest.is_empty() {
        if let Some(inside) = rest.strip_prefix('[') {
            let end = inside.find(']')?;
            let (entry, behind) = (&inside[..end], &inside[end + 1..]);
            all.push(match entry.contains('=') {
                true => Step::Holding(
                    entry
                        .split(',')
                        .map(|one| one.split_once('=').map(|(key, text)| (key.trim(), text.trim())))
                        .collect::<Option<_>>()?,
                ),
                false => Step::Entry(entry.trim().parse().ok()?),
            });
            rest = behind.strip_prefix('.').unwrap_or(behind);
        } else {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            all.push(Step::Key(&rest[..end]));
            rest = &rest[end..];
            rest = rest.strip_prefix('.').unwrap_or(rest);
        }
    }
    Some(all)
}

fn holds(entry: &Value, wanted: &[(&str, &str)]) -> bool {
    wanted.iter().all(|(key, text)| entry.get(key).and_then(Value::as_str) == Some(text))
}

/// What stands at a path.
pub(super) fn find<'v>(root: &'v Value, path: &str) -> Option<&'v Value> {
    let mut at = root;
    for step in steps(path)? {
        at = match step {
            Step::Key(key) => at.get(key)?,
            Step::Entry(k) => at.get(k)?,
            Step::Holding(wanted) => at.as_array()?.iter().find(|v| holds(v, &wanted))?,
        };
    }
    Some(at)
}

/// Puts a value at a path. Sections on the way that are not written are made, but no bearing is; lists must be long enough.
pub(super) fn put(root: &mut Value, path: &str, value: Value) -> Option<()> {
    let steps = steps(path)?;
    if steps.is_empty() {
        return None;
    }
    let named = |step: Option<&Step<'_>>, table: &Value| match step {
        Some(Step::Key(name)) => table.get(name).is_some(),
        _ => true,
    };
    if steps[0] == Step::Key("bearings") && steps.len() > 2 && !named(steps.get(1), &root["bearings"]) {
        return None;
    }
    let mut at = root;
    for step in steps {
        if at.is_null() {
            *at = Value::Object(serde_json::Map::new());
        }
        at = match (step, at) {
            (Step::Key(key), Value::Object(map)) => map.entry(key).or_insert(Value::Null),
            (Step::Entry(k), Value::Array(list)) => list.get_mut(k)?,
            (Step::Holding(wanted), Value::Array(list)) => list.iter_mut().find(|v| holds(v, &wanted))?,
            _ => return None,
        };
    }
    *at = value;
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn entries_are_found_by_key_by_number_and_by_what_they_hold() {
        let value = json!({ "a": { "b": [1, { "name": "x.y", "v": 2 }, { "name": "z", "v": [3] }] } });
        assert_eq!(find(&value, "a.b[0]"), Some(&json!(1)));
        assert_eq!(find(&value, "a.b[name=x.y].v"), Some(&json!(2)));
        assert_eq!(find(&value, "a.b[2].v[0]"), Some(&json!(3)));
        let list = json!([{ "a": "1", "b": "1" }, { "a": "1", "b": "2" }]);
        assert_eq!(find(&list, "[a=1, b=2]"), Some(&list[1]));
        for nowhere in ["a.c", "a.b[9]", "a.b[name=q].v", "a.b[", "a.b[x]", "a.b[name=z,v]", "a[0]"] {
            assert_eq!(find(&value, nowhere), None, "{nowhere}");
        }
    }

    #[test]
    fn values_are_put_where_there_is_a_place() {
        let mut value = json!({ "a": [{ "name": "x" }] });
        assert!(put(&mut value, "s.t", json!("u")).is_some());
        assert!(put(&mut value, "a[name=x].v", json!(1)).is_some());
        assert_eq!(value, json!({ "a": [{ "name": "x", "v": 1 }], "s": { "t": "u" } }));
        for nowhere in ["", "bearings.x.width", "a[1].v", "s.t.u", "a.b", "a[name=q]"] {
            assert_eq!(put(&mut value, nowhere, json!(0)), None, "{nowhere}");
        }
    }
}
