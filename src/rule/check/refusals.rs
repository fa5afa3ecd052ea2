//! The errors of expressions whose parts do not fit together.

use crate::rule::error::ExpressionError;
use crate::rule::syntax::{Arithmetic, Function, Mathematics, Operator, Term, TreePart};
use crate::rule::unit::Unit;

pub(super) fn not_reduced(name: &str, term: &Term) -> ExpressionError {
    let message = format!("`{name}` has one value per frame, where one number is needed");
    let help = format!("reduce it over time, such as mean({name}) or last({name})");
    ExpressionError::new(message, term.mark.clone(), help)
}

pub(super) fn period_of_frames(name: &str, term: &Term) -> ExpressionError {
    let message = format!("`{name}` has one value per frame, where a period is needed");
    let help = "a period consists of numbers and keys, such as 6.2832 / swirl.omega";
    ExpressionError::new(message, term.mark.clone(), help)
}

pub(super) fn nested(function: Function, term: &Term) -> ExpressionError {
    let message = format!("`{function}` stands inside of another reduction over time");
    let help = "reduce once: inside of a reduction stand columns, keys and numbers of one frame";
    ExpressionError::new(message, term.mark.clone(), help)
}

pub(super) fn number_needed(term: &Term) -> ExpressionError {
    let message = "a condition stands where a number is needed";
    let help = "join conditions by `and` and `or`; the share of frames, share(x > 0), is a number";
    ExpressionError::new(message, term.span.clone(), help)
}

pub(super) fn condition_needed(term: &Term) -> ExpressionError {
    let message = "a number stands where a condition is needed";
    let help = match term.short() {
        Some(text) => format!("compare it, such as `{text} > 0`"),
        None => "compare it, such as `mean(x) > 0`".to_owned(),
    };
    ExpressionError::new(message, term.span.clone(), help)
}

pub(super) fn no_number_of(function: Function, term: &Term) -> ExpressionError {
    let message = format!("`{function}` takes a number, not a condition");
    let help = match term.short() {
        Some(text) => format!("write share({text}) for the share of frames in which it holds"),
        None => "write share(x > 0) for the share of frames in which x > 0".to_owned(),
    };
    ExpressionError::new(message, term.span.clone(), help)
}

pub(super) fn no_condition_of(function: Function, term: &Term) -> ExpressionError {
    let message = format!("`{function}` takes a condition, not a number");
    let help = match &term.part {
        TreePart::Name(name) => format!("compare it, such as {function}({name} > 0)"),
        _ => format!("compare the values of every frame, such as {function}(x > 0)"),
    };
    ExpressionError::new(message, term.span.clone(), help)
}

pub(super) fn different_units(term: &Term, sides: [&Term; 2], units: [Unit; 2]) -> ExpressionError {
    let [left, right] = units;
    let message = match &term.part {
        TreePart::Binary(Operator::Calculate(Arithmetic::Add), ..) => {
            format!("adds {right} to {left}")
        }
        TreePart::Binary(Operator::Calculate(_), ..) => format!("subtracts {right} from {left}"),
        TreePart::Call(function, _) => {
            format!("`{function}` takes numbers of one unit, not {left} and {right}")
        }
        _ => format!("compares {left} with {right}"),
    };
    let [one, other] = sides.map(Term::short);
    let one = one.map_or("the first".to_owned(), |text| format!("`{text}`"));
    let other = other.map_or("the second".to_owned(), |text| format!("`{text}`"));
    let help = format!("{one} has the unit {left}, {other} the unit {right}");
    ExpressionError::new(message, term.mark.clone(), help)
}

pub(super) fn not_pure(
    function: Mathematics,
    unit: Unit,
    argument: &Term,
    term: &Term,
) -> ExpressionError {
    let taken = match function {
        Mathematics::Sin | Mathematics::Cos | Mathematics::Tan => "an angle in rad",
        _ => "a pure number",
    };
    let name = Function::Of(function);
    let message = format!("`{name}` takes {taken}, not {unit}");
    let argument = argument
        .short()
        .map_or("its value".to_owned(), |text| format!("`{text}`"));
    let help = format!("divide {argument} by something of the unit {unit}");
    ExpressionError::new(message, term.mark.clone(), help)
}

pub(super) fn no_period(unit: Option<Unit>, term: &Term) -> ExpressionError {
    let unit = unit.unwrap_or(Unit::ONE);
    let message = format!("a period has the unit s, not {unit}");
    let help = "write a time, such as 6.2832 / swirl.omega, or a number without a unit";
    ExpressionError::new(message, term.span.clone(), help)
}

pub(super) fn no_unit(term: &Term) -> ExpressionError {
    let message = "the result has no unit: its exponents are too large or too finely divided";
    let help = "exponents of units are multiples of 1/16 from -1000 to 1000";
    ExpressionError::new(message, term.mark.clone(), help)
}
