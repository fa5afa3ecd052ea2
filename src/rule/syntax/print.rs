//! The normal form of an expression: only the parentheses that it needs, and spaces around
//! operators except powers.

use super::operator::{ATOM, MINUS, NOT};
use super::{Operator, Term, TreePart};
use crate::document::number;
use std::fmt::{Display, Formatter, Result};

/// Largest number of characters of a part that a help repeats.
const SHORT: usize = 40;

impl Display for Term {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        match &self.part {
            TreePart::Number(value, None) => formatter.write_str(&number(*value)),
            TreePart::Number(value, Some(unit)) => {
                write!(formatter, "{}[{}]", number(*value), unit.text)
            }
            TreePart::Name(name) => formatter.write_str(name),
            TreePart::Negative(operand) => {
                formatter.write_str("-")?;
                operand.print(MINUS, formatter)
            }
            TreePart::Not(operand) => {
                formatter.write_str("not ")?;
                operand.print(NOT, formatter)
            }
            TreePart::Binary(operator, left, right) => {
                left.print(operator.binding_on_left(), formatter)?;
                match operator {
                    Operator::Power => formatter.write_str("^")?,
                    _ => write!(formatter, " {} ", operator.symbol())?,
                }
                right.print(operator.binding_on_right(), formatter)
            }
            TreePart::Call(function, arguments) => {
                write!(formatter, "{function}(")?;
                for (index, argument) in arguments.iter().enumerate() {
                    let separator = if index == 0 { "" } else { ", " };
                    write!(formatter, "{separator}{argument}")?;
                }
                formatter.write_str(")")
            }
        }
    }
}

impl Term {
    /// Its normal form, if it is short enough for a help.
    pub(in crate::rule) fn short(&self) -> Option<String> {
        let text = self.to_string();
        (text.chars().count() <= SHORT).then_some(text)
    }

    /// Writes it where something must bind at least as tightly as `least`.
    fn print(&self, least: u8, formatter: &mut Formatter<'_>) -> Result {
        if self.binding() < least {
            write!(formatter, "({self})")
        } else {
            write!(formatter, "{self}")
        }
    }

    fn binding(&self) -> u8 {
        match &self.part {
            TreePart::Number(..) | TreePart::Name(_) | TreePart::Call(..) => ATOM,
            TreePart::Negative(_) => MINUS,
            TreePart::Not(_) => NOT,
            TreePart::Binary(operator, ..) => operator.binding(),
        }
    }
}
