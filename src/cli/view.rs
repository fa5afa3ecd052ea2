//! `phase view`: pictures of a run, without any other program.

mod target;

use super::console::Console;
use super::exit::{Exit, Failure};
use super::{folders, format};
use phase::observe::Snapshot;
use phase::record::{Outcome, RunRecord, States};
use phase::render::{Animation, ColorBy, Image, Sheet, Stage};
use phase::scene::Radii;
use phase::store;
use phase::sweep::work;
use std::path::PathBuf;
use target::{Kind, Target};

/// Draw the spheres of a run: side view and view from above.
///
/// Takes the trajectory if the record has one, else its snapshots, and says which times it shows.
#[derive(clap::Args)]
#[command(after_help = "\
Example: the run at five times, then at two of one's own
  phase view spout.h5
  phase view spout.h5 --time 1.5,5 --out late.png

Example: an animation in real time; APNG (.png) keeps smaller files, GIF is shown by every program
  phase run --from results/quick --point radius=0.003,omega=6 --snapshot-interval 0.05 --out spout.h5
  phase view spout.h5 --animate spout.gif")]
pub(crate) struct Arguments {
    /// The record (HDF5).
    record: PathBuf,
    /// Frames to show, counted from 0 at the start.
    #[arg(long, value_name = "N", value_delimiter = ',', conflicts_with = "time")]
    frame: Vec<u64>,
    /// Times to show (s); the nearest state is taken.
    #[arg(
        long,
        value_name = "T",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    time: Vec<f64>,
    /// The picture to write (PNG) [default: the record's name with .png].
    #[arg(short, long, value_name = "PNG", conflicts_with = "animate")]
    out: Option<PathBuf>,
    /// Write an animation of the whole run: .png (APNG) or .gif.
    #[arg(short, long, value_name = "FILE", conflicts_with_all = ["frame", "time"])]
    animate: Option<PathBuf>,
    /// What the colours stand for.
    #[arg(long, value_name = "WHAT", default_value = "speed")]
    color: Color,
    /// Width of a panel (pixels).
    #[arg(long, value_name = "PIXELS", default_value_t = 320,
          value_parser = clap::value_parser!(u32).range(40..=4000))]
    width: u32,
    /// Print the files written as one JSON object (docs/json.md) instead of text.
    #[arg(long)]
    pub(super) json: bool,
}

/// What the colours of the spheres stand for.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Color {
    /// Speed, from rest to the highest that is shown.
    Speed,
    /// Height, from the lowest to the highest that is shown.
    Height,
    /// The sphere: neighbours in the list differ.
    Index,
    /// Nothing.
    None,
}

/// Panels if no times are asked for.
const PANELS: usize = 5;
/// Most pictures of an animation.
const PICTURES: usize = 100;
/// Largest size of an animation (bytes).
const LARGEST: usize = 5_000_000;
/// Share of an animation after which it must show all spheres: before, they may still be falling in.
const ARRIVAL: f64 = 0.25;
/// Largest height of a picture (pixels).
const HEIGHT: usize = 4000;
/// Greatest height of the view from the side, over its width.
const TALLEST: f64 = 8.0;
/// Largest height of an animation (pixels).
const ANIMATION_HEIGHT: usize = 720;

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let target = Target::new(arguments)?;
    let record = store::read_record(&arguments.record).map_err(Failure::refused)?;
    target.check(&arguments.record)?;
    let states = drawable(&record);
    if states.is_empty() {
        return Err(Failure::failed(format_args!(
            "{}: the record holds no state to draw",
            arguments.record.display()
        )));
    }
    console.note(format_args!(
        "{}: {}: {}",
        arguments.record.display(),
        record.states(),
        format::count(states.len(), "state")
    ));
    let bytes = if arguments.animate.is_some() {
        animate(
            &record,
            &evenly(states, PICTURES),
            target.kind,
            arguments,
            console,
        )?
    } else {
        let shown = chosen(&record, states, arguments)?;
        let times: Vec<String> = shown.iter().map(|at| brief(&record, at.time)).collect();
        console.note(format_args!("shows t = {} s", times.join(", ")));
        let mut view = View::new(&record, &shown, arguments);
        view.limit_height(console);
        let asked = arguments.width as usize;
        let width = view.fitted(shown.len(), asked, HEIGHT);
        if width < asked {
            console.note(format_args!(
                "panels are {width} instead of {asked} pixels wide: a picture is at most {HEIGHT} \
                 pixels high"
            ));
        }
        let image = view.sheet.picture(&view.panels(&shown, width)?);
        image.to_png(&texts(&record)).map_err(Failure::failed)?
    };
    let path = target.path;
    folders::make_for(&path)?;
    store::write_atomic(&path, &bytes).map_err(Failure::failed)?;
    console.file(&path)?;
    console.answer_files()?;
    Ok(Exit::Done)
}

