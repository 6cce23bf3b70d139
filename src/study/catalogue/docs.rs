//! Meanings as the doc comments of the study file give them, through its JSON Schema.
//!
//! Deliberately not here: any meaning of its own.

use schemars::JsonSchema;
use serde_json::Value;

/// Where the default of a key begins in its description.
const DEFAULT: &str = " Default";

/// The words of a key that is one of a few, each with its meaning.
pub(super) fn words<T: JsonSchema>() -> Vec<(String, String)> {
    let schema = schemars::schema_for!(T).to_value();
    let text = |one: &Value, key: &str| one[key].as_str().map(str::to_owned);
    let word = |one: &Value| Some((text(one, "const")?, text(one, "description").unwrap_or_default()));
    schema["oneOf"].as_array().into_iter().flatten().filter_map(word).collect()
}

/// The meaning of one of such words.
pub(super) fn meaning(words: &[(String, String)], word: &str) -> String {
    words.iter().find(|(w, _)| w == word).map(|(_, meaning)| meaning.clone()).unwrap_or_default()
}

/// The meaning of a key of a section of the study file, its default left out.
pub(super) fn key(schema: &Value, section: &str, key: &str) -> Option<String> {
    let text = schema["$defs"][section]["properties"][key]["description"].as_str()?;
    Some(text.split(DEFAULT).next().unwrap_or(text).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::QuantityName;
    use crate::study::file::CavitationName;

    #[test]
    fn every_word_has_a_meaning() {
        let found = words::<CavitationName>();
        assert_eq!(found.len(), 4);
        assert!(meaning(&found, "guembel").contains("half-Sommerfeld"));
        assert_eq!(words::<QuantityName>().len(), QuantityName::ALL.len());
    }

    #[test]
    fn defaults_are_left_out_of_the_meaning_of_a_key() {
        let schema = crate::study::schema();
        let found = key(&schema, "BearingFile", "tilt_x");
        assert_eq!(found.as_deref(), Some("Slope of the journal's axis towards 0 deg of the shell."));
        assert_eq!(key(&schema, "BearingFile", "colour"), None);
    }
}
