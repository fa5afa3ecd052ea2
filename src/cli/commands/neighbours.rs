//! `phase neighbours`: what each way to find neighbours costs in a scene.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use crate::cli::folders;
use crate::cli::folders::ANOTHER_FOLDER;
use phase::cost::neighbours::{Cost, Moment, StudyError};
use phase::plot::step_time::{self, Against, StepTimes};
use phase::record::Program;
use phase::scene::{Neighbours, Scene, Start};
use phase::store;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Measure the time of a step with each way to find neighbours: against the number of spheres, and
/// against the side of the cells.
///
/// All searches give the same motion, bit for bit, which is checked. Each is measured where the
/// spheres are a second after the last one came in, in turn with the others.
#[derive(clap::Args)]
#[command(after_help = "\
Example: all pairs against cells of 0.25 m in the silo
  phase neighbours sweeps/scenes/silo.toml --length 0.25 --out results/neighbours")]
pub(crate) struct Arguments {
    /// The scene file (TOML).
    scene: PathBuf,
    /// Numbers of spheres [default: one to eight eighths of the scene's].
    #[arg(long, value_name = "N", value_delimiter = ',')]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    count: Vec<u32>,
    /// Side of the cells that are compared with the other searches (m) [default: that of the scene,
    /// or else the least that is valid].
    #[arg(long, value_name = "METRES")]
    length: Option<f64>,
    /// Folder for the tables (CSV) and figures (SVG, PNG) [default: print only].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Sides of the cells that are measured, over the least that is valid.
const LENGTHS: [f64; 9] = [1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0, 14.0];

/// What was measured once.
#[derive(Clone, Copy, Serialize)]
struct Row {
    search: &'static str,
    /// Side of a cell (m).
    length: Option<f64>,
    /// Spheres that move, and those that do not.
    spheres: usize,
    fixed: usize,
    /// Processor time of a step (s).
    step_time: f64,
    /// How many times faster than all pairs in the same state.
    speed_up: f64,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let scene = Scene::load(&arguments.scene).map_err(Failure::refused)?;
    refuse_without_search(&scene, &arguments.scene)?;
    let length = side(&scene, arguments.length)?;
    let mut counts: Vec<usize> = arguments
        .count
        .iter()
        .map(|count| *count as usize)
        .collect();
    if counts.is_empty() {
        counts.extend((1..=8).map(|part| (part * scene.spheres.count / 8).max(1)));
    }
    counts.sort_unstable();
    counts.dedup();
    if let Some(folder) = &arguments.out {
        folders::make(folder)?;
    }
    // All of them before anything is measured: a number that does not fit loses no measurement.
    let mut moments = Vec::new();
    for &count in &counts {
        console.note(format_args!(
            "{count} spheres: runs the scene until they are in"
        ));
        let moment = Moment::of_scene(&scene, count).map_err(|error| match error {
            StudyError::Problem { .. } => {
                Failure::refused(format_args!("{}: {error}", arguments.scene.display()))
            }
            error => Failure::failed(error),
        });
        moments.push(moment?);
    }
    if let Some(folder) = &arguments.out {
        let figures = ["count", "length"].map(|against| format!("step-time-{against}"));
        let tables = figures.clone().map(|name| PathBuf::from(name + ".csv"));
        let names = folders::files_of_figures(figures).chain(tables);
        folders::refuse_foreign(folder, names, ANOTHER_FOLDER)?;
    }
    let mut study = Study::default();
    console.result(format_args!(
        "{:<22} {:>8} {:>14} {:>9}",
        "search", "spheres", "time of a step", "speed-up"
    ));
    for (k, moment) in moments.iter().enumerate() {
        let searches = [
            Neighbours::AllPairs,
            Neighbours::Cells { length },
            Neighbours::HashedCells { length },
            Neighbours::VerletList,
        ];
        let rows = study.measure(moment, &searches, None, console)?;
        if k + 1 == moments.len() {
            let least = scene.least_cell_length();
            let searches = LENGTHS.map(|ratio| Neighbours::Cells {
                length: ratio * least,
            });
            let all_pairs = rows.first().map(|row| row.step_time);
            study.lengths = study.measure(moment, &searches, all_pairs, console)?;
        }
        study.counts.extend(rows);
    }
    if let Some(folder) = &arguments.out {
        study.write(folder, &scene, console)?;
    }
    console.result(match study.same_bits {
        true => "all searches gave the same bits",
        false => "the searches did NOT give the same bits",
    });
    console.answer(&study);
    Ok(if study.same_bits {
        Exit::Done
    } else {
        Exit::Failed
    })
}

/// Refuses scenes in which nothing is searched, or not yet.
fn refuse_without_search(scene: &Scene, path: &Path) -> Result<(), Failure> {
    let reason = if scene.spot.is_some() {
        "spots search no contacts: give a scene of discrete elements"
    } else if matches!(scene.start, Start::Packing {}) {
        "a packing is made for all of its spheres: start from places, such as `kind = \"random\"` \
         or `kind = \"file\"`"
    } else {
        return Ok(());
    };
    Err(Failure::refused(format_args!(
        "{}: {reason}",
        path.display()
    )))
}

/// The side of the cells (m).
fn side(scene: &Scene, asked: Option<f64>) -> Result<f64, Failure> {
    let least = scene.least_cell_length();
    let length = asked.or(scene.dem.neighbours.length()).unwrap_or(least);
    if length.is_finite() && length >= least {
        return Ok(length);
    }
    Err(Failure::refused(format_args!(
        "--length {length}: cells must be at least {least} m wide, the largest distance of two \
         centres that touch, for only neighbouring cells are searched"
    )))
}

/// Everything that was measured.
#[derive(Serialize)]
struct Study {
    /// Whether all searches gave the same bits.
    same_bits: bool,
    /// All searches, for every number of spheres.
    counts: Vec<Row>,
    /// Cells of several sides, for the largest number of spheres.
    lengths: Vec<Row>,
}

impl Default for Study {
    fn default() -> Self {
        Self {
            same_bits: true,
            counts: Vec::new(),
            lengths: Vec::new(),
        }
    }
}

impl Study {
    /// Measures searches at one moment and prints them, compared with `all_pairs` (s) or, without
    /// that, with the first of them.
    fn measure(
        &mut self,
        moment: &Moment,
        searches: &[Neighbours],
        all_pairs: Option<f64>,
        console: &Console,
    ) -> Result<Vec<Row>, Failure> {
        let (costs, same_bits) = moment.measure(searches).map_err(Failure::failed)?;
        self.same_bits &= same_bits;
        let all_pairs = all_pairs.unwrap_or(costs[0].step_time);
        let rows = costs.iter().map(|cost| Row::new(cost, moment, all_pairs));
        let rows: Vec<Row> = rows.collect();
        for row in &rows {
            console.result(format_args!(
                "{:<22} {:>8} {:>11.1} us {:>9.2}",
                row.name(),
                row.spheres,
                1e6 * row.step_time,
                row.speed_up
            ));
        }
        Ok(rows)
    }

