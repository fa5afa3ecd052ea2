//! Animations, and a picture of every state.

use super::moment::evenly;
use super::sheets::{Run, Sheets, on_all_cores};
use super::target::Kind;
use super::{Arguments, HEIGHT, words};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::{folders, format};
use phase::record::{RunRecord, States};
use phase::render::Animation;
use phase::store;
use std::path::Path;

/// Most pictures of an animation.
const PICTURES: usize = 100;
/// Largest size of an animation (bytes).
const LARGEST: usize = 5_000_000;
/// Share of an animation after which it must show all spheres: before, they may still be falling
/// in.
const ARRIVAL: f64 = 0.25;
/// Largest height of an animation (pixels).
const ANIMATION_HEIGHT: usize = 720;
/// How many files are in memory at once.
const AT_ONCE: usize = 32;

/// The bytes of an animation, made smaller until it has a reasonable size.
pub(super) fn animate(
    record: &RunRecord,
    kind: Kind,
    arguments: &Arguments,
    console: &Console,
) -> Result<Vec<u8>, Failure> {
    let shown = evenly(record.sound_states(), PICTURES);
    if let (States::Snapshots(_), true) = (record.states(), shown.len() < PICTURES / 2) {
        console.note(
            "few states make a jerky animation: store more states with `phase run \
             --snapshot-interval 0.05`",
        );
    }
    let runs = [Run {
        record,
        shown: shown.clone(),
        origin: 0.0,
        label: arguments.labels.first().cloned(),
        differs: Vec::new(),
    }];
    let mut sheets = Sheets::new(&runs, arguments)?;
    if !sheets.are_flat() {
        leave_out_arrivals(&mut sheets, &runs[0], arguments, console)?;
    }
    sheets.limit_height(console);
    // In real time, but neither faster than the eye nor a slide show.
    let duration = shown[shown.len() - 1].time - shown[0].time;
    let delay = (100.0 * duration / shown.len() as f64)
        .round()
        .clamp(4.0, 50.0) as u16;
    let asked = arguments.width as usize;
    let mut width = sheets.fitted(1, asked, ANIMATION_HEIGHT);
    let pictures = format::count(shown.len(), "picture");
    loop {
        console.note(format_args!("drawing {pictures}, {width} pixels wide"));
        let drawn = on_all_cores(&shown, |state| sheets.picture_of(state, width))?;
        let animation = Animation::new(&drawn, delay);
        let bytes = match kind {
            Kind::Gif => animation.to_gif()?,
            Kind::Png => {
                let texts = words::texts(record);
                animation.to_apng(&texts)?
            }
        };
        let size = format::bytes(bytes.len() as f64);
        if bytes.len() <= LARGEST || width < 80 {
            if width < asked {
                console.note(format_args!(
                    "panels are {width} pixels wide instead of {asked}: an animation is at most \
                     {ANIMATION_HEIGHT} pixels high and {} large",
                    format::bytes(LARGEST as f64)
                ));
            }
            console.note(format_args!("{pictures}, {width} pixels wide, {size}"));
            return Ok(bytes);
        }
        console.note(format_args!("{size} is too large; drawing again, smaller"));
        // The size goes with the area.
        let shrink = (LARGEST as f64 / bytes.len() as f64).sqrt().min(0.95);
        width = (0.97 * shrink * width as f64) as usize;
    }
}

/// Shows no more height than the spheres need once they have fallen into the tank.
fn leave_out_arrivals(
    sheets: &mut Sheets<'_>,
    run: &Run<'_>,
    arguments: &Arguments,
    console: &Console,
) -> Result<(), Failure> {
    let first = (ARRIVAL * run.shown.len() as f64) as usize;
    let arrived = [Run {
        record: run.record,
        shown: run.shown[first..].to_vec(),
        label: None,
        differs: Vec::new(),
        ..*run
    }];
    let later = Sheets::new(&arrived, arguments)?.top();
    if later < sheets.top() {
        console.note(format_args!(
            "shows up to z = {later:.3} m, which holds all spheres after the first quarter"
        ));
        sheets.show_up_to(later);
    }
    Ok(())
}

/// Writes a picture of every state of a run into a folder, `frame_00000.png` and so on.
pub(super) fn each(
    runs: &[Run<'_>],
    folder: &Path,
    arguments: &Arguments,
    console: &Console,
) -> Result<(), Failure> {
    let Run { record, shown, .. } = &runs[0];
    folders::refuse_other_frames(folder, shown.len(), "png")?;
    let texts = words::texts(record);
    let mut sheets = Sheets::new(runs, arguments)?;
    sheets.limit_height(console);
    let width = sheets.fitted(1, arguments.width as usize, HEIGHT);
    folders::make(folder)?;
    for (chunk, states) in shown.chunks(AT_ONCE).enumerate() {
        let files = on_all_cores(states, |state| {
            sheets.picture_of(state, width).to_png(&texts)
        })?;
        for (index, file) in (AT_ONCE * chunk..).zip(files) {
            let bytes = file?;
            let path = folder.join(store::frame_name(index, "png"));
            store::write_atomic(&path, &bytes)?;
        }
    }
    console.note(format_args!(
        "{}, {width} pixels wide",
        format::count(shown.len(), "picture")
    ));
    Ok(())
}
