//! Figures: one file each, and the parts they share.
//!
//! A figure is drawn with plotters on a canvas that writes SVG; resvg makes the PNG of it,
//! with a font that is part of the program. The same input gives the same bytes.
//!
//! Figures read tables and records (a [`Source`]), never simulations.
//!
//! To add a figure: a file with an implementation of `Figure`, and a line in `all`.

pub mod ablation;
pub mod accuracy;
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
mod grid;
mod ledger;
mod legend;
mod map;
mod measures;
mod net_force;
mod numbers;
mod page;
mod palette;
mod phase;
mod png;
mod records;
mod refined;
mod scale;
mod series;
mod spacing;
mod speeds;
pub mod stability;
mod states;
mod style;
mod svg;
mod text;
mod ticks;
mod tracks;
pub mod verification;
mod words;

pub use beverloo::{FittedLine, fitted_lines};
pub use ledger::draw as draw_ledger;
pub use records::{captions, differences, draw_records};
pub use svg::Svg;
pub use tracks::draw as draw_tracks;

use crate::classify::Family;
use crate::classify::LabelTable;
use crate::record::{Program, RunRecord};
use crate::refine::RefineError;
use crate::refusal::Refusal;
use crate::store::{DataSet, StoreError};
use crate::sweep::{Refining, SelectError, Selection, Sweep};

/// What figures are drawn from: tables and records, never simulations.
pub struct Source<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    /// How far it is, if it is refined.
    pub refining: Option<&'a Refining>,
    /// Labels of its runs.
    pub table: &'a LabelTable,
    /// Fetches the record of a run by its identity.
    pub record: &'a dyn Fn(&str) -> Result<RunRecord, StoreError>,
    /// Points to show in figures of single runs: values by name of an axis, and `seed`. None for
    /// the choice of the figure.
    pub points: &'a [Selection],
    /// First and last time (s) of the states that figures of drainages show or measure. None for
    /// the choice of the figure.
    pub times: Option<[f64; 2]>,
    /// What names each run of the table in figures of single runs, all of which are shown then.
    /// Empty for runs that their places in the sweep name.
    pub captions: &'a [Vec<String>],
    /// Curves of other sources beside those of the runs, in figures of lines.
    pub data: &'a [DataSet],
    /// What goes into the file's metadata.
    pub program: &'a Program,
}

/// A figure.
trait Figure: Sync {
    /// Name, as on the command line and in file names.
    fn name(&self) -> &'static str;

    /// What it shows, in one line.
    fn description(&self) -> String;

    /// Which runs it shows if no points are asked for; none for a figure that is not of single
    /// runs.
    fn default_runs(&self) -> Option<&'static str> {
        None
    }

    /// The families of scenes that it is for; none for all.
    fn families(&self) -> Vec<&'static Family> {
        Vec::new()
    }

    /// Whether it shows curves of other sources beside those of the runs.
    fn takes_data(&self) -> bool {
        false
    }

    /// Draws it.
    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError>;
}

/// All figures.
fn all() -> Vec<&'static dyn Figure> {
    let mut figures: Vec<&dyn Figure> = vec![
        &phase::PhaseDiagram,
        &refined::RefinedDiagram,
        &states::States,
        &speeds::Speeds,
        &energies::ENERGIES,
        &energies::STATE_ENERGIES,
        &critical_rotation::CriticalRotation,
        &net_force::NetForce,
        &beverloo::Beverloo,
        &measures::MeasuresFigure,
    ];
    figures.extend(drainage::FIGURES);
    figures.extend(map::MAPS.iter().map(|map| map as &dyn Figure));
    figures
}

/// What is known of a figure without drawing it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    /// Name, as on the command line and in file names.
    pub name: &'static str,
    /// What it shows, in one line.
    pub description: String,
    /// Which runs it shows if no points are asked for; none for a figure that is not of single
    /// runs.
    pub default_runs: Option<&'static str>,
    /// The families of scenes that it is for; none for all.
    pub families: Vec<&'static Family>,
}

