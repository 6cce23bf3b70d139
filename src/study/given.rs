//! A key of a study file: absent, given, or given wrongly. Keeps a mistake instead of failing, so all can be reported.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Longest piece of a wrong value that is quoted back.
const QUOTED: usize = 60;

/// Keys of a section that nobody knows.
pub type Unknown = BTreeMap<String, Value>;

/// Value of a key.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Given<T> {
    /// The key is not there.
    #[default]
    Absent,
    /// The key has a value of the right kind.
    Value(T),
    /// The key has a value that does not fit.
    Wrong {
        /// What was found, shortened.
        found: String,
        /// Why it does not fit.
        problem: String,
    },
}

impl<T> Given<T> {
    /// The value, if there is a good one.
    pub fn value(&self) -> Option<&T> {
        match self {
            Self::Value(v) => Some(v),
            _ => None,
        }
    }

    /// Whether the key is not there.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Absent)
    }
}

impl<'de, T: for<'a> Deserialize<'a>> Deserialize<'de> for Given<T> {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(d)?;
        let found = shortened(&value);
        Ok(T::deserialize(value)
            .map_or_else(|e| Self::Wrong { found, problem: plain(&e.to_string()) }, Self::Value))
    }
}

impl<T: Serialize> Serialize for Given<T> {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Value(v) => v.serialize(s),
            _ => s.serialize_none(),
        }
    }
}

impl<T: JsonSchema> JsonSchema for Given<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }

    fn inline_schema() -> bool {
        T::inline_schema()
    }
}

/// serde's words for users who do not write Rust.
fn plain(problem: &str) -> String {
    let expected = problem.rsplit("expected ").next().unwrap_or_default();
    if problem.starts_with("unknown variant") {
        return format!("expected {}", expected.replace('`', "\""));
    }
    if !problem.starts_with("invalid") {
        return problem.to_owned();
    }
    let words = match expected {
        e if e.starts_with("struct") || e.starts_with("a map") => "a section with keys",
        e if e.starts_with("a sequence") => "a list",
        e if e.starts_with("f64") => "a number",
        e if e.starts_with('u') => "a whole number that is not negative",
        e if e.starts_with("a string") => "text in quotes",
        e if e.starts_with("a boolean") => "true or false",
        other => other,
    };
    format!("expected {words}")
}

fn shortened(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() <= QUOTED {
        return text;
    }
    text.chars().take(QUOTED).chain("...".chars()).collect()
}
