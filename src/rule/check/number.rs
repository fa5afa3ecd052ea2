//! Numbers.

use super::scope::Scope;
use super::{Checker, Meaning, Typed, exponent, refusals};
use crate::rule::error::ExpressionError;
use crate::rule::evaluate::Formula;
use crate::rule::syntax::{Arithmetic, Function, Mathematics, Operator, Term, TreePart};

impl Checker {
    /// The number that `term` is.
    pub(super) fn number<S: Scope>(&self, term: &Term) -> Result<Typed<S>, ExpressionError> {
        let (formula, unit) = match &term.part {
            TreePart::Number(value, unit) => {
                (Formula::Number(*value), unit.as_ref().map(|it| it.unit))
            }
            TreePart::Name(name) => match self.meaning(name) {
                Some(Meaning::Column(index, unit)) => {
                    (Formula::At(S::column(index, name, term)?), Some(unit))
                }
                Some(Meaning::Key(index, unit)) => (Formula::Key(index), Some(unit)),
                None => unreachable!("all names of the tree were looked up"),
            },
            TreePart::Negative(operand) => {
                let Typed { formula, unit } = self.number(operand)?;
                (Formula::Negative(Box::new(formula)), unit)
            }
            TreePart::Binary(Operator::Calculate(arithmetic), left, right) => {
                return self.calculation(*arithmetic, left, right, term);
            }
            TreePart::Binary(Operator::Power, base, exponent) => {
                let base = self.number(base)?;
                let exponent = exponent::constant(exponent)?;
                let unit = self.unit_of_power(base.unit, exponent, term)?;
                (Formula::Power(Box::new(base.formula), exponent), unit)
            }
            TreePart::Call(Function::Of(function), arguments) => {
                return self.function(*function, arguments, term);
            }
            TreePart::Call(function, arguments) => {
                let (reduction, unit) = S::reduction(self, *function, arguments, term)?;
                (Formula::At(reduction), unit)
            }
            TreePart::Not(_)
            | TreePart::Binary(Operator::Or | Operator::And | Operator::Compare(_), ..) => {
                return Err(refusals::number_needed(term));
            }
        };
        Ok(Typed { formula, unit })
    }

    /// The number that a function takes.
    pub(super) fn number_of<S: Scope>(
        &self,
        function: Function,
        term: &Term,
    ) -> Result<Typed<S>, ExpressionError> {
        match term.part.is_condition() {
            true => Err(refusals::no_number_of(function, term)),
            false => self.number(term),
        }
    }

    fn calculation<S: Scope>(
        &self,
        arithmetic: Arithmetic,
        left: &Term,
        right: &Term,
        term: &Term,
    ) -> Result<Typed<S>, ExpressionError> {
        let typed = [self.number(left)?, self.number(right)?];
        let units = typed.each_ref().map(|it: &Typed<S>| it.unit);
        let unit = match arithmetic {
            Arithmetic::Add | Arithmetic::Subtract => {
                self.common_unit(term, [left, right], units)?
            }
            Arithmetic::Multiply | Arithmetic::Divide => {
                self.unit_of_product(arithmetic, units, term)?
            }
        };
        let [left, right] = typed.map(|it| Box::new(it.formula));
        let formula = Formula::Calculation(arithmetic, left, right);
        Ok(Typed { formula, unit })
    }

    fn function<S: Scope>(
        &self,
        function: Mathematics,
        arguments: &[Term],
        term: &Term,
    ) -> Result<Typed<S>, ExpressionError> {
        let numbers = arguments
            .iter()
            .map(|argument| self.number_of(Function::Of(function), argument));
        let numbers: Vec<Typed<S>> = numbers.collect::<Result<_, _>>()?;
        let units: Vec<_> = numbers.iter().map(|it| it.unit).collect();
        let unit = match (arguments, units.as_slice()) {
            ([left, right], [one, other]) => {
                self.common_unit(term, [left, right], [*one, *other])?
            }
            ([argument], [unit]) => self.unit_of_function(function, *unit, argument, term)?,
            _ => unreachable!("the parser counts arguments"),
        };
        let arguments = numbers.into_iter().map(|it| it.formula).collect();
        let formula = Formula::Function(function, arguments);
        Ok(Typed { formula, unit })
    }
}