impl About {
    fn of(figure: &dyn Figure) -> Self {
        Self {
            name: figure.name(),
            description: figure.description(),
            default_runs: figure.default_runs(),
            families: figure.families(),
        }
    }

    /// Whether the figure can be drawn of scenes of a family.
    pub fn applies_to(&self, family: &Family) -> bool {
        self.families.is_empty() || self.families.contains(&family)
    }
}

/// All figures.
pub fn figures() -> Vec<About> {
    all().into_iter().map(About::of).collect()
}

/// Draws the figure `name`, with the axes that the sweep's plot settings choose.
///
/// The table may be incomplete: cells without a row are marked.
///
/// # Errors
///
/// [`PlotError`] for a figure, an axis or a point that does not exist, for a table that is empty or
/// not of this sweep, for a record that cannot be read.
pub fn draw(name: &str, source: &Source<'_>) -> Result<Svg, PlotError> {
    let figures = all();
    let Some(figure) = figures.iter().find(|figure| figure.name() == name) else {
        let known: Vec<&str> = figures.iter().map(|figure| figure.name()).collect();
        return Err(PlotError::UnknownFigure {
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    let family = source.table.family;
    if !About::of(*figure).applies_to(family) {
        let others = figures.iter().map(|figure| About::of(*figure));
        let others = others.filter(|other| other.applies_to(family));
        let known: Vec<&str> = others.map(|figure| figure.name).collect();
        return Err(PlotError::OtherFamily {
            name: figure.name(),
            family: family.name,
            known: known.join(", "),
        });
    }
    if figure.default_runs().is_none() && !source.points.is_empty() {
        return Err(PlotError::NoPoints(figure.name().to_owned()));
    }
    draw_with_options(*figure, source)
}

/// Draws a figure, unless times or data are given that it does not look at.
fn draw_with_options(figure: &dyn Figure, source: &Source<'_>) -> Result<Svg, PlotError> {
    let mut of_drainages = drainage::FIGURES.iter();
    if source.times.is_some() && !of_drainages.any(|it| it.name() == figure.name()) {
        return Err(PlotError::NoTimes(figure.name()));
    }
    if !source.data.is_empty() && !figure.takes_data() {
        return Err(PlotError::NoData(figure.name()));
    }
    figure.draw(source)
}

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// There is no figure of that name.
    #[error("there is no figure `{name}`; the figures are {known}")]
    UnknownFigure {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The figure is for the other family of scenes.
    #[error("`{name}` is not a figure of a {family}; available: {known}")]
    OtherFamily {
        /// The name asked for.
        name: &'static str,
        /// The family of the sweep's scene.
        family: &'static str,
        /// The names that the family has.
        known: String,
    },
    /// The sweep has no axis that the figure is over.
    #[error("the figure `{figure}` needs a sweep over `{key}`")]
    NeedsAxis {
        /// The figure.
        figure: &'static str,
        /// The key of the axis.
        key: &'static str,
    },
    /// The runs of a line do not allow to fit its law.
    #[error("{line}: {reason}")]
    Fit {
        /// Which line.
        line: String,
        /// Why not.
        reason: String,
    },
    /// The plot settings name an axis that the sweep does not have.
    #[error("[plot] names the axis `{name}`, but the axes of this sweep are {known}")]
    UnknownAxis {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
    /// The plot settings give one axis two places.
    #[error("[plot] uses the axis `{name}` twice; x, y and panels must differ")]
    AxisTwice {
        /// The axis.
        name: String,
    },
    /// The sweep is not refined.
    #[error(
        "the figure `refined` needs a refined sweep: a table [refine] in its file, or `phase sweep \
         --refine`"
    )]
    NotRefined,
    /// What a refined sweep has learnt cannot be told.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// There is no axis to draw along.
    #[error("no axis is left for x: the figure needs a sweep over at least one axis")]
    NoAxis,
    /// There are more axes than places.
    #[error("a figure shows at most four axes: x, y, and two of small multiples")]
    TooManyAxes,
    /// Points are asked for in a figure of all of them.
    #[error("the figure `{0}` shows no single runs, so it takes no points")]
    NoPoints(String),
    /// Times are asked for in a figure that has none to choose.
    #[error("the figure `{0}` looks at whole runs, so it takes no times; those of drainages do")]
    NoTimes(&'static str),
    /// Data are given to a figure that shows none.
    #[error(
        "the figure `{0}` shows no data beside runs; figures of drainages do in which each run is \
         a line, such as `outflow` and `cross-profile`"
    )]
    NoData(&'static str),
    /// The sweep has no such point.
    #[error(transparent)]
    Select(#[from] SelectError),
    /// A point asked for is more than one.
    #[error("the point {point} leaves the axis `{name}` open; it takes {values}")]
    OpenAxis {
        /// The point.
        point: String,
        /// The axis.
        name: String,
        /// Its values.
        values: String,
    },
    /// No run at a point has a label.
    #[error(
        "no run at {point} is in the table of labels; run `phase sweep` again to complete it, or \
         choose another point or seed"
    )]
    NoRun {
        /// The point.
        point: String,
    },
    /// The record of a run cannot be used.
    #[error("the run at {point}: {source}")]
    Record {
        /// The point.
        point: String,
        /// What is wrong with the record.
        source: StoreError,
    },
    /// Records of one figure are of several families of scenes.
    #[error("one record is of a {first}, another of a {other}: give those of one family")]
    Families {
        /// The family of the first record.
        first: &'static str,
        /// The family of the other.
        other: &'static str,
    },
    /// The scene lacks what a figure shows.
    #[error("the figure `{figure}` needs a scene with {needs}")]
    Scene {
        /// The figure.
        figure: &'static str,
        /// What the scene lacks.
        needs: &'static str,
    },
    /// There is nothing to draw.
    #[error(
        "the table of labels is empty: no run of this sweep has ended and been classified; `phase \
         sweep` goes on with it"
    )]
    EmptyTable,
    /// No run has what the figure shows.
    #[error(
        "no run has a measure that the figure `{figure}` shows; give runs that differ, or times in \
         which they have states"
    )]
    NoMeasures {
        /// The figure.
        figure: &'static str,
    },
    /// The table was not made of this sweep.
    #[error("the table has the axes {table}, but the sweep has {sweep}; classify it again")]
    OtherAxes {
        /// Axes of the sweep.
        sweep: String,
        /// Axes of the table.
        table: String,
    },
    /// A row of the table is damaged.
    #[error("run {id}: its row does not hold one finite value per axis; classify it again")]
    BadRow {
        /// Identity of the run.
        id: String,
    },
    /// Several records are given for a figure that is drawn of one.
    #[error("the figure `{0}` is of one record: give them one by one")]
    OfOneRecord(&'static str),
    /// The record of a run does not hold what its tracks are drawn from.
    #[error(
        "the record holds no trajectory; add `trajectory = true` to [output] of the scene and run \
         it again"
    )]
    NoTrajectory,
    /// The record of a run does not hold its ledger.
    #[error(
        "the record holds no ledger of energy; add `ledger = true` to [output] of the scene and \
         run it again"
    )]
    NoLedger,
    /// The drawing failed.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
    /// The PNG could not be made of the SVG.
    #[error("cannot make the PNG: {0}")]
    Png(String),
}

impl Refusal for PlotError {
    fn is_refusal(&self) -> bool {
        matches!(
            self,
            Self::UnknownFigure { .. }
                | Self::OtherFamily { .. }
                | Self::NeedsAxis { .. }
                | Self::NoPoints(_)
                | Self::NoTimes(_)
                | Self::NoData(_)
                | Self::OfOneRecord(_)
                | Self::NotRefined
                | Self::Select(_)
                | Self::OpenAxis { .. }
                | Self::NoRun { .. }
                | Self::Scene { .. }
        )
    }
}

impl From<style::Failed> for PlotError {
    fn from(error: style::Failed) -> Self {
        Self::Drawing(error.to_string())
    }
}
