//! One page that plays a whole run in a browser: no other file, no network.
//!
//! The page (`page.html`) holds the run as JSON and the script (`page.js`) that draws it. Positions
//! are rounded to a quantum far below what an eye sees, and written as bytes in base64; `bytes.rs`
//! says what the bytes mean.

mod bytes;

use super::svg::{released, time, window};
use crate::markup::escape;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::render::{Rgb, Scenery, flat};
use crate::scene::{FixedSphere, Shape};
use crate::store::{StoreError, write_atomic};
use base64::Engine as _;
use bytes::Writer;
use serde::Serialize;
use std::path::Path;

/// What a page begins with.
pub const PAGE_SIGNATURE: &[u8] = b"<!doctype html>\n<!-- phase: a run -->\n";

/// The quantum is at most this share of the least radius.
const FINENESS: f64 = 1.0 / 300.0;

/// What the script reads.
#[derive(Serialize)]
struct PageRun {
    title: String,
    /// What is seen: least x and z, largest x and z (m).
    window: [f64; 4],
    colors: Colors,
    walls: Vec<[f64; 3]>,
    door: Vec<[f64; 3]>,
    /// When the door opened (s).
    opened: Option<f64>,
    /// Walls of a tank, each from x, z to x, z (m).
    lines: Vec<[f64; 4]>,
    milestones: Vec<(&'static str, f64)>,
    /// Radius of every sphere (m).
    radius: Vec<f64>,
    /// Whether spheres come and go.
    flows: bool,
    /// Time of every state (s).
    times: Vec<f64>,
    /// Spheres that came in until each.
    released: Vec<usize>,
    /// Coordinates of a sphere: x and z, or x, z and y.
    axes: usize,
    /// What 1 stands for in the positions (m).
    quantum: f64,
    /// The positions, in base64.
    positions: String,
}

#[derive(Serialize)]
struct Colors {
    grain: String,
    wall: String,
    door: String,
}

/// Writes these states of a record as one page for a browser.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_page(record: &RunRecord, states: &[&Snapshot], path: &Path) -> Result<(), StoreError> {
    let run = describe(record, states);
    let json = serde_json::to_string(&run).map_err(|error| StoreError::Content {
        path: path.to_owned(),
        reason: error.to_string(),
    })?;
    let page = filled(
        include_str!("page.html"),
        &[
            ("title", &escape(&run.title)),
            // A `<` could end the script that holds it.
            ("run", &json.replace('<', "\\u003c")),
            ("script", include_str!("page.js")),
        ],
    );
    write_atomic(path, &[PAGE_SIGNATURE, page.as_bytes()].concat())
}

fn describe(record: &RunRecord, states: &[&Snapshot]) -> PageRun {
    let scene = &record.scene;
    let scenery = Scenery::new(scene, &record.milestones);
    let window = window(record, &scenery, states);
    let least = record.radius.iter().copied().fold(f64::INFINITY, f64::min);
    let quantum = quantum(FINENESS * least);
    // Discs stay in the plane y = 0.
    let axes: &[usize] = match scene.spheres.shape {
        Shape::Disc => &[0, 2],
        Shape::Sphere => &[0, 2, 1],
    };
    let mut writer = Writer::new(record.radius.len(), axes, quantum);
    for state in states {
        writer.add(&state.position);
    }
    let count = |state: &&Snapshot| released(record, state.time).unwrap_or(record.radius.len());
    let circles = |spheres: &[FixedSphere]| {
        let circle = |it: &FixedSphere| [it.position[0], it.position[2], it.radius];
        spheres.iter().map(circle).collect()
    };
    let color = |color: Rgb| flat::hex(color);
    PageRun {
        title: scene.title.clone().unwrap_or_else(|| "A run".to_owned()),
        window: joined(&window),
        colors: Colors {
            grain: color(flat::GRAIN),
            wall: color(flat::WALL),
            door: color(flat::DOOR),
        },
        walls: circles(scenery.walls()),
        door: circles(scenery.door()),
        opened: scenery.opened(),
        lines: scenery.lines(&window).iter().map(joined).collect(),
        milestones: record
            .milestones
            .iter()
            .map(|it| (it.kind.name(), time(it.time)))
            .collect(),
        radius: record.radius.clone(),
        flows: scene.has_flow(),
        times: states.iter().map(|state| time(state.time)).collect(),
        released: states.iter().map(count).collect(),
        axes: axes.len(),
        quantum,
        positions: base64::engine::general_purpose::STANDARD.encode(writer.bytes()),
    }
}

fn joined([[x, z], [end, top]]: &flat::Window) -> [f64; 4] {
    [*x, *z, *end, *top]
}

/// The largest power of ten that is not above a length.
fn quantum(length: f64) -> f64 {
    let power = libm::floor(libm::log10(length));
    // The decimal that JSON shows, and nothing beside it.
    format!("1e{power}").parse().unwrap_or(length)
}

/// A text with `{{name}}` replaced. Replacements are not searched for names.
fn filled(template: &str, values: &[(&str, &str)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some((before, (name, after))) = rest
        .split_once("{{")
        .and_then(|(before, after)| Some((before, after.split_once("}}")?)))
    {
        let value = values.iter().find(|(key, _)| *key == name);
        text += before;
        text += value.map_or("", |(_, value)| value);
        rest = after;
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantum_is_a_power_of_ten() {
        assert_eq!(quantum(FINENESS * 0.03), 1e-4);
        assert_eq!(quantum(FINENESS * 0.002), 1e-6);
        assert_eq!(quantum(5.0), 1.0);
    }

    #[test]
    fn what_is_filled_in_stays_as_it_is() {
        let values = [("a", "{{b}}"), ("b", "2")];
        assert_eq!(filled("<{{a}} {{b}}>", &values), "<{{b}} 2>");
    }
}
