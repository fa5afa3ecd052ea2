//! Labels of the same runs by other thresholds and rules.

use crate::error::Failure;
use crate::folder::{folder_at, sweep_of, table_of};
use crate::record::Record;
use crate::table::{Attribute, Table, Values, Variable};
use crate::text::to_toml;
use crate::watch::{threads_or_all, watched};
use phase::classify::{Verdict, classify};
use phase::document::LoadError;
use phase::sweep::{Folder, Labelling, Sweep};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// How errors call the text that states thresholds and rules.
const NAME: &str = "<labels>";

/// Labels the runs of a results folder from their records, and writes nothing.
#[pyfunction]
pub(crate) fn classify_folder(
    py: Python<'_>,
    path: PathBuf,
    changes: &Bound<'_, PyDict>,
    threads: Option<usize>,
) -> PyResult<Table> {
    let text = to_toml(changes)?;
    watched(py, None, |_| {
        let folder = folder_at(&path)?;
        let sweep = sweep_of(&folder)?.relabelled(&text, Path::new(NAME));
        let sweep = sweep.map_err(Failure::of_text)?;
        let labelling = labelling_of(&folder, &sweep, threads_or_all(threads)?)?;
        table_of(&sweep, &labelling.table)
    })
}

/// The labels of all runs so far, which must have records.
fn labelling_of(folder: &Folder, sweep: &Sweep, threads: usize) -> Result<Labelling, Failure> {
    let refining = folder.read_refining(sweep)?;
    let jobs = sweep.jobs_so_far(refining.as_ref())?;
    sweep.check_sieves(&jobs)?;
    let labelling = Labelling::new(folder, sweep, &jobs, threads)?;
    let root = folder.root();
    if let Some(problem) = labelling.problems.first() {
        return Err(Failure::failed(problem).of(root));
    }
    if labelling.table.rows.is_empty() {
        let refused = format!("{}: no run has a record to label it from", root.display());
        return Err(Failure::refused(refused)
            .help("make the runs by phase.sweep; published results come without records")
            .of(root));
    }
    Ok(labelling)
}

/// Labels one run from its record.
#[pyfunction]
pub(crate) fn classify_record(
    py: Python<'_>,
    record: &Record,
    changes: &Bound<'_, PyDict>,
) -> PyResult<Table> {
    let text = to_toml(changes)?;
    let record = &record.0;
    watched(py, None, |_| {
        let sweep = Sweep::of_scene(record.scene.clone());
        let sweep = sweep.relabelled(&text, Path::new(NAME));
        let sweep = sweep.map_err(|error: LoadError| Failure::of_text(error))?;
        Ok(table_of_verdict(&classify(record, &sweep.sieves)?))
    })
}

/// Label, code and measures of one run, without dimensions.
fn table_of_verdict(verdict: &Verdict) -> Table {
    let mut table = Table::default();
    let label = Values::Text(vec![verdict.label.name.to_owned()]);
    let code = Values::Integer(vec![verdict.label.code.into()]);
    table.variables.extend([
        Variable::new("label", &[], label).with("long_name", "Label"),
        Variable::new("code", &[], code).with("long_name", "Number of the label"),
    ]);
    for (measure, value) in verdict.family.measures().zip(&verdict.values) {
        let value = Values::Double(vec![value.unwrap_or(f64::NAN)]);
        let variable = Variable::new(measure.name, &[], value);
        table
            .variables
            .push(variable.of(measure.unit, measure.description.trim()));
    }
    table
        .attributes
        .push(("family", Attribute::from(verdict.family.name)));
    table
}
