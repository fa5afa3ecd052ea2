//! What may stand where: inside of reductions columns, outside of them reductions.

use super::{Checker, Typed, refusals};
use crate::rule::error::ExpressionError;
use crate::rule::evaluate::{ColumnPlace, Nothing, Reduction};
use crate::rule::syntax::{Function, Term};
use crate::rule::unit::Unit;

/// What stands in a formula besides numbers and keys.
pub(super) trait Scope: Sized {
    /// The column of that index, if one may stand at `term`.
    fn column(index: usize, name: &str, term: &Term) -> Result<Self, ExpressionError>;

    /// A reduction over frames with its unit, if one may stand at `term`.
    fn reduction(
        checker: &Checker,
        function: Function,
        arguments: &[Term],
        term: &Term,
    ) -> Result<(Self, Option<Unit>), ExpressionError>;
}

/// Inside of a reduction.
impl Scope for ColumnPlace {
    fn column(index: usize, _: &str, _: &Term) -> Result<Self, ExpressionError> {
        Ok(Self(index))
    }

    fn reduction(
        _: &Checker,
        function: Function,
        _: &[Term],
        term: &Term,
    ) -> Result<(Self, Option<Unit>), ExpressionError> {
        Err(refusals::nested(function, term))
    }
}

/// Where one number of the run is needed.
impl Scope for Reduction {
    fn column(_: usize, name: &str, term: &Term) -> Result<Self, ExpressionError> {
        Err(refusals::not_reduced(name, term))
    }

    fn reduction(
        checker: &Checker,
        function: Function,
        arguments: &[Term],
        _: &Term,
    ) -> Result<(Self, Option<Unit>), ExpressionError> {
        match (function, arguments) {
            (Function::Over(summary), [argument]) => {
                let Typed { formula, unit } = checker.number_of(function, argument)?;
                let unit = checker.unit_of_summary(summary, unit, argument)?;
                Ok((Self::Of(summary, formula), unit))
            }
            (Function::Share, [argument]) => {
                let test = checker.condition_of_share(argument)?;
                Ok((Self::Share(test), Some(Unit::ONE)))
            }
            (Function::Repeats, [argument, period]) => {
                let value = checker.number_of(function, argument)?.formula;
                let Typed { formula, unit } = checker.number_of::<Nothing>(function, period)?;
                match unit.is_none_or(|unit| unit == checker.time) {
                    true => Ok((Self::Repeats(value, formula), Some(Unit::ONE))),
                    false => Err(refusals::no_period(unit, period)),
                }
            }
            _ => unreachable!("the parser counts arguments, and other functions are no reductions"),
        }
    }
}

/// Where a number must not depend on the frames, such as in a period.
impl Scope for Nothing {
    fn column(_: usize, name: &str, term: &Term) -> Result<Self, ExpressionError> {
        Err(refusals::period_of_frames(name, term))
    }

    fn reduction(
        _: &Checker,
        function: Function,
        _: &[Term],
        term: &Term,
    ) -> Result<(Self, Option<Unit>), ExpressionError> {
        Err(refusals::nested(function, term))
    }
}