    fn write(&self, folder: &Path, scene: &Scene, console: &Console) -> Result<(), Failure> {
        for (name, rows, against) in [
            ("count", &self.counts, Against::Count),
            ("length", &self.lengths, Against::Length),
        ] {
            let place = |end: &str| folder.join(format!("step-time-{name}.{end}"));
            store::write_rows(rows, &place("csv")).map_err(Failure::failed)?;
            console.file(&place("csv"));
            let lines = match against {
                Against::Count => by_search(rows),
                Against::Length => vec![self.by_length()],
            };
            let figure = step_time::draw(&lines, against, scene, &Program::current());
            figures::write(&figure.map_err(Failure::failed)?, place, console)?;
        }
        Ok(())
    }

    /// The time of a step against the side of a cell.
    fn by_length(&self) -> StepTimes {
        let spheres = self.lengths.first().map_or(0, |row| row.spheres);
        let points = self.lengths.iter();
        StepTimes {
            name: format!("cells, {spheres} spheres"),
            points: points
                .filter_map(|row| Some((row.length?, row.step_time)))
                .collect(),
        }
    }
}

impl Row {
    fn new(cost: &Cost, moment: &Moment, all_pairs: f64) -> Self {
        Self {
            search: cost.neighbours.name(),
            length: cost.neighbours.length(),
            spheres: moment.spheres(),
            fixed: moment.fixed,
            step_time: cost.step_time,
            speed_up: all_pairs / cost.step_time,
        }
    }

    fn name(&self) -> String {
        let name = match self.search {
            "verlet-list" => "Verlet list".to_owned(),
            search => search.replace('-', " "),
        };
        match self.length {
            Some(length) => format!("{name}, {} m", (1e4 * length).round() / 1e4),
            None => name,
        }
    }
}

/// The time of a step against the number of spheres, one line for each search.
fn by_search(rows: &[Row]) -> Vec<StepTimes> {
    let mut lines: Vec<StepTimes> = Vec::new();
    for row in rows {
        let (name, point) = (row.name(), (row.spheres as f64, row.step_time));
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.points.push(point),
            None => lines.push(StepTimes {
                name,
                points: vec![point],
            }),
        }
    }
    lines
}
