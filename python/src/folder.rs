//! The table of labels of a results folder as a data set on the axes and seeds of its sweep.

use crate::error::Failure;
use crate::table::{Attribute, Table, Values, Variable};
use crate::watch::watched;
use phase::classify::{LabelRow, LabelTable};
use phase::grid::Axis;
use phase::sweep::{FAILED, Folder, Sweep};
use pyo3::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Name of the dimension of seeds.
const SEED: &str = "seed";

/// Reads the labels of a results folder.
#[pyfunction]
pub(crate) fn open_folder(py: Python<'_>, path: PathBuf) -> PyResult<Table> {
    watched(py, None, |_| {
        let folder = folder_at(&path)?;
        let sweep = sweep_of(&folder)?;
        let labels = labels_of(&folder)?;
        table_of(&sweep, &labels).map_err(|failure| failure.of(&folder.labels()))
    })
}

/// The results folder at a path, which must hold one sweep.
pub(crate) fn folder_at(path: &Path) -> Result<Folder, Failure> {
    let mut found = Folder::find(path).map_err(|error| Failure::from(error).of(path))?;
    match (found.pop(), found.is_empty()) {
        (Some(folder), true) => Ok(folder),
        _ => Err(Failure::refused(format_args!(
            "{}: this folder holds several results folders",
            path.display()
        ))
        .help("give one of them")
        .of(path)),
    }
}

/// The sweep of a folder, which is not that of a study.
pub(crate) fn sweep_of(folder: &Folder) -> Result<Sweep, Failure> {
    let sweep = folder.read_sweep();
    let sweep = sweep.map_err(|error| Failure::from(error).of(&folder.sweep()))?;
    match sweep.study {
        None => Ok(sweep),
        Some(_) => Err(Failure::refused(format_args!(
            "{}: this folder holds the results of a study",
            folder.root().display()
        ))
        .help("read its runs.csv")
        .of(folder.root())),
    }
}

/// The labels of a folder.
pub(crate) fn labels_of(folder: &Folder) -> Result<LabelTable, Failure> {
    let (path, root) = (folder.labels(), folder.root().display());
    if !path.exists() {
        return Err(Failure::refused(format_args!("{root}: no labels yet"))
            .help(format!("run `phase classify {root}`, or phase.sweep"))
            .of(&path));
    }
    let labels = folder.read_labels();
    labels.map_err(|error| Failure::from(error).of(&path))
}

/// Labels and measures on the axes and seeds of a sweep.
pub(crate) fn table_of(sweep: &Sweep, labels: &LabelTable) -> Result<Table, Failure> {
    let grid = Grid::new(sweep, labels)?;
    let mut table = Table {
        coordinates: grid.coordinates(),
        ..Table::default()
    };
    let text = |of: fn(&LabelRow) -> &str| {
        Values::Text(grid.spread(String::new(), |row| of(row).to_owned()))
    };
    let label = grid.variable("label", text(|row| row.verdict.label.name));
    let code = Values::Integer(grid.spread(FAILED.into(), |row| row.verdict.label.code.into()));
    let code = code_of_labels(grid.variable("code", code), labels);
    let id = grid.variable("id", text(|row| &row.id));
    table.variables.extend([
        label.with("long_name", "Label"),
        code.with("long_name", "Number of the label"),
        id.with("long_name", "Identity of the run, the name of its record"),
    ]);
    if labels.has_steady() {
        let steady = |row: &LabelRow| row.verdict.steady.map_or(f64::NAN, f64::from);
        let steady = grid.variable("steady", Values::Double(grid.spread(f64::NAN, steady)));
        table
            .variables
            .push(steady.of("1", "Whether the run became steady before its end"));
    }
    for (place, measure) in labels.family.measures().enumerate() {
        let value = |row: &LabelRow| row.verdict.values.get(place).copied().flatten();
        let values = grid.spread(f64::NAN, |row| value(row).unwrap_or(f64::NAN));
        let variable = grid.variable(measure.name, Values::Double(values));
        let description = measure.description.trim();
        table.variables.push(variable.of(measure.unit, description));
    }
    let title = sweep.title.clone();
    table
        .attributes
        .extend(title.map(|title| ("title", Attribute::Text(title))));
    table
        .attributes
        .push(("family", Attribute::from(labels.family.name)));
    table
        .attributes
        .push(("refined", Attribute::Truth(sweep.refine.is_some())));
    Ok(table)
}

