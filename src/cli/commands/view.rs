//! `phase view`: pictures of a run, without any other program.

mod animate;
mod moment;
mod sheets;
mod target;
mod words;

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::runs::{self, check_labels};
use crate::cli::values;
use crate::cli::{folders, format};
use moment::{Moment, evenly};
use phase::compare::opened;
use phase::record::RunRecord;
use phase::render::lacking_letters;
use phase::scene::Tank;
use phase::store;
use serde::Serialize;
use sheets::{Run, Sheets};
use std::path::{Path, PathBuf};
use target::Target;

/// Draw the spheres of a run from the side and from above; discs in one flat view.
///
/// Uses the trajectory if the record has one, otherwise its snapshots, and says which times it
/// shows. Several records are drawn side by side, to one scale.
#[derive(clap::Args)]
#[command(after_help = "\
Example: the run at the default times, then at two chosen times
  phase view spout.h5
  phase view spout.h5 --time 1.5,5 --out late.png

Example: two silos at rest side by side
  phase view silo.h5 silo-mixture.h5 --time at-rest --color radius --out silos.png

Example: layers of a drainage in a cut through the middle, and what is near the orifice
  phase view drainage.h5 --time 60 --color layer --cut --out layers.png
  phase view dem.h5 spots.h5 --time 0,60 --since-opening --color layer --cut --out pair.png
  phase view drainage.h5 --time 60 --color packing-fraction --cut --window -15,15,0,40

Example: two runs of one scene, with names of their own
  phase view a.h5 b.h5 --label \"no bias\" --label \"a bias of 3\" --out pair.png

Example: an animation in real time; APNG (.png) files are smaller, every program shows GIF
  phase run --from results/quick --point radius=0.003,omega=6 --snapshot-interval 0.05 \\
    --out spout.h5
  phase view spout.h5 --animate spout.gif

Example: a PNG of every state, for a program that makes films
  phase view spout.h5 --each frames")]
pub(crate) struct Arguments {
    /// The record (HDF5); or several.
    #[arg(required = true, value_name = "RECORD")]
    records: Vec<PathBuf>,
    /// Caption of a record instead of its title and place in a sweep; once for each record, in
    /// their order.
    #[arg(long = "label", value_name = "TEXT")]
    labels: Vec<String>,
    /// Frames to show, counted from 0 at the start.
    #[arg(long, value_name = "N", value_delimiter = ',', conflicts_with = "time")]
    frame: Vec<u64>,
    /// Times to show (s): the nearest state of each. For a silo also `filled`, `at-rest`,
    /// `door-opened`, `emptied` or `steady`: the first state from then on.
    #[arg(
        long,
        value_name = "T",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    time: Vec<Moment>,
    /// Count times, in the picture too, from the opening of a silo or box (of its door, if it has
    /// one).
    #[arg(long, conflicts_with_all = ["frame", "animate"])]
    since_opening: bool,
    /// The picture to write (PNG) [default: the record's name with .png].
    #[arg(short, long, value_name = "PNG", conflicts_with_all = ["animate", "each"])]
    out: Option<PathBuf>,
    /// Write an animation of the whole run: .png (APNG) or .gif.
    #[arg(short, long, value_name = "FILE", conflicts_with_all = ["frame", "time", "each"])]
    animate: Option<PathBuf>,
    /// Write a picture of every state (or of the chosen ones) to this folder: frame_00000.png and
    /// so on.
    #[arg(long, value_name = "FOLDER")]
    each: Option<PathBuf>,
    /// What the colours show.
    #[arg(long, value_name = "WHAT", default_value = "speed")]
    color: Color,
    /// Show a cut through the middle, from the side: only spheres behind the axis.
    #[arg(long)]
    cut: bool,
    /// The region to show, from the side (m): least and largest x, least and largest z.
    #[arg(long, value_name = "X,X,Z,Z", value_delimiter = ',', num_args = 1,
          allow_hyphen_values = true, value_parser = values::number)]
    window: Vec<f64>,
    /// Width of a panel (pixels).
    #[arg(long, value_name = "PIXELS", default_value_t = 320,
          value_parser = clap::value_parser!(u32).range(40..=4000))]
    width: u32,
    /// Write the picture in 256 colours: a smaller file. Animations always are.
    #[arg(long, conflicts_with_all = ["animate", "each"])]
    palette: bool,
}

/// What the colours of the spheres show.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Color {
    /// Speed, from rest to the highest that is shown.
    Speed,
    /// Height, from the lowest to the highest that is shown.
    Height,
    /// Radius, from the least to the largest.
    Radius,
    /// The index of the sphere: neighbours in the list differ.
    Index,
    /// The layer in which a sphere started (ten diameters each), in two alternating colours.
    Layer,
    /// Packing fraction, of Voronoi cells.
    PackingFraction,
    /// Nothing; grains of a silo are blue.
    None,
}

/// The `--json` result, apart from the picture's file.
#[derive(Serialize)]
struct Answer {}

