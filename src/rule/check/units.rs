//! Rules of units. A bare number has none: it takes the unit of what it is added to or compared
//! with, and is a pure number in a product with something that has a unit.

use super::{Checker, refusals};
use crate::rule::error::ExpressionError;
use crate::rule::syntax::{Arithmetic, Mathematics, Summary, Term};
use crate::rule::unit::Unit;

type UnitOrBare = Result<Option<Unit>, ExpressionError>;

impl Checker {
    /// The unit of a sum, a comparison, or the lesser or greater of two numbers.
    pub(super) fn common_unit(
        &self,
        term: &Term,
        sides: [&Term; 2],
        units: [Option<Unit>; 2],
    ) -> UnitOrBare {
        match units {
            [Some(left), Some(right)] if left != right => {
                Err(refusals::different_units(term, sides, [left, right]))
            }
            [left, right] => Ok(left.or(right)),
        }
    }

    pub(super) fn unit_of_product(
        &self,
        arithmetic: Arithmetic,
        units: [Option<Unit>; 2],
        term: &Term,
    ) -> UnitOrBare {
        if units == [None, None] {
            return Ok(None);
        }
        let [left, right] = units.map(|unit| unit.unwrap_or(Unit::ONE));
        let unit = match arithmetic {
            Arithmetic::Divide => left.over(right),
            _ => left.times(right),
        };
        unit.map(Some).ok_or_else(|| refusals::no_unit(term))
    }

    pub(super) fn unit_of_power(
        &self,
        base: Option<Unit>,
        exponent: f64,
        term: &Term,
    ) -> UnitOrBare {
        let raised = base.map(|unit| unit.raised(exponent).ok_or_else(|| refusals::no_unit(term)));
        raised.transpose()
    }

    /// The unit of a function of one number.
    pub(super) fn unit_of_function(
        &self,
        function: Mathematics,
        unit: Option<Unit>,
        argument: &Term,
        term: &Term,
    ) -> UnitOrBare {
        match function {
            Mathematics::Abs | Mathematics::Lesser | Mathematics::Greater => Ok(unit),
            Mathematics::Sqrt => self.unit_of_power(unit, 0.5, term),
            Mathematics::Exp
            | Mathematics::Log
            | Mathematics::Sin
            | Mathematics::Cos
            | Mathematics::Tan => match unit {
                Some(unit) if unit != Unit::ONE => {
                    Err(refusals::not_pure(function, unit, argument, term))
                }
                _ => Ok(Some(Unit::ONE)),
            },
        }
    }

    pub(super) fn unit_of_summary(
        &self,
        summary: Summary,
        unit: Option<Unit>,
        term: &Term,
    ) -> UnitOrBare {
        match summary {
            Summary::Trend => {
                let rate = unit.unwrap_or(Unit::ONE).over(self.time);
                rate.map(Some).ok_or_else(|| refusals::no_unit(term))
            }
            Summary::Mean
            | Summary::Min
            | Summary::Max
            | Summary::Deviation
            | Summary::First
            | Summary::Last => Ok(unit),
        }
    }
}