/// The states of a record without the one that broke a guard, whose numbers mean nothing.
fn drawable(record: &RunRecord) -> &[Snapshot] {
    let states = record.states().all();
    match &record.outcome {
        Outcome::Unstable(broken) => {
            let sound = states.iter().take_while(|state| state.time < broken.time);
            &states[..sound.count()]
        }
        Outcome::Completed => states,
    }
}

/// The states that the command line asks for, in order of time.
fn chosen<'a>(
    record: &RunRecord,
    states: &'a [Snapshot],
    arguments: &Arguments,
) -> Result<Vec<&'a Snapshot>, Failure> {
    let interval = record.scene.time.frame_interval;
    let frames = arguments.frame.iter().map(|&frame| frame as f64 * interval);
    let mut times: Vec<f64> = frames.chain(arguments.time.iter().copied()).collect();
    if times.is_empty() {
        return Ok(evenly(states, PANELS));
    }
    let (first, last) = (states[0].time, states[states.len() - 1].time);
    for time in &times {
        let inside = *time >= first - 0.5 * interval && *time <= last + 0.5 * interval;
        if !inside {
            return Err(Failure::refused(format_args!(
                "there is no state at t = {time} s: the record holds them from {} to {} s \
                 ({} frames of {interval} s)",
                brief(record, first),
                brief(record, last),
                record.observations.frames()
            )));
        }
    }
    times.sort_by(f64::total_cmp);
    let distance = |state: &Snapshot, time: f64| (state.time - time).abs();
    let nearest = |time: &f64| {
        let order =
            |a: &&Snapshot, b: &&Snapshot| distance(a, *time).total_cmp(&distance(b, *time));
        states.iter().min_by(order)
    };
    let mut shown: Vec<&Snapshot> = times.iter().filter_map(nearest).collect();
    shown.dedup_by_key(|state| state.time.to_bits());
    Ok(shown)
}

/// At most so many states, as evenly spaced as can be, the first and the last among them.
fn evenly(states: &[Snapshot], most: usize) -> Vec<&Snapshot> {
    let count = states.len().min(most);
    if count < 2 {
        return states.iter().take(count).collect();
    }
    let at = |index: usize| &states[index * (states.len() - 1) / (count - 1)];
    (0..count).map(at).collect()
}

/// A time as text, with as many digits as the frames ask for.
fn seconds(record: &RunRecord, time: f64) -> String {
    let interval = record.scene.time.frame_interval;
    let tenfold = std::iter::successors(Some(interval), |scaled| Some(10.0 * scaled));
    let digits = tenfold.take(6).position(|scaled| scaled >= 1.0 - 1e-9);
    format!("{time:.*}", digits.unwrap_or(6))
}

/// The same without zeros at its end.
fn brief(record: &RunRecord, time: f64) -> String {
    let text = seconds(record, time);
    text.parse()
        .map_or(text, |rounded: f64| rounded.to_string())
}

/// What all pictures of a run have in common.
struct View<'a> {
    record: &'a RunRecord,
    sheet: Sheet,
}

impl<'a> View<'a> {
    fn new(record: &'a RunRecord, shown: &[&Snapshot], arguments: &Arguments) -> Self {
        let all = || shown.iter().copied();
        let sheet = Sheet {
            title: title(record),
            radius: record.radius.clone(),
            stage: Stage::of_scene(&record.scene).around(all(), &record.radius),
            color: match arguments.color {
                Color::Speed => ColorBy::speed_of(all()),
                Color::Height => ColorBy::height_of(all()),
                Color::Index => ColorBy::Index,
                Color::None => ColorBy::Nothing,
            },
        };
        Self { record, sheet }
    }

    /// Leaves out the upper part of a tall tank, and says so.
    fn limit_height(&mut self, console: &Console) {
        let limited = self.sheet.stage.no_taller(TALLEST);
        let (top, limit) = (self.sheet.stage.seen[1][2], limited.seen[1][2]);
        if limit < top {
            console.note(format_args!(
                "shows up to z = {limit:.3} m; spheres above are not drawn"
            ));
        }
        self.sheet.stage = limited;
    }

