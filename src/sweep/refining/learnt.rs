//! What a refined sweep has learnt from its runs, and the tables that tell it.

use super::{Refining, borders};
use crate::classify::{Family, LabelRow, LabelTable};
use crate::refine::{
    Borders, Code, Finding, Lattice, Observations, ProbabilityMap, RefineError, Trial,
    probabilities,
};
use crate::store::{self, BorderRow, StoreError};
use crate::sweep::{Folder, Sweep};

/// Code of runs that failed: they have no record, and a label of their own.
pub const FAILED: Code = i8::MIN;

/// Name of the label with a code.
pub fn label_name(family: &Family, code: Code) -> &'static str {
    let mut labels = family.labels().into_iter();
    let label = labels.find(|label| label.code == code);
    label.map_or("failed", |label| label.name)
}

/// What the row of a run says.
pub(super) fn found(row: &LabelRow) -> Finding {
    Finding {
        label: row.verdict.label.code,
        margins: row.verdict.margins(),
    }
}

/// What a refined sweep has learnt from its runs.
#[derive(Clone, Debug)]
pub struct Learnt {
    /// All points of its grid.
    pub lattice: Lattice,
    /// The runs and their labels.
    pub runs: Observations,
    /// The probability of each label at each point.
    pub map: ProbabilityMap,
}

impl Learnt {
    /// What a sweep learns from the rows of a table that are of its runs so far; from all rows if
    /// `refining` does not say how far it is. None if the sweep is not refined.
    ///
    /// # Errors
    /// If there are no such rows, or if the grid cannot be refined.
    pub fn of(
        sweep: &Sweep,
        refining: Option<&Refining>,
        table: &LabelTable,
    ) -> Result<Option<Self>, RefineError> {
        let Some(settings) = &sweep.refine else {
            return Ok(None);
        };
        let lattice = sweep.lattice()?;
        let runs = Self::runs_of(refining, table)?;
        let map = probabilities(&lattice, &runs, settings)?;
        Ok(Some(Self { lattice, runs, map }))
    }

    /// The runs of a table that are of a refined sweep so far, and those that failed; all rows if
    /// `refining` does not say how far it is.
    ///
    /// # Errors
    /// If one run has two labels.
    pub fn runs_of(
        refining: Option<&Refining>,
        table: &LabelTable,
    ) -> Result<Observations, RefineError> {
        let chosen = refining.map(Refining::runs);
        let is_of_sweep = |run: &Trial| {
            let mut chosen = chosen.iter();
            chosen.all(|runs| runs.binary_search_by(|it| it.order(run)).is_ok())
        };
        let mut runs = Observations::new();
        for row in &table.rows {
            let run = Trial {
                values: row.values.clone(),
                seed: row.seed,
            };
            if is_of_sweep(&run) {
                runs.add(run, found(row))?;
            }
        }
        for run in refining.iter().flat_map(|it| &it.failed) {
            if runs.label(run).is_none() {
                runs.add(run.clone(), FAILED)?;
            }
        }
        Ok(runs)
    }

    /// The borders along an axis.
    ///
    /// # Errors
    /// If there is no such axis.
    pub fn borders(&self, axis: usize) -> Result<Borders, RefineError> {
        Borders::new(&self.lattice, &self.map, axis)
    }

    /// Writes `refined.csv`, the probability of each label at each point, and `borders.csv`, the
    /// borders with their bands.
    ///
    /// # Errors
    /// If a table cannot be written.
    pub fn write(&self, folder: &Folder, sweep: &Sweep, family: &Family) -> Result<(), StoreError> {
        let axes: Vec<&str> = sweep.axes.iter().map(|axis| axis.name.as_str()).collect();
        let name = |code: Code| label_name(family, code);
        let mut codes: Vec<Code> = family
            .labels()
            .into_iter()
            .map(|label| label.code)
            .collect();
        codes.extend(self.map.codes().iter().filter(|code| **code == FAILED));
        let path = folder.refined();
        store::write_probabilities(&axes, &self.lattice, &self.map, (&codes, &name), &path)?;
        let rows: Vec<BorderRow> = sweep
            .axes_of_borders()
            .into_iter()
            .filter_map(|axis| self.borders(axis).ok())
            .flat_map(|it| borders::rows(sweep, &it, &name))
            .collect();
        store::write_borders(&axes, &rows, &folder.borders())
    }
}
