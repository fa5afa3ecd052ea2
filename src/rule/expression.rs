//! Expressions as read, before their names are known.

use crate::rule::syntax::{LONGEST, Term, parse, too_long};
use crate::rule::{Condition, ExpressionError, Names, Number, check};
use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter, Result as Written};
use std::str::FromStr;

/// An expression, which prints in normal form: only necessary parentheses, even spaces.
///
/// Expressions are equal if their normal forms mean the same, however they were written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    root: Term,
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// If the text is not one, or has more than 2000 bytes or 64 levels. The normal form is held to
    /// the same length.
    pub fn parse(text: &str) -> Result<Self, ExpressionError> {
        let expression = Self { root: parse(text)? };
        match expression.to_string().len() > LONGEST {
            true => Err(too_long("normal form of the expression", 0..text.len())),
            false => Ok(expression),
        }
    }

    /// The expression as a condition.
    ///
    /// # Errors
    /// If it is not a condition, or its names or units are wrong.
    pub fn condition(&self, names: &dyn Names) -> Result<Condition, ExpressionError> {
        let (test, needs) = check::condition(&self.root, names)?;
        Ok(Condition { test, needs })
    }

    /// The expression as one number of a run.
    ///
    /// # Errors
    /// If it is not a number, or its names or units are wrong.
    pub fn number(&self, names: &dyn Names) -> Result<Number, ExpressionError> {
        let (formula, unit, needs) = check::number(&self.root, names)?;
        Ok(Number {
            formula,
            unit,
            needs,
        })
    }
}

impl Display for Expression {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Written {
        Display::fmt(&self.root, formatter)
    }
}

impl FromStr for Expression {
    type Err = ExpressionError;

    fn from_str(text: &str) -> Result<Self, ExpressionError> {
        Self::parse(text)
    }
}

impl TryFrom<String> for Expression {
    type Error = ExpressionError;

    fn try_from(text: String) -> Result<Self, ExpressionError> {
        Self::parse(&text)
    }
}

impl From<Expression> for String {
    fn from(expression: Expression) -> Self {
        expression.to_string()
    }
}