    /// The largest width of panels, not above `width`, with which a picture is at most `most` pixels
    /// high.
    fn fitted(&self, count: usize, width: usize, most: usize) -> usize {
        let mut fitted = width;
        while self.sheet.height(count, fitted) > most && fitted > 1 {
            let shrunk = fitted * most / self.sheet.height(count, fitted);
            fitted = shrunk.clamp(1, fitted - 1);
        }
        fitted
    }

    /// A panel of every state, drawn on all cores.
    fn panels(&self, shown: &[&Snapshot], width: usize) -> Result<Vec<Image>, Failure> {
        work::map(work::default_workers(), shown, |state| {
            let caption = format!("t = {} s", seconds(self.record, state.time));
            self.sheet.panel(state, width, &caption)
        })
        .map_err(Failure::failed)
    }

    /// A picture of every state.
    fn pictures(&self, shown: &[&Snapshot], width: usize) -> Result<Vec<Image>, Failure> {
        let panels = self.panels(shown, width)?;
        let pictures = panels.chunks(1).map(|panel| self.sheet.picture(panel));
        Ok(pictures.collect())
    }
}

/// Title of the scene, and what is known of the run's place in a sweep.
fn title(record: &RunRecord) -> Vec<String> {
    let scene = &record.scene;
    let mut place = vec![format!("n = {}", record.radius.len())];
    if let Radii::One(radius) = scene.spheres.radius {
        place.push(format!("r = {} mm", rounded(1e3 * radius)));
    }
    if let Some(swirl) = &scene.swirl {
        place.push(format!("Ω = {} rad/s", rounded(swirl.omega)));
    }
    place.push(format!("seed {}", scene.seed));
    let lines = scene.title.iter().cloned();
    lines.chain([place.join(", ")]).collect()
}

/// A number to four digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// The bytes of an animation, made smaller until it has a reasonable size.
fn animate(
    record: &RunRecord,
    shown: &[&Snapshot],
    kind: Kind,
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<u8>, Failure> {
    if let (States::Snapshots(_), true) = (record.states(), shown.len() < PICTURES / 2) {
        console.note(
            "few states make a jerky animation: store more of them with `phase run \
             --snapshot-interval 0.05`",
        );
    }
    let mut view = View::new(record, shown, arguments);
    let arrived = &shown[(ARRIVAL * shown.len() as f64) as usize..];
    let later = View::new(record, arrived, arguments).sheet.stage.seen[1][2];
    if later < view.sheet.stage.seen[1][2] {
        console.note(format_args!(
            "shows up to z = {later:.3} m, where all spheres are after the first quarter"
        ));
        view.sheet.stage = view.sheet.stage.up_to(later);
    }
    view.limit_height(console);
    // In real time, but neither faster than the eye nor a slide show.
    let duration = shown[shown.len() - 1].time - shown[0].time;
    let delay = (100.0 * duration / shown.len() as f64)
        .round()
        .clamp(4.0, 50.0) as u16;
    let asked = arguments.width as usize;
    let mut width = view.fitted(1, asked, ANIMATION_HEIGHT);
    let pictures = format::count(shown.len(), "picture");
    loop {
        console.note(format_args!("draws {pictures} of {width} pixels' width"));
        let animation = Animation::new(&view.pictures(shown, width)?, delay);
        let bytes = match kind {
            Kind::Gif => animation.to_gif().map_err(Failure::failed)?,
            Kind::Png => animation.to_apng(&texts(record)).map_err(Failure::failed)?,
        };
        let size = format::bytes(bytes.len() as f64);
        if bytes.len() <= LARGEST || width < 80 {
            if width < asked {
                console.note(format_args!(
                    "{width} instead of {asked} pixels wide: an animation is at most \
                     {ANIMATION_HEIGHT} pixels high and {} large",
                    format::bytes(LARGEST as f64)
                ));
            }
            console.note(format_args!("{pictures} of {width} pixels' width, {size}"));
            return Ok(bytes);
        }
        console.note(format_args!(
            "{size} are too much: draws them again, smaller"
        ));
        // The size goes with the area.
        let shrink = (LARGEST as f64 / bytes.len() as f64).sqrt().min(0.95);
        width = (0.97 * shrink * width as f64) as usize;
    }
}

/// What the metadata of a picture says.
fn texts(record: &RunRecord) -> Vec<(&'static str, String)> {
    vec![
        ("Title", record.scene.title.clone().unwrap_or_default()),
        ("Software", format!("phase {}", record.program.version)),
        ("Commit", record.program.commit.clone()),
        ("Run", record.scene.identity()),
        ("Seed", record.scene.seed.to_string()),
    ]
}
