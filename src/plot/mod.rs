//! Figures: one file each, and the parts they share.
//!
//! A figure is drawn with plotters on a canvas that writes SVG; resvg makes the PNG of it,
//! with a font that is part of the program. The same input gives the same bytes.
//!
//! Figures read tables and records (a [`Source`]), never simulations.
//!
//! To add a figure: a file with a function `figure`, and a line in the table of `figure.rs`.

mod ablation;
mod accuracy;
mod axes;
mod beverloo;
mod canvas;
mod captions;
mod chart;
mod choice;
mod color_bar;
mod contour;
mod critical;
mod critical_rotation;
mod diagram;
mod drainage;
mod energies;
mod error;
mod figure;
mod grid;
mod ledger;
mod legend;
mod map;
mod measures;
mod net_force;
mod numbers;
mod page;
mod palette;
mod panel_curve;
mod phase;
mod png;
mod records;
mod refined;
mod runs;
mod scale;
mod series;
mod spacing;
mod speeds;
mod stability;
mod states;
mod style;
mod svg;
mod text;
mod ticks;
mod tracks;
pub mod verification;
mod words;

pub use beverloo::{FittedLaw, fitted_lines};
pub use critical::{TheoryCurve, theory_curves};
pub use error::{PlotError, PlotErrorKind};
pub use figure::{Figure, figures};
pub use grid::{ShownAxis, check, places, shown_axis};
pub use map::figures_of_rules;
pub use records::{RecordSet, captions, differences};
pub use svg::Svg;

use crate::classify::LabelTable;
use crate::record::{Program, RunRecord};
use crate::store::StoreError;
use crate::study::ablation::{Ablated, Ablation};
use crate::study::accuracy::{AccuracyStudy, Evaluation};
use crate::study::comparison::{Comparison, Cost, RunRow};
use crate::study::stability::StabilityStudy;
use crate::sweep::{Failure, Refining, Selection, Sweep};
use figure::Draw;
use runs::Runs;
use svg::Origin;
use verification::CaseError;

/// What figures are drawn from: tables and records, never simulations.
pub enum FigureInput<'a> {
    /// A sweep with its labels and runs.
    Sweep(&'a Source<'a>),
    /// Records beside each other.
    Records(RecordSet<'a>),
    /// What a study found, and the program that made its runs.
    Study(StudyResult<'a>, &'a Program),
}

/// A sweep with its labels and runs.
pub struct Source<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    /// How far it is, if it is refined.
    pub refining: Option<&'a Refining>,
    /// Labels of its runs.
    pub table: &'a LabelTable,
    /// Its jobs that failed.
    pub failures: &'a [Failure],
    /// Fetches the record of a run by its identity.
    pub record: &'a dyn Fn(&str) -> Result<RunRecord, StoreError>,
    /// Points to show in figures of single runs: values by name of an axis, and `seed`. None for
    /// the choice of the figure.
    pub points: &'a [Selection],
    /// First and last time (s) of the states that figures of drainages show or measure. None for
    /// the choice of the figure.
    pub times: Option<[f64; 2]>,
    /// What goes into the file's metadata.
    pub program: &'a Program,
}

/// What studies found, each of which has figures of its own.
#[derive(Clone, Copy)]
pub enum StudyResult<'a> {
    /// The cases of `phase verify`.
    Verification(&'a [CaseError]),
    /// A study of stability, and the rows of its runs.
    Stability(&'a StabilityStudy, &'a [Option<RunRow>]),
    /// A study of accuracy, and what follows from its runs.
    Accuracy(&'a AccuracyStudy, &'a Evaluation),
    /// The rows of the runs of a study of accuracy, and what the time of a step is drawn against:
    /// the name of an axis, or the last part of a ladder's key.
    StepTimes(&'a Comparison, &'a [Option<RunRow>], &'a str),
    /// An ablation, what each simplification does, and what a run of the scene as it is costs.
    Ablation(&'a Ablation, &'a [Ablated], &'a Cost),
}

impl<'a> From<&'a Source<'a>> for FigureInput<'a> {
    fn from(source: &'a Source<'a>) -> Self {
        Self::Sweep(source)
    }
}

impl<'a> From<RecordSet<'a>> for FigureInput<'a> {
    fn from(records: RecordSet<'a>) -> Self {
        Self::Records(records)
    }
}

impl<'a> From<(StudyResult<'a>, &'a Program)> for FigureInput<'a> {
    fn from((study, program): (StudyResult<'a>, &'a Program)) -> Self {
        Self::Study(study, program)
    }
}

impl Source<'_> {
    /// What the metadata of its figures say.
    fn origin(&self) -> Origin<'_> {
        Origin {
            title: self.sweep.title.as_deref(),
            seeds: self.table.rows.iter().map(|row| row.seed).collect(),
            program: self.program,
        }
    }
}

