//! SVG pictures, as browsers show them: one file per state, walls red, door green, grains blue.
//!
//! Lengths are in metres and to scale, the window is the same in all files. The y axis of SVG
//! points down: `cy` is -z.

use super::{frame_name, make_folder};
use crate::markup::escape;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::render::{Scenery, Stage, flat};
use crate::store::StoreError;
use crate::store::atomic::write_one_of_many;
use std::fmt::Write;
use std::path::Path;

/// Width of the white margin over the size of the scene.
const MARGIN: f64 = 0.02;
/// Larger side of a picture (pixels), before the reader makes it larger.
const SIDE: f64 = 960.0;

/// Writes these states of a record as pictures `frame_00000.svg` and so on into `folder`. Each is a
/// document of its own, with a `circle` per sphere, whose title says the time.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_svg(
    record: &RunRecord,
    states: &[&Snapshot],
    folder: &Path,
) -> Result<(), StoreError> {
    make_folder(folder)?;
    let scenery = Scenery::new(&record.scene, &record.milestones);
    let window = window(record, &scenery, states);
    for (frame, state) in states.iter().enumerate() {
        let path = folder.join(frame_name(frame, "svg"));
        let picture = document(record, &scenery, state, &window);
        write_one_of_many(&path, picture.as_bytes())?;
    }
    Ok(())
}

/// The rectangle that holds everything in all of these states, with a margin.
pub(super) fn window(record: &RunRecord, scenery: &Scenery, states: &[&Snapshot]) -> flat::Window {
    let stage = Stage::of_scene(&record.scene).around(states.iter().copied(), &record.radius);
    let [low, high] = flat::window(&scenery.on(stage));
    let size = [0, 1].map(|axis| high[axis] - low[axis]);
    let margin = match MARGIN * size[0].max(size[1]) {
        // A point has no size to fill a window with.
        margin if margin > 0.0 => margin,
        _ => 1.0,
    };
    [
        low.map(|value| value - margin),
        high.map(|value| value + margin),
    ]
}

/// How many spheres came in until a time, where they come and go.
pub(super) fn released(record: &RunRecord, time: f64) -> Option<usize> {
    let observations = &record.observations;
    let until = observations.time.partition_point(|it| *it <= time + 1e-9);
    let released = observations.released.get(until.checked_sub(1)?)?;
    Some(*released as usize)
}

fn document(
    record: &RunRecord,
    scenery: &Scenery,
    state: &Snapshot,
    window: &flat::Window,
) -> String {
    let [low, high] = window;
    let size = [0, 1].map(|axis| high[axis] - low[axis]);
    let digits = flat::digits(size[0].max(size[1]));
    let scale = SIDE / size[0].max(size[1]);
    let [width, height] = size.map(|length| (scale * length).round().max(1.0));
    let [left, top, across, up] =
        [low[0], -high[1], size[0], size[1]].map(|length| format!("{length:.digits$}"));
    let mut document = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    // Writing to memory cannot fail.
    let _ = writeln!(
        document,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"{left} {top} {across} {up}\" role=\"img\">\n\
         <title>{}</title>\n\
         <desc>{}</desc>\n\
         <rect x=\"{left}\" y=\"{top}\" width=\"{across}\" height=\"{up}\" fill=\"#fff\"/>",
        escape(&title(record, state)),
        escape(&description(record, scenery, state)),
    );
    document += &scenery.elements(state, &record.radius, None, window);
    document + "</svg>\n"
}

fn title(record: &RunRecord, state: &Snapshot) -> String {
    let time = format!("t = {} s", time(state.time));
    match &record.scene.title {
        Some(title) => format!("{title}, {time}"),
        None => time,
    }
}

/// A time (s), without what rounding leaves in its last digits.
pub(super) fn time(seconds: f64) -> f64 {
    (seconds * 1e9).round() / 1e9
}

fn description(record: &RunRecord, scenery: &Scenery, state: &Snapshot) -> String {
    let numbers = |row: &ndarray::ArrayView1<'_, f64>| row.iter().all(|value| value.is_finite());
    let rows = state.position.rows().into_iter();
    let inside = rows.filter(numbers).count();
    let mut parts = vec![match released(record, state.time) {
        Some(released) => format!(
            "{inside} grains are in, {} have left, {} are still to come",
            released.saturating_sub(inside),
            record.radius.len().saturating_sub(released)
        ),
        None => format!("{inside} spheres"),
    }];
    if !scenery.door().is_empty() {
        let is_open = scenery.door_at(state.time).is_empty();
        let door = if is_open { "open" } else { "closed" };
        parts.push(format!("the door is {door}"));
    }
    parts.push("lengths in metres, up is up".to_owned());
    parts.join("; ")
}