/// The same variable with what its codes mean.
fn code_of_labels(variable: Variable, labels: &LabelTable) -> Variable {
    let labels = labels.family.labels();
    let codes = labels.iter().map(|label| label.code.into()).collect();
    let names: Vec<&str> = labels.iter().map(|label| label.name).collect();
    variable
        .with("flag_values", Attribute::Integers(codes))
        .with("flag_meanings", Attribute::Text(names.join(" ")))
}

/// Axes and seeds, and the row of each of their combinations.
struct Grid<'a> {
    sweep: &'a Sweep,
    rows: Vec<Option<&'a LabelRow>>,
}

impl<'a> Grid<'a> {
    fn new(sweep: &'a Sweep, labels: &'a LabelTable) -> Result<Self, Failure> {
        let mut rows = vec![None; sweep.points() * sweep.seeds.len()];
        let places = Places::new(sweep);
        for row in &labels.rows {
            let Some(place) = places.of(row) else {
                let failure = format!("the run {} is at no point of the sweep", row.id);
                return Err(Failure::failed(failure).help("`phase classify` rewrites the table"));
            };
            rows[place] = Some(row);
        }
        Ok(Self { sweep, rows })
    }

    /// Names and extents of the dimensions.
    fn dimensions(&self) -> Vec<(&'a str, usize)> {
        let axes = self.sweep.axes.iter();
        let axes = axes.map(|axis| (axis.name.as_str(), axis.values.len()));
        axes.chain([(SEED, self.sweep.seeds.len())]).collect()
    }

    fn coordinates(&self) -> Vec<Variable> {
        let axes = self.sweep.axes.iter();
        let mut all: Vec<Variable> = axes.map(|axis| coordinate_of(axis, self.sweep)).collect();
        let seeds = self.sweep.seeds.iter().map(|seed| seed.cast_signed());
        let seeds = Variable::coordinate(SEED, Values::Integer(seeds.collect()));
        all.push(seeds.with("long_name", "Seed"));
        all
    }

    fn variable(&self, name: &str, values: Values) -> Variable {
        Variable::new(name, &self.dimensions(), values)
    }

    /// What each row has, and `missing` where there is none.
    fn spread<T: Clone>(&self, missing: T, value: impl Fn(&LabelRow) -> T) -> Vec<T> {
        let rows = self.rows.iter();
        rows.map(|row| row.map_or(missing.clone(), &value))
            .collect()
    }
}

/// The values of an axis, with their unit; of variants their names.
pub(crate) fn coordinate_of(axis: &Axis, sweep: &Sweep) -> Variable {
    if axis.is_of_variants() {
        return Variable::coordinate(&axis.name, Values::Text(axis.words()));
    }
    let variable = Variable::coordinate(&axis.name, Values::Double(axis.values.clone()));
    match sweep.scene.notation(&axis.key) {
        Some(notation) => variable.of(notation.unit, notation.name),
        None => variable,
    }
    .with("key", axis.key.as_str())
}

/// Where values and seeds stand.
struct Places {
    axes: Vec<HashMap<u64, usize>>,
    seeds: HashMap<u64, usize>,
}

impl Places {
    fn new(sweep: &Sweep) -> Self {
        let by_bits = |axis: &Axis| {
            let places = axis.values.iter().enumerate();
            // Both zeros are one value.
            places
                .map(|(place, value)| ((value + 0.0).to_bits(), place))
                .collect()
        };
        let seeds = sweep.seeds.iter().enumerate();
        Self {
            axes: sweep.axes.iter().map(by_bits).collect(),
            seeds: seeds.map(|(place, seed)| (*seed, place)).collect(),
        }
    }

    /// Place of a row in the grid, the last axis and then seeds fastest.
    fn of(&self, row: &LabelRow) -> Option<usize> {
        let mut all = 0;
        for (axis, value) in self.axes.iter().zip(&row.values) {
            all = all * axis.len() + axis.get(&(value + 0.0).to_bits())?;
        }
        Some(all * self.seeds.len() + self.seeds.get(&row.seed)?)
    }
}
