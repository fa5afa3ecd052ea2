//! From the tree of an expression to formulas whose names and units are checked.

mod condition;
mod exponent;
mod number;
mod refusals;
mod scope;
mod units;

use crate::document::suggest;
use crate::rule::Names;
use crate::rule::error::ExpressionError;
use crate::rule::evaluate::{Formula, Needs, Reduction, Test};
use crate::rule::syntax::{Function, Term};
use crate::rule::unit::Unit;
use std::collections::BTreeMap;

/// The column of the times of frames, which every run has.
pub(in crate::rule) const TIME: &str = "time";

/// Names in a help, if none of them was probably meant.
const NAMES_SHOWN: usize = 8;

/// A number with its unit; a bare number has none yet, and takes the one that its place needs.
pub(in crate::rule) struct Typed<Slot> {
    formula: Formula<Slot>,
    unit: Option<Unit>,
}

/// The condition that `term` is, and the names that it needs.
pub(in crate::rule) fn condition(
    term: &Term,
    names: &dyn Names,
) -> Result<(Test<Reduction>, Needs), ExpressionError> {
    let checker = Checker::new(term, names)?;
    let test = checker.condition(term)?;
    Ok((test, checker.needs()))
}

/// The number that `term` is, its unit, and the names that it needs.
pub(in crate::rule) fn number(
    term: &Term,
    names: &dyn Names,
) -> Result<(Formula<Reduction>, Unit, Needs), ExpressionError> {
    let checker = Checker::new(term, names)?;
    let number = checker.number(term)?;
    let unit = number.unit.unwrap_or(Unit::ONE);
    Ok((number.formula, unit, checker.needs()))
}

/// The names of an expression with their units, in alphabetic order.
struct Checker {
    columns: BTreeMap<String, Unit>,
    keys: BTreeMap<String, Unit>,
    /// Of the times of frames.
    time: Unit,
}

/// What a name stands for: its index among the columns or keys that are needed, and its unit.
enum Meaning {
    Column(usize, Unit),
    Key(usize, Unit),
}

impl Checker {
    /// Looks all names up.
    fn new(term: &Term, names: &dyn Names) -> Result<Self, ExpressionError> {
        let mut checker = Self {
            columns: BTreeMap::new(),
            keys: BTreeMap::new(),
            time: names.time(),
        };
        let mut unknown = None;
        term.names(&mut |name, term| {
            if let Some(unit) = column(name, names) {
                checker.columns.insert(name.to_owned(), unit);
            } else if let Some(unit) = names.key(name) {
                checker.keys.insert(name.to_owned(), unit);
            } else {
                unknown = unknown.or(Some((name, term)));
            }
        });
        match unknown {
            Some((name, term)) => Err(unknown_name(name, term, names)),
            None => Ok(checker),
        }
    }

    fn meaning(&self, name: &str) -> Option<Meaning> {
        let find = |names: &BTreeMap<String, Unit>| {
            let mut names = names.iter().enumerate();
            let found = names.find(|(_, (known, _))| *known == name);
            found.map(|(index, (_, unit))| (index, *unit))
        };
        match find(&self.columns) {
            Some((index, unit)) => Some(Meaning::Column(index, unit)),
            None => find(&self.keys).map(|(index, unit)| Meaning::Key(index, unit)),
        }
    }

    fn needs(self) -> Needs {
        Needs {
            columns: self.columns.into_keys().collect(),
            keys: self.keys.into_keys().collect(),
        }
    }
}

/// The unit of a column.
fn column(name: &str, names: &dyn Names) -> Option<Unit> {
    match name {
        TIME => Some(names.time()),
        _ => names.column(name),
    }
}

fn unknown_name(name: &str, term: &Term, names: &dyn Names) -> ExpressionError {
    let span = term.mark.clone();
    if let Some(function) = Function::of_name(name) {
        let message = format!("`{name}` is a function, whose values stand in parentheses");
        return ExpressionError::new(message, span, function.usage());
    }
    if let Some(why) = names.absent(name) {
        let message = format!("runs of this scene have no column `{name}`");
        return ExpressionError::new(message, span, why);
    }
    let mut known = names.suggestions();
    known.push(TIME.to_owned());
    known.sort_unstable();
    known.dedup();
    let ending = format!(".{name}");
    let own = known.iter().find(|it| it.ends_with(&ending));
    let near = own.map(String::as_str);
    let near = near.or_else(|| suggest(name, known.iter().map(String::as_str)));
    let help = match near {
        Some(meant) => format!("write `{meant}`"),
        None => {
            let more = match known.len().saturating_sub(NAMES_SHOWN) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            known.truncate(NAMES_SHOWN);
            format!("known are `{}`{more}", known.join("`, `"))
        }
    };
    let message = format!("`{name}` is neither a column of the run nor a key of its scene");
    ExpressionError::new(message, span, help)
}
