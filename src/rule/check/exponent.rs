//! Exponents: numbers that stand in the text, whole or half.

use crate::document::number;
use crate::rule::error::ExpressionError;
use crate::rule::syntax::{Operator, Term, TreePart};

/// Largest exponent.
const LARGEST: f64 = 100.0;

/// The exponent that `term` is.
pub(super) fn constant(term: &Term) -> Result<f64, ExpressionError> {
    let refuse =
        |message: String, help: &str| Err(ExpressionError::new(message, term.span.clone(), help));
    let exponent = value(term)?;
    if !(exponent.abs() <= LARGEST) {
        let message = format!("the exponent {} is too large", number(exponent));
        return refuse(message, "exponents are from -100 to 100");
    }
    if (2.0 * exponent).fract() != 0.0 {
        let message = format!(
            "the exponent {} is neither whole nor half",
            number(exponent)
        );
        return refuse(
            message,
            "write exp(0.3 * log(x)) for x^0.3 of a pure number x",
        );
    }
    Ok(exponent)
}

/// The value of what consists of numbers only.
fn value(term: &Term) -> Result<f64, ExpressionError> {
    match &term.part {
        TreePart::Number(value, None) => Ok(*value),
        TreePart::Negative(operand) => Ok(-value(operand)?),
        TreePart::Binary(Operator::Calculate(arithmetic), left, right) => {
            Ok(arithmetic.of(value(left)?, value(right)?))
        }
        TreePart::Binary(Operator::Power, base, exponent) => {
            Ok(libm::pow(value(base)?, constant(exponent)?))
        }
        TreePart::Number(_, Some(_)) => {
            let help = "write a pure number without brackets";
            let span = term.span.clone();
            Err(ExpressionError::new("an exponent has no unit", span, help))
        }
        TreePart::Name(_)
        | TreePart::Not(_)
        | TreePart::Binary(Operator::Or | Operator::And | Operator::Compare(_), ..)
        | TreePart::Call(..) => {
            let message = "an exponent is a number that stands here";
            let help = "write a whole or half number, such as in x^2 or x^0.5";
            Err(ExpressionError::new(message, term.span.clone(), help))
        }
    }
}