/// Panels if no times are requested.
const PANELS: usize = 5;
/// Largest height of a picture (pixels).
const HEIGHT: usize = 4000;

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let one_by_one = arguments.animate.is_some() || arguments.each.is_some();
    if one_by_one && arguments.records.len() > 1 {
        return Err(Failure::refused(
            "--animate and --each take a single record",
        ));
    }
    check_labels(&arguments.labels, arguments.records.len(), false)?;
    match &arguments.each {
        Some(folder) => {
            let records = read(arguments)?;
            animate::each(
                &runs(&records, arguments, console)?,
                folder,
                arguments,
                console,
            )?;
            console.file(folder);
        }
        None => {
            let target = Target::new(arguments)?;
            let records = read(arguments)?;
            target.check(&arguments.records)?;
            let runs = runs(&records, arguments, console)?;
            let bytes = match arguments.animate {
                Some(_) => animate::animate(&records[0], target.kind, arguments, console)?,
                None => strip(&runs, arguments, console)?,
            };
            folders::make_for(&target.path)?;
            store::write_atomic(&target.path, &bytes)?;
            console.file(&target.path);
        }
    }
    console.answer_with_files(&Answer {});
    Ok(Exit::Done)
}

fn read(arguments: &Arguments) -> Result<Vec<RunRecord>, Failure> {
    let records = arguments
        .records
        .iter()
        .map(|path| store::read_record(path).map(RunRecord::wrapped));
    let records: Vec<RunRecord> = records.collect::<Result<_, _>>()?;
    for (record, path) in records.iter().zip(&arguments.records) {
        runs::refuse_without_spheres(record, path)?;
    }
    Ok(records)
}

/// The states to show of every record.
fn runs<'a>(
    records: &'a [RunRecord],
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<Run<'a>>, Failure> {
    let numbered = records.iter().enumerate();
    let runs = numbered.map(|(number, record)| run(number, record, arguments, console));
    let mut runs: Vec<Run<'_>> = runs.collect::<Result<_, _>>()?;
    let differences = words::differences(&records.iter().collect::<Vec<_>>());
    for (run, differs) in runs.iter_mut().zip(differences) {
        run.differs = differs;
    }
    warn_of_letters(&runs, console);
    Ok(runs)
}

/// Says which letters of titles and labels the font lacks.
fn warn_of_letters(runs: &[Run<'_>], console: &Console) {
    for (run, name) in runs
        .iter()
        .flat_map(|run| run.names().into_iter().map(move |it| (run, it)))
    {
        let letters = lacking_letters(&name).into_iter();
        let letters: Vec<String> = letters.map(|letter| format!("`{letter}`")).collect();
        if !letters.is_empty() {
            let key = if run.label.is_some() {
                "--label"
            } else {
                "the key `title`"
            };
            console.warning(format_args!(
                "{key}, \"{name}\", has letters that the built-in font lacks ({}); the picture \
                 shows boxes instead",
                letters.join(", ")
            ));
        }
    }
}

/// Which states of a record, the one of that number, the command line asks for.
fn run<'a>(
    number: usize,
    record: &'a RunRecord,
    arguments: &Arguments,
    console: &Console,
) -> Result<Run<'a>, Failure> {
    let path = &arguments.records[number];
    let states = record.sound_states();
    if states.is_empty() {
        return Err(Failure::failed(
            "the record holds no state to draw; run it again with --snapshot-interval",
        )
        .at(path));
    }
    console.note(format_args!(
        "{}: {}: {}",
        path.display(),
        record.states(),
        format::count(states.len(), "state")
    ));
    let interval = record.scene.time.frame_interval;
    let frames = arguments.frame.iter();
    let frames = frames.map(|&frame| Moment::Time(frame as f64 * interval));
    let origin = origin(path, record, arguments)?;
    let moments: Vec<Moment> = frames.chain(arguments.time.iter().copied()).collect();
    let shown = match (moments.is_empty(), arguments.each.is_some()) {
        (true, true) => states.iter().collect(),
        (true, false) => evenly(states, PANELS),
        (false, _) => moment::at(&moments, record, states, origin)?,
    };
    if arguments.animate.is_none() && arguments.each.is_none() {
        let times = shown
            .iter()
            .map(|at| moment::brief(record, at.time - origin));
        let times: Vec<String> = times.collect();
        let unit = record.scene.units().of_time();
        console.note(format_args!("shows t = {} {unit}", times.join(", ")));
    }
    Ok(Run {
        record,
        shown,
        origin,
        label: arguments.labels.get(number).cloned(),
        differs: Vec::new(),
    })
}

/// Time of the run (s) from which times count.
fn origin(path: &Path, record: &RunRecord, arguments: &Arguments) -> Result<f64, Failure> {
    if !arguments.since_opening {
        return Ok(0.0);
    }
    let tank = record.scene.tank.as_ref();
    let has_opening = record.scene.dem.outlet.is_some() || tank.is_some_and(Tank::has_opening);
    opened(record).filter(|_| has_opening).ok_or_else(|| {
        Failure::refused(
            "--since-opening is for silos and boxes with an opening that opens within the run",
        )
        .at(path)
    })
}

/// The bytes of a picture of all panels side by side.
fn strip(runs: &[Run<'_>], arguments: &Arguments, console: &Console) -> Result<Vec<u8>, Failure> {
    let mut sheets = Sheets::new(runs, arguments)?;
    sheets.limit_height(console);
    let count = runs.iter().map(|run| run.shown.len()).sum();
    let asked = arguments.width as usize;
    let width = sheets.fitted(count, asked, HEIGHT);
    if width < asked {
        console.note(format_args!(
            "panels are {width} pixels wide instead of {asked}: a picture is at most {HEIGHT} \
             pixels high"
        ));
    }
    let image = sheets.picture(&sheets.panels(width)?);
    let texts = words::texts(runs[0].record);
    Ok(match arguments.palette {
        true => image.to_png_of_palette(&texts),
        false => image.to_png(&texts),
    }?)
}
