//! The runs that a figure of single runs shows: of a sweep, or of records beside each other.

use super::choice::{self, DefaultRuns};
use super::records::RecordSet;
use super::svg::Origin;
use super::{PlotError, Source, captions, grid};
use crate::classify::{Family, Label, LabelRow, Sieves, Verdict, classify};
use crate::record::RunRecord;
use crate::scene::Scene;
use crate::store::DataSet;
use std::borrow::Cow;

/// The runs that a figure shows.
pub(super) struct Runs<'a> {
    pub(super) origin: Origin<'a>,
    /// First and last time (s) of the states that figures of drainages show or measure.
    pub(super) times: Option<[f64; 2]>,
    /// Curves of other sources, shown with the runs.
    pub(super) data: &'a [DataSet],
    /// The parts of their names that all of several runs share, with markup.
    pub(super) common: Vec<String>,
    pub(super) shown: Vec<ShownRun<'a>>,
    /// How many runs of the sweep are left out because they are unstable.
    pub(super) left_out: Option<String>,
}

/// A run that is shown.
pub(super) struct ShownRun<'a> {
    /// The parts of its name that not all runs share, with markup, such as `$r$ = 4 mm`.
    pub(super) name: Vec<String>,
    /// Its label and measures.
    pub(super) verdict: Cow<'a, Verdict>,
    kept: RecordPlace<'a>,
}

/// Where the record of a run is.
enum RecordPlace<'a> {
    Here(&'a RunRecord),
    InFolder(&'a Source<'a>, &'a LabelRow),
}

impl<'a> Runs<'a> {
    /// The runs of a sweep at the points asked for, or else the default ones.
    pub(super) fn of_sweep(
        source: &'a Source<'a>,
        default: &DefaultRuns,
    ) -> Result<Self, PlotError> {
        grid::check(source.sweep, source.table)?;
        let rows = choice::rows(source, default)?.into_iter();
        let shown = rows.map(|row| {
            let row = &source.table.rows[row];
            ShownRun {
                name: choice::place(source, row),
                verdict: Cow::Borrowed(&row.verdict),
                kept: RecordPlace::InFolder(source, row),
            }
        });
        let runs = Self {
            origin: source.origin(),
            times: source.times,
            data: &[],
            common: Vec::new(),
            shown: shown.collect(),
            left_out: choice::left_out(source),
        };
        Ok(runs.with_common_parts())
    }

    /// Records of one family.
    pub(super) fn of_records(records: &RecordSet<'a>) -> Result<Self, PlotError> {
        let first = records.records.first().ok_or_else(PlotError::empty_table)?;
        let family = Family::of(&first.scene);
        let mut others = records.records.iter().map(|it| Family::of(&it.scene));
        if let Some(other) = others.find(|other| *other != family) {
            return Err(PlotError::file(format_args!(
                "one record is of a {}, another of a {}: give those of one family",
                family.name, other.name
            )));
        }
        let scenes: Vec<&Scene> = records.records.iter().map(|it| &it.scene).collect();
        let names = match records.labels {
            [] => captions::of(&scenes),
            labels => labels.iter().map(|label| vec![label.clone()]).collect(),
        };
        let sieves = Sieves::default();
        let shown = records.records.iter().zip(names).map(|(record, name)| {
            // A figure of energies needs no label; a scene that no sieve can judge has none.
            let verdict = classify(record, &sieves)
                .unwrap_or_else(|_| Verdict::unmeasured(family, Label::UNSETTLED));
            ShownRun {
                name,
                verdict: Cow::Owned(verdict),
                kept: RecordPlace::Here(record),
            }
        });
        let title = first.scene.title.as_deref();
        let is_common = scenes.iter().all(|it| it.title.as_deref() == title);
        let runs = Self {
            origin: Origin {
                title: title.filter(|_| is_common),
                seeds: scenes.iter().map(|it| it.seed).collect(),
                program: &first.program,
            },
            times: records.times,
            data: records.data,
            common: Vec::new(),
            shown: shown.collect(),
            left_out: None,
        };
        Ok(runs.with_common_parts())
    }

    /// The same with the parts that all names of several runs share apart.
    fn with_common_parts(mut self) -> Self {
        if let [first, _, ..] = &self.shown[..] {
            let is_common = |part: &&String| self.shown.iter().all(|it| it.name.contains(part));
            self.common = first.name.iter().filter(is_common).cloned().collect();
        }
        for run in &mut self.shown {
            run.name.retain(|part| !self.common.contains(part));
        }
        self
    }
}

impl ShownRun<'_> {
    /// Its record.
    pub(super) fn record(&self) -> Result<Cow<'_, RunRecord>, PlotError> {
        match self.kept {
            RecordPlace::Here(record) => Ok(Cow::Borrowed(record)),
            RecordPlace::InFolder(source, row) => {
                let record = (source.record)(&row.id).map_err(|error| {
                    let point = choice::plainly(source, row);
                    PlotError::file(format_args!("the run at {point}: {error}"))
                });
                record.map(Cow::Owned)
            }
        }
    }
}
