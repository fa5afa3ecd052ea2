//! What an expression needs of a run, and the frames of a window.

use super::formula::{ColumnPlace, Formula, Nothing, Reduction, Test};
use crate::rule::Values;
use crate::rule::check::TIME;
use std::borrow::Cow;
use std::ops::Range;

/// The names that an expression needs, in alphabetic order.
#[derive(Clone, Debug)]
pub(in crate::rule) struct Needs {
    pub(in crate::rule) columns: Vec<String>,
    pub(in crate::rule) keys: Vec<String>,
}

/// The frames of a window with what an expression needs of them.
pub(in crate::rule) struct Frames<'run> {
    time: &'run [f64],
    columns: Vec<Cow<'run, [f64]>>,
    keys: Vec<f64>,
    window: Range<usize>,
}

impl<'run> Frames<'run> {
    /// The frames of `window` that the run has.
    pub(in crate::rule) fn new(run: &'run dyn Values, needs: &Needs, window: Range<usize>) -> Self {
        let time = run.time();
        let column = |name: &String| match name.as_str() {
            TIME => Cow::Borrowed(time),
            name => run.column(name),
        };
        let mut frames = Self {
            time,
            columns: needs.columns.iter().map(column).collect(),
            keys: needs.keys.iter().map(|name| run.key(name)).collect(),
            window: 0..0,
        };
        frames.look_at(window);
        frames
    }

    /// Looks at the frames of another window.
    pub(in crate::rule) fn look_at(&mut self, window: Range<usize>) {
        let end = window.end.min(self.time.len());
        self.window = window.start.min(end)..end;
    }

    /// The value of a formula; what is not a number has the same bits on every machine.
    pub(in crate::rule) fn value(&self, formula: &Formula<Reduction>) -> f64 {
        let value = formula.value(&self.keys, &|reduction: &Reduction| reduction.value(self));
        if value.is_nan() { f64::NAN } else { value }
    }

    /// Times of the frames.
    pub(super) fn times(&self) -> &[f64] {
        &self.time[self.window.clone()]
    }

    /// The values of a formula, one per frame; none if one of them is not a number or there are no
    /// frames. What is too large for a number is infinite.
    pub(super) fn series(&self, formula: &Formula<ColumnPlace>) -> Option<Vec<f64>> {
        let frames = self.window.clone();
        let value = |frame| formula.value(&self.keys, &|column| self.at(*column, frame));
        let value = |frame| Some(value(frame)).filter(|value| !value.is_nan());
        let series: Vec<f64> = frames.map(value).collect::<Option<_>>()?;
        (!series.is_empty()).then_some(series)
    }

    /// The share of frames in which a condition holds; none without frames.
    pub(super) fn share(&self, test: &Test<ColumnPlace>) -> Option<f64> {
        let frames = self.window.clone();
        let holds = |frame: &usize| test.holds(&self.keys, &|column| self.at(*column, *frame));
        let count = frames.clone().filter(holds).count();
        (!frames.is_empty()).then(|| count as f64 / frames.len() as f64)
    }

    /// The value of a formula that no frame enters.
    pub(super) fn constant(&self, formula: &Formula<Nothing>) -> f64 {
        formula.value(&self.keys, &|nothing| match *nothing {})
    }

    /// The value of a column at a frame; not a number if the column is shorter.
    fn at(&self, ColumnPlace(index): ColumnPlace, frame: usize) -> f64 {
        let value = self.columns[index].get(frame);
        value.copied().unwrap_or(f64::NAN)
    }
}
