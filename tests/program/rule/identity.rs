//! Expressions in files of other formats.

use super::run::{Run, parse};
use phase::rule::Expression;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StringDeserializer};

fn read(text: &str) -> Result<Expression, Error> {
    let text: StringDeserializer<Error> = text.to_owned().into_deserializer();
    Expression::deserialize(text)
}

#[test]
fn expressions_are_texts_in_files() {
    assert_eq!(read("max(x)>1"), Ok(parse("max(x) > 1")));
    assert_eq!(String::from(parse("max(x)>1")), "max(x) > 1");
    let message = read("max(x").unwrap_err().to_string();
    assert_eq!(message, "`(` is not closed");
}

/// A column hides a key of its name, and `time` is always a column.
#[test]
fn names_are_columns_first() {
    let run = Run::of(&[3.0, 5.0]);
    assert_eq!(run.value("last(x)"), 5.0);
    assert_eq!(run.value("last(time)"), 0.1);
    assert_eq!(run.value("seed"), 7.0);
}
