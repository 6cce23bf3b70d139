//! TOML or JSON text as values, with the place of every key.

use super::faults::join;
use jsonc_parser::ast;
use jsonc_parser::common::Ranged;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
use serde_json::{Map, Number, Value};
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Language of a study file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// TOML 1.
    Toml,
    /// JSON (RFC 8259).
    Json,
}

impl Format {
    /// By the ending of a file name: `.json` is JSON, everything else TOML.
    pub fn of_path(path: &std::path::Path) -> Self {
        match path.extension() {
            Some(e) if e.eq_ignore_ascii_case("json") => Self::Json,
            _ => Self::Toml,
        }
    }
}

/// Places of keys and of values.
#[derive(Debug, Default)]
pub(super) struct Spans {
    key: BTreeMap<String, Range<usize>>,
    value: BTreeMap<String, Range<usize>>,
}

impl Spans {
    /// Place of a path: its value, its key, or the nearest section around it.
    pub fn find(&self, path: &str) -> Option<Range<usize>> {
        let mut at = path;
        loop {
            if let Some(span) = self.value.get(at).or_else(|| self.key.get(at)) {
                return Some(span.clone());
            }
            at = &at[..at.rfind(['.', '['])?];
        }
    }
}

/// A syntax error with its place.
pub(super) type Syntax = (String, Range<usize>);

const STRICT: ParseOptions = ParseOptions {
    allow_comments: false,
    allow_loose_object_property_names: false,
    allow_trailing_commas: false,
    allow_missing_commas: false,
    allow_single_quoted_strings: false,
    allow_hexadecimal_numbers: false,
    allow_unary_plus_numbers: false,
    allow_bare_decimal_point_numbers: false,
    allow_non_finite_numbers: false,
    allow_extended_string_escapes: false,
};

/// Parses a document; every syntax error the parser can tell is returned.
pub(super) fn parse(text: &str, format: Format) -> Result<(Value, Spans), Vec<Syntax>> {
    let mut walk = Walk::default();
    let value = match format {
        Format::Toml => {
            let (document, errors) = DeTable::parse_recoverable(text);
            if !errors.is_empty() {
                return Err(errors
                    .iter()
                    .map(|e| (e.message().to_owned(), e.span().unwrap_or(0..0)))
                    .collect());
            }
            walk.toml_table(document.get_ref(), "")
        }
        Format::Json => {
            let parsed = parse_to_ast(text, &CollectOptions::default(), &STRICT)
                .map_err(|e| vec![(e.kind().to_string(), e.range().start..e.range().end)])?;
            let root = parsed.value.ok_or_else(|| vec![("the file is empty".to_owned(), 0..0)])?;
            walk.json(&root, "")
        }
    };
    if walk.bad.is_empty() { Ok((value, walk.spans)) } else { Err(walk.bad) }
}

#[derive(Default)]
struct Walk {
    spans: Spans,
    bad: Vec<Syntax>,
}

impl Walk {
    fn refuse(&mut self, message: &str, span: Range<usize>) -> Value {
        self.bad.push((message.to_owned(), span));
        Value::Null
    }

    fn toml_table(&mut self, table: &DeTable<'_>, path: &str) -> Value {
        let mut rows: Vec<_> = table.iter().collect();
        rows.sort_by_key(|(k, _)| k.span().start);
        let mut map = Map::new();
        for (key, value) in rows {
            let at = join(path, key.get_ref());
            self.spans.key.insert(at.clone(), key.span());
            let value = self.toml(value, &at);
            map.insert(key.get_ref().to_string(), value);
        }
        Value::Object(map)
    }

    fn toml(&mut self, value: &Spanned<DeValue<'_>>, path: &str) -> Value {
        self.spans.value.insert(path.to_owned(), value.span());
        match value.get_ref() {
            DeValue::String(s) => Value::String(s.to_string()),
            // Numbers that are none go on as text, so that the check can name their key.
            DeValue::Integer(i) => match i64::from_str_radix(i.as_str(), i.radix()) {
                Ok(n) => n.into(),
                Err(_) => Value::String(i.as_str().to_owned()),
            },
            DeValue::Float(f) => match f.as_str().parse().ok().and_then(Number::from_f64) {
                Some(n) => Value::Number(n),
                None => Value::String(f.as_str().to_owned()),
            },
            DeValue::Boolean(b) => Value::Bool(*b),
            DeValue::Datetime(d) => Value::String(d.to_string()),
            DeValue::Array(list) => {
                list.iter().enumerate().map(|(i, v)| self.toml(v, &format!("{path}[{i}]"))).collect()
            }
            DeValue::Table(table) => self.toml_table(table, path),
        }
    }

    fn json(&mut self, value: &ast::Value<'_>, path: &str) -> Value {
        let range = value.range();
        self.spans.value.insert(path.to_owned(), range.start..range.end);
        match value {
            ast::Value::StringLit(s) => Value::String(s.value.to_string()),
            ast::Value::BooleanLit(b) => Value::Bool(b.value),
            ast::Value::NullKeyword(_) => Value::Null,
            ast::Value::NumberLit(n) => match n.value.parse::<Number>() {
                Ok(number) if number.as_f64().is_some_and(f64::is_finite) => Value::Number(number),
                _ => self.refuse("the number is out of range", range.start..range.end),
            },
            ast::Value::Array(list) => {
                list.elements.iter().enumerate().map(|(i, v)| self.json(v, &format!("{path}[{i}]"))).collect()
            }
            ast::Value::Object(object) => self.json_object(object, path),
        }
    }

    fn json_object(&mut self, object: &ast::Object<'_>, path: &str) -> Value {
        let mut map = Map::new();
        for property in &object.properties {
            let (key, range) = (property.name.as_str(), property.name.range());
            let at = join(path, key);
            if self.spans.key.insert(at.clone(), range.start..range.end).is_some() {
                self.refuse(&format!("the key '{key}' stands twice"), range.start..range.end);
            }
            let value = self.json(&property.value, &at);
            map.insert(key.to_owned(), value);
        }
        Value::Object(map)
    }
}
