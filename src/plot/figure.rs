//! The table of figures: what each is called, and what it is drawn from.

use super::choice::DefaultRuns;
use super::runs::Runs;
use super::{PlotError, Source, StudyResult, Svg};
use super::{ablation, accuracy, beverloo, critical_rotation, drainage, energies, ledger, map};
use super::{measures, net_force, phase, refined, speeds, stability, states, tracks, verification};
use crate::classify::Family;
use crate::record::{Program, RunRecord};
use crate::scene::Output;
use std::sync::LazyLock;

/// A figure.
pub struct Figure {
    /// Name, as on the command line and in file names.
    pub name: &'static str,
    /// What it shows, in one line.
    pub description: String,
    /// The families of scenes that it is for; empty if it is for all.
    pub families: Vec<&'static Family>,
    /// The usual columns of records that it shows.
    pub columns: &'static [&'static str],
    /// What it is drawn from, and how.
    pub(super) draw: Draw,
}

type DrawSweep = Box<dyn Fn(&Source<'_>) -> Result<Svg, PlotError> + Send + Sync>;

type DrawRuns = Box<dyn Fn(&Runs<'_>) -> Result<Svg, PlotError> + Send + Sync>;

/// What a figure is drawn from, and how.
pub(super) enum Draw {
    /// From the labels of a sweep.
    Sweep(DrawSweep),
    /// From single runs beside each other: of a sweep, or records.
    Runs {
        /// The runs of a sweep that are shown if none are asked for.
        default: &'static DefaultRuns,
        /// Whether it can show or measure the states of a stretch of time alone.
        takes_times: bool,
        /// Whether it shows curves of other sources with the runs.
        takes_data: bool,
        draw: DrawRuns,
    },
    /// From one record.
    Record(fn(&RunRecord) -> Result<Svg, PlotError>),
    /// From what a study found; `None` if it is of another study.
    Study(DrawStudy),
}

type DrawStudy = fn(StudyResult<'_>, &Program) -> Option<Result<Svg, PlotError>>;

static FIGURES: LazyLock<Vec<Figure>> = LazyLock::new(|| {
    let mut figures = vec![
        phase::figure(),
        refined::figure(),
        states::figure(),
        speeds::figure(),
        energies::over_the_grid(),
        energies::of_every_state(),
        critical_rotation::figure(),
        net_force::figure(),
        beverloo::figure(),
        measures::figure(),
    ];
    figures.extend(drainage::figures());
    figures.extend(map::MAPS.iter().map(map::figure));
    figures.extend([tracks::figure(), ledger::figure(), verification::figure()]);
    figures.extend([stability::figure(), ablation::figure()]);
    figures.extend(accuracy::figures());
    figures
});

/// All figures.
pub fn figures() -> &'static [Figure] {
    &FIGURES
}

impl Figure {
    fn new(name: &'static str, description: impl Into<String>, draw: Draw) -> Self {
        Self {
            name,
            description: description.into(),
            families: Vec::new(),
            columns: &[],
            draw,
        }
    }

    /// A figure of the labels of a sweep.
    pub(super) fn of_sweep(
        name: &'static str,
        description: impl Into<String>,
        draw: impl Fn(&Source<'_>) -> Result<Svg, PlotError> + Send + Sync + 'static,
    ) -> Self {
        Self::new(name, description, Draw::Sweep(Box::new(draw)))
    }

    /// A figure of single runs, which takes neither times nor data.
    pub(super) fn of_runs(
        name: &'static str,
        description: &str,
        default: &'static DefaultRuns,
        draw: impl Fn(&Runs<'_>) -> Result<Svg, PlotError> + Send + Sync + 'static,
    ) -> Self {
        let draw = Draw::Runs {
            default,
            takes_times: false,
            takes_data: false,
            draw: Box::new(draw),
        };
        Self::new(name, description, draw)
    }

    /// The same with times, and perhaps data.
    pub(super) fn with_options(mut self, data: bool) -> Self {
        if let Draw::Runs {
            takes_times,
            takes_data,
            ..
        } = &mut self.draw
        {
            (*takes_times, *takes_data) = (true, data);
        }
        self
    }

    /// A figure of one record.
    pub(super) fn of_record(
        name: &'static str,
        description: &str,
        draw: fn(&RunRecord) -> Result<Svg, PlotError>,
    ) -> Self {
        Self::new(name, description, Draw::Record(draw))
    }

    /// A figure of what a study found.
    pub(super) fn of_study(name: &'static str, description: &str, draw: DrawStudy) -> Self {
        Self::new(name, description, Draw::Study(draw))
    }

    /// The same for scenes of these families only.
    pub(super) fn for_families(self, families: impl IntoIterator<Item = &'static Family>) -> Self {
        let families = families.into_iter().collect();
        Self { families, ..self }
    }

    /// The same with the usual columns of records that it shows.
    pub(super) fn of_columns(self, columns: &'static [&'static str]) -> Self {
        Self { columns, ..self }
    }

    /// Which column that the figure shows is not recorded with this output.
    pub fn lacks(&self, output: &Output) -> Option<&'static str> {
        let mut columns = self.columns.iter();
        columns.find(|name| !output.records(name)).copied()
    }

    /// Refuses records of a scene without what the figure shows.
    pub(super) fn check_columns(&self, output: &Output) -> Result<(), PlotError> {
        match self.lacks(output) {
            None => Ok(()),
            Some(column) => Err(PlotError::nothing(format_args!(
                "the figure `{}` shows `{column}`, and the scene records only the columns that \
                 `output.usual` names; add it there and run the scene again",
                self.name
            ))),
        }
    }

    /// Whether the figure can be drawn of scenes of a family.
    pub fn applies_to(&self, family: &Family) -> bool {
        // What runs did can be shown whatever their labels are.
        let is_of_runs = matches!(self.draw, Draw::Runs { .. });
        let is_own = |own: &&Family| {
            *own == family || family.extends(own) || (is_of_runs && family.is_made_of(own))
        };
        self.families.is_empty() || self.families.iter().any(is_own)
    }

    /// Whether it is drawn from a sweep: from its labels, or from some of its runs.
    pub fn is_of_sweep(&self) -> bool {
        matches!(self.draw, Draw::Sweep(_) | Draw::Runs { .. })
    }

    /// Whether it is drawn from one record.
    pub fn is_of_one_record(&self) -> bool {
        matches!(self.draw, Draw::Record(_))
    }

    /// Which runs of a sweep it shows if no points are asked for; `None` for a figure that is not
    /// of single runs.
    pub fn default_runs(&self) -> Option<&'static str> {
        match &self.draw {
            Draw::Runs { default, .. } => Some(default.words),
            Draw::Sweep(_) | Draw::Record(_) | Draw::Study(_) => None,
        }
    }

    /// Refuses times or data that it does not look at.
    pub(super) fn check_options(&self, has_times: bool, has_data: bool) -> Result<(), PlotError> {
        let (takes_times, takes_data) = match self.draw {
            Draw::Runs {
                takes_times,
                takes_data,
                ..
            } => (takes_times, takes_data),
            Draw::Sweep(_) | Draw::Record(_) | Draw::Study(_) => (false, false),
        };
        let name = self.name;
        if has_times && !takes_times {
            return Err(PlotError::request(format_args!(
                "the figure `{name}` looks at whole runs, so it takes no times; only \
                 figures of drainages take them"
            )));
        }
        if has_data && !takes_data {
            return Err(PlotError::request(format_args!(
                "the figure `{name}` shows no data beside runs; figures of drainages with a line \
                 per run do, such as `outflow` and `cross-profile`"
            )));
        }
        Ok(())
    }
}