/// Draws the figure `name`: of a sweep with the axes that its plot settings choose, of records
/// beside each other, or of a study.
///
/// The table of a sweep may be incomplete: cells without a row are marked.
///
/// # Errors
///
/// [`PlotError`] for a figure, an axis or a point that does not exist, for a table that is empty or
/// not of this sweep, for a record that cannot be read, for records of several families.
pub fn draw<'a>(name: &str, input: impl Into<FigureInput<'a>>) -> Result<Svg, PlotError> {
    match input.into() {
        FigureInput::Sweep(source) => draw_sweep(name, source),
        FigureInput::Records(records) => draw_records(name, &records),
        FigureInput::Study(study, program) => {
            let figure = figures().iter().find(|figure| figure.name == name);
            let drawn = match figure.map(|figure| &figure.draw) {
                Some(Draw::Study(draw)) => draw(study, program),
                _ => None,
            };
            drawn.unwrap_or_else(|| {
                Err(PlotError::request(format_args!(
                    "the figure `{name}` is not of this study"
                )))
            })
        }
    }
}

fn draw_sweep(name: &str, source: &Source<'_>) -> Result<Svg, PlotError> {
    let known = || figures().iter().filter(|figure| figure.is_of_sweep());
    let names = |known: &mut dyn Iterator<Item = &Figure>| {
        let names: Vec<&str> = known.map(|figure| figure.name).collect();
        names.join(", ")
    };
    let Some(figure) = known().find(|figure| figure.name == name) else {
        if let Some(map) = map::of_rules(name, source.table.family) {
            return map.draw(source);
        }
        return Err(PlotError::request(format_args!(
            "there is no figure `{name}`; the figures are {}",
            names(&mut known())
        )));
    };
    let family = source.table.family;
    if !figure.applies_to(family) {
        let mut own = known().filter(|figure| figure.applies_to(family));
        return Err(PlotError::request(format_args!(
            "`{name}` is not a figure of a {}; available: {}",
            family.name,
            names(&mut own)
        )));
    }
    if figure.default_runs().is_none() && !source.points.is_empty() {
        return Err(PlotError::no_points(name));
    }
    figure.check_options(source.times.is_some(), false)?;
    match &figure.draw {
        Draw::Sweep(draw) => draw(source),
        Draw::Runs { default, draw, .. } => {
            for scene in source.sweep.scenes() {
                figure.check_columns(&scene.output)?;
            }
            draw(&Runs::of_sweep(source, default)?)
        }
        Draw::Record(_) | Draw::Study(_) => Err(PlotError::no_points(name)),
    }
}

fn draw_records(name: &str, records: &RecordSet<'_>) -> Result<Svg, PlotError> {
    let figure = figures().iter().find(|figure| figure.name == name);
    let Some(figure) = figure.filter(|it| it.is_of_one_record() || it.default_runs().is_some())
    else {
        return Err(PlotError::no_points(name));
    };
    let check = || figure.check_options(records.times.is_some(), !records.data.is_empty());
    match (&figure.draw, records.records) {
        (Draw::Record(draw), [record]) => {
            check()?;
            figure.check_columns(&record.scene.output)?;
            draw(record)
        }
        (Draw::Runs { draw, .. }, _) => {
            let runs = Runs::of_records(records)?;
            check()?;
            for record in records.records {
                figure.check_columns(&record.scene.output)?;
            }
            draw(&runs)
        }
        _ => Err(PlotError::request(format_args!(
            "the figure `{name}` is of one record: give them one by one"
        ))),
    }
}
