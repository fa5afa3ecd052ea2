//! A sweep on a page.

mod axes;
mod curves;
mod holes;
mod rules;

use super::document::{
    FailedColumns, LabelEntry, LatticeEntry, MeasureEntry, RunColumns, SceneEntry, SeriesEntry,
    StatesEntry, SweepSection, ViewEntry,
};
use super::series::SeriesOfRuns;
use super::states::states as states_of;
use crate::classify::{Family, Label, LabelRow, LabelTable, Measure};
use crate::plot::{self, PlotError};
use crate::record::RunRecord;
use crate::store::StoreError;
use crate::sweep::{Failure, Learnt, Sweep};
use axes::AxisWithPlaces;
use holes::HolesOfRuns;
use rayon::prelude::*;
use serde_json::Value;

/// Points of each column over time that a page of a sweep keeps at most, and bytes of each.
const POINTS: usize = 200;
const WIDTH: u32 = 1;

/// Most numbers in the columns over time of all runs of a page: about a megabyte.
const MOST_NUMBERS: usize = 1_500_000;

/// Fewest points of a column, however many runs there are.
const LEAST_POINTS: usize = 20;

/// Records that are in memory at once.
const AT_ONCE: usize = 16;

const WITHOUT_RECORDS: &str = "This folder has labels without their records, so the page has \
                               neither columns over time nor animations. The command of a point \
                               makes its runs again.";

/// What a page shows of a sweep.
pub struct SweepResults<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    /// Labels of its runs.
    pub table: &'a LabelTable,
    /// What a refined sweep has learnt.
    pub learnt: Option<&'a Learnt>,
    /// Its jobs that failed.
    pub failures: &'a [Failure],
    /// Reads the record of a run; none where records are not kept.
    pub record: Option<&'a RecordReader<'a>>,
    /// Rows of the runs that are animated.
    pub animated: &'a [usize],
    /// The folder, as commands name it.
    pub folder: String,
}

/// Reads the record of a run by its identity.
pub type RecordReader<'a> = dyn Fn(&str) -> Result<RunRecord, StoreError> + Sync + 'a;

/// The section of a sweep. Records that cannot be read are left out, and the page says so.
///
/// # Errors
/// The table is not one of the sweep, or it is empty.
pub fn sweep(results: &SweepResults<'_>) -> Result<SweepSection, PlotError> {
    let SweepResults { sweep, table, .. } = results;
    plot::check(sweep, table)?;
    let family = table.family;
    let axes: Vec<AxisWithPlaces> = sweep
        .axes
        .iter()
        .enumerate()
        .map(|(place, axis)| AxisWithPlaces::new(axis, place, results))
        .collect();
    let labels = family.labels();
    let places = |values: &[f64]| -> Vec<usize> {
        let pairs = axes.iter().zip(values);
        pairs.map(|(axis, value)| axis.place(*value)).collect()
    };
    let mut notes = Vec::new();
    let read = of_records(results, &mut notes);
    let measures: Vec<&Measure> = family.measures().collect();
    let view = view(sweep);
    Ok(SweepSection {
        title: title(sweep),
        runs: runs(&table.rows, &labels, &places),
        measures: measures.iter().map(|it| measure(it, &table.rows)).collect(),
        rules: rules::rules(results, &labels, read.holes),
        lattice: results.learnt.map(|learnt| lattice(learnt, &labels)),
        curves: match usize::try_from(view.y) {
            Ok(y) => curves::curves(results, &axes, [view.x, y]),
            Err(_) => Vec::new(),
        },
        series: read.series,
        states: read.states,
        scene: SceneEntry::of(&sweep.scene),
        command: Some(format!(
            "phase run --from {} --point {{point}} --out {{id}}.h5",
            results.folder
        )),
        failed: failed(results.failures, &places),
        view,
        notes,
        labels: labels.iter().map(label_entry).collect(),
        axes: axes.into_iter().map(|axis| axis.entry).collect(),
    })
}

fn title(sweep: &Sweep) -> String {
    let title = sweep.title.as_ref().or(sweep.scene.title.as_ref());
    title.cloned().unwrap_or_else(|| "Sweep".to_owned())
}

/// A label with its colour.
pub(super) fn label_entry(label: &Label) -> LabelEntry {
    let [red, green, blue] = label.color;
    LabelEntry {
        name: label.name,
        code: label.code,
        color: format!("#{red:02x}{green:02x}{blue:02x}"),
        hatched: *label == Label::UNSTABLE,
    }
}

/// Columns of the runs; a run's places among the values of the axes follow from its point.
fn runs(rows: &[LabelRow], labels: &[Label], places: &impl Fn(&[f64]) -> Vec<usize>) -> RunColumns {
    let place_of = |row: &LabelRow| {
        let place = labels.iter().position(|label| *label == row.verdict.label);
        place.unwrap_or(0)
    };
    let is_steady = rows.iter().any(|row| row.verdict.steady.is_some());
    let steady = rows.iter().map(|row| row.verdict.steady.map(u8::from));
    RunColumns {
        label: rows.iter().map(place_of).collect(),
        places: by_axis(rows.iter().map(|row| places(&row.values))),
        seed: rows.iter().map(|row| seed(row.seed)).collect(),
        id: rows.iter().map(|row| row.id.clone()).collect(),
        steady: steady.filter(|_| is_steady).collect(),
    }
}

