//! Conditions.

use super::scope::Scope;
use super::{Checker, refusals};
use crate::rule::error::ExpressionError;
use crate::rule::evaluate::{Comparison, Test};
use crate::rule::syntax::{Function, Operator, Term, TreePart};
use crate::rule::unit::Unit;

impl Checker {
    /// The condition that `term` is.
    pub(super) fn condition<S: Scope>(&self, term: &Term) -> Result<Test<S>, ExpressionError> {
        match &term.part {
            TreePart::Not(operand) => Ok(Test::Not(Box::new(self.condition(operand)?))),
            TreePart::Binary(Operator::And, left, right) => {
                let [left, right] = self.conditions(left, right)?;
                Ok(Test::And(left, right))
            }
            TreePart::Binary(Operator::Or, left, right) => {
                let [left, right] = self.conditions(left, right)?;
                Ok(Test::Or(left, right))
            }
            TreePart::Binary(Operator::Compare(order), left, right) => {
                let typed = [self.number(left)?, self.number(right)?];
                let unit =
                    self.common_unit(term, [left, right], typed.each_ref().map(|it| it.unit))?;
                let [value, threshold] = typed.map(|it| it.formula);
                Ok(Test::Comparison(Comparison {
                    order: *order,
                    value,
                    threshold,
                    unit: unit.unwrap_or(Unit::ONE),
                    text: term.to_string(),
                }))
            }
            TreePart::Number(..)
            | TreePart::Name(_)
            | TreePart::Negative(_)
            | TreePart::Binary(Operator::Calculate(_) | Operator::Power, ..)
            | TreePart::Call(..) => Err(refusals::condition_needed(term)),
        }
    }

    fn conditions<S: Scope>(
        &self,
        left: &Term,
        right: &Term,
    ) -> Result<[Box<Test<S>>; 2], ExpressionError> {
        Ok([
            Box::new(self.condition(left)?),
            Box::new(self.condition(right)?),
        ])
    }

    /// The condition whose share of frames is asked for.
    pub(super) fn condition_of_share<S: Scope>(
        &self,
        term: &Term,
    ) -> Result<Test<S>, ExpressionError> {
        match term.part.is_condition() {
            true => self.condition(term),
            false => Err(refusals::no_condition_of(Function::Share, term)),
        }
    }
}
