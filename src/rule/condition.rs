//! Checked conditions.

use crate::rule::Values;
use crate::rule::evaluate::{Evidence, Formula, Frames, Needs, Reduction, Test, evidence};
use crate::rule::syntax::Comparator;
use std::ops::Range;

/// A condition whose names and units are checked.
#[derive(Clone, Debug)]
pub struct Condition {
    pub(in crate::rule) test: Test<Reduction>,
    pub(in crate::rule) needs: Needs,
}

/// A condition that is one comparison of a run's number with a fixed one.
#[derive(Clone, Debug, PartialEq)]
pub struct SingleComparison {
    /// What is on its left, in normal form.
    pub left: String,
    /// Its sign, `<`, `<=`, `>` or `>=`.
    pub order: &'static str,
    /// The number on its right.
    pub threshold: f64,
    /// Unit of both sides; empty of pure numbers.
    pub unit: String,
}

impl Condition {
    /// The condition as one comparison with a number, if it is one.
    pub fn single_comparison(&self) -> Option<SingleComparison> {
        let Test::Comparison(comparison) = &self.test else {
            return None;
        };
        let Formula::Number(threshold) = comparison.threshold else {
            return None;
        };
        let order = match comparison.order {
            Comparator::Equal | Comparator::NotEqual => return None,
            order => order.symbol(),
        };
        let sign = format!(" {order} ");
        let left = comparison.text.rsplit_once(&sign)?.0.to_owned();
        let unit = comparison.unit.to_string();
        Some(SingleComparison {
            left,
            order,
            threshold,
            unit: if unit == "1" { String::new() } else { unit },
        })
    }

    /// The columns that it needs, in alphabetic order.
    pub fn columns(&self) -> &[String] {
        &self.needs.columns
    }

    /// The keys that it needs, in alphabetic order.
    pub fn keys(&self) -> &[String] {
        &self.needs.keys
    }

    /// Its evidence for a run, from the frames of the window `window`.
    pub fn evaluate(&self, run: &dyn Values, window: Range<usize>) -> Evidence {
        evidence(&self.test, &Frames::new(run, &self.needs, window))
    }

    /// Its evidence for a run from each of several windows, whose columns are read once.
    pub fn evaluate_each<'a>(
        &'a self,
        run: &'a dyn Values,
        windows: impl IntoIterator<Item = Range<usize>> + 'a,
    ) -> impl Iterator<Item = Evidence> + 'a {
        let mut frames = Frames::new(run, &self.needs, 0..0);
        windows.into_iter().map(move |window| {
            frames.look_at(window);
            evidence(&self.test, &frames)
        })
    }
}