/// A list for each axis from a list for each point.
pub(super) fn by_axis(points: impl Iterator<Item = Vec<usize>>) -> Vec<Vec<usize>> {
    let mut columns: Vec<Vec<usize>> = Vec::new();
    for point in points {
        columns.resize(point.len().max(columns.len()), Vec::new());
        for (column, place) in columns.iter_mut().zip(point) {
            column.push(place);
        }
    }
    columns
}

/// A seed; as a text where scripts have no such whole number.
fn seed(seed: u64) -> Value {
    match seed < 1 << 53 {
        true => Value::from(seed),
        false => Value::from(seed.to_string()),
    }
}

fn measure(measure: &Measure, rows: &[LabelRow]) -> MeasureEntry {
    let values = rows.iter().map(|row| row.verdict.value(measure.name));
    MeasureEntry::new(measure, values.collect())
}

fn lattice(learnt: &Learnt, labels: &[Label]) -> LatticeEntry {
    let places = 0..learnt.map.places();
    let label = |place: usize| {
        let code = learnt.map.label(place);
        labels.iter().position(|it| it.code == code).unwrap_or(0)
    };
    let certainty = |place: usize| (1e3 * learnt.map.certainty(place)).round() / 1e3;
    LatticeEntry {
        label: places.clone().map(label).collect(),
        certainty: places.map(certainty).collect(),
    }
}

/// What a page shows of records.
#[derive(Default)]
struct ReadRecords {
    series: Option<SeriesEntry>,
    states: Vec<StatesEntry>,
    holes: Option<HolesOfRuns>,
}

/// Columns over time of all runs, and the spheres of some, as far as there are records.
fn of_records(results: &SweepResults<'_>, notes: &mut Vec<String>) -> ReadRecords {
    let Some(read) = results.record else {
        notes.push(WITHOUT_RECORDS.to_owned());
        return ReadRecords::default();
    };
    let sieves = &results.sweep.sieves;
    let rows = &results.table.rows;
    let mut holes = HolesOfRuns::new(results.table.family, sieves, rows.len());
    let mut series: Option<SeriesOfRuns> = None;
    let mut states = Vec::new();
    let mut lost = 0;
    for (part, rows_of_part) in rows.chunks(AT_ONCE).enumerate() {
        let from = part * AT_ONCE;
        let read = |(place, row): (usize, &LabelRow)| {
            let run = from + place;
            let record = read(&row.id).ok()?;
            Some(ReadRun {
                holes: holes
                    .as_ref()
                    .and_then(|holes| holes.shares(&record, sieves)),
                states: match results.animated.contains(&run) {
                    true => states_of(run, &record),
                    false => None,
                },
                run,
                record,
            })
        };
        let found: Vec<Option<ReadRun>> = rows_of_part.par_iter().enumerate().map(read).collect();
        lost += found.iter().filter(|it| it.is_none()).count();
        for read in found.into_iter().flatten() {
            let columns = read.record.observations.scalars().len().max(1);
            let points = (MOST_NUMBERS / rows.len() / columns).clamp(LEAST_POINTS, POINTS);
            let series = series.get_or_insert_with(|| SeriesOfRuns::new(points, WIDTH));
            series.add(read.run, &read.record);
            states.extend(read.states);
            if let Some((holes, shares)) = holes.as_mut().zip(read.holes) {
                holes.add(read.run, shares);
            }
        }
    }
    if lost > 0 {
        notes.push(format!(
            "{lost} of {} records could not be read.",
            rows.len()
        ));
    }
    ReadRecords {
        series: series.and_then(|it| it.entry(WIDTH)),
        states,
        holes: holes.and_then(HolesOfRuns::of_all),
    }
}

/// What is read of a run.
struct ReadRun {
    run: usize,
    record: RunRecord,
    states: Option<StatesEntry>,
    holes: Option<Vec<Option<f64>>>,
}

fn failed(failures: &[Failure], places: &impl Fn(&[f64]) -> Vec<usize>) -> Option<FailedColumns> {
    (!failures.is_empty()).then(|| FailedColumns {
        places: by_axis(failures.iter().map(|it| places(&it.values))),
        seed: failures.iter().map(|it| seed(it.seed)).collect(),
        message: failures.iter().map(|it| it.reason.clone()).collect(),
    })
}

/// The axes that a figure of the sweep shows.
fn view(sweep: &Sweep) -> ViewEntry {
    let places = plot::places(sweep).unwrap_or([Some(0), None, None, None]);
    ViewEntry {
        x: places[0].unwrap_or(0),
        y: places[1].map_or(-1, |it| it as i64),
    }
}

/// The row in the middle of the runs of each label: one animation a label.
pub fn one_of_each_label(table: &LabelTable) -> Vec<usize> {
    let labels = Family::labels(table.family).into_iter();
    let middle = |label: Label| {
        let rows = table.rows.iter().enumerate();
        let own = rows.filter(|(_, row)| row.verdict.label == label);
        let own: Vec<usize> = own.map(|(place, _)| place).collect();
        own.get(own.len() / 2).copied()
    };
    let mut rows: Vec<usize> = labels.filter_map(middle).collect();
    rows.sort_unstable();
    rows
}
