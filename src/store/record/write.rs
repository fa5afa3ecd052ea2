//! From a record to the bytes of an HDF5 file.

use super::part::{DatasetAxis, RecordPart, StoredQuantity, common_axis, short_text};
use super::scales::{DimensionScales, Linked};
use super::{FORMAT, FORMAT_VERSION, MOST_IN_TEXT, cf};
use crate::observe::{Observations, Snapshot};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::{Scene, StartSphere};
use hdf5_pure::{AttrValue, Error, FileBuilder};
use ndarray::Array2;
use std::io::Write;

/// Why a scene has no text that gives it back.
const NOT_FINITE: &str = "its scene holds a number that is not finite; check the scene file";

/// The HDF5 file of a record, still to be written, as it may be most of what fits into memory.
pub(super) struct Content {
    file: FileBuilder,
    scales: DimensionScales,
}

impl Content {
    /// Writes the file.
    pub(super) fn write_to(self, file: &mut impl Write) -> Result<(), Error> {
        let mut linked = Linked::new(file, self.scales);
        self.file.finish_to(&mut linked)?;
        linked.finish().map_err(Error::Io)
    }
}

/// What the HDF5 file of a record holds, with the program and its processor time if they are
/// wanted.
pub(super) fn build(
    record: &RunRecord,
    provenance: Option<(&Program, f64)>,
) -> Result<Content, String> {
    check_observations(&record.observations)?;
    let mut file = FileBuilder::new();
    if let Some((program, cpu_seconds)) = provenance {
        file.set_attr("program_version", text(&program.version));
        file.set_attr("program_commit", text(&program.commit));
        file.set_attr("cpu_seconds", AttrValue::F64(cpu_seconds));
    }
    let long_start = long_start(&record.scene);
    header(&mut file, record, long_start.as_ref().map(|(rest, _)| rest))?;
    let mut scales = DimensionScales::default();
    RecordPart::add(&mut file, "spheres", &mut scales, |part| {
        spheres(part, record);
        Ok(())
    })?;
    if let Some((_, spheres)) = long_start {
        RecordPart::add(&mut file, "start", &mut scales, |part| start(part, spheres))?;
    }
    RecordPart::add(&mut file, "observations", &mut scales, |part| {
        observations(part, &record.observations, record.scene.unit_of_time());
        Ok(())
    })?;
    for (name, states) in [
        ("snapshots", &record.snapshots),
        ("trajectory", &record.trajectory),
    ] {
        if !states.is_empty() {
            RecordPart::add(&mut file, name, &mut scales, |part| {
                snapshots(part, states).map_err(|reason| format!("{name}: {reason}"))
            })?;
        }
    }
    common_axes(&mut file, record, &mut scales);
    Ok(Content { file, scales })
}

fn text(value: &str) -> AttrValue {
    AttrValue::VarLenString(value.to_owned())
}

/// The scene without the spheres that its start lists, and these, if they are too many for a text.
fn long_start(scene: &Scene) -> Option<(Scene, &[StartSphere])> {
    let apart = scene.apart_from_list();
    apart.filter(|(_, spheres)| spheres.len() > MOST_IN_TEXT)
}

/// The attributes; `rest` is the scene without its start's spheres, if these are too many for a
/// text.
fn header(file: &mut FileBuilder, record: &RunRecord, rest: Option<&Scene>) -> Result<(), String> {
    let scene = &record.scene;
    let in_text = rest.unwrap_or(scene);
    let json = serde_json::to_string(in_text).map_err(|error| error.to_string())?;
    if Scene::from_json(&json).ok().as_ref() != Some(in_text) {
        return Err(NOT_FINITE.to_owned());
    }
    file.set_attr("format", text(FORMAT));
    file.set_attr("Conventions", short_text(cf::CONVENTIONS));
    if let Some(title) = &scene.title {
        file.set_attr("title", short_text(title));
    }
    file.set_attr("format_version", AttrValue::U64(FORMAT_VERSION));
    file.set_attr("identity", text(&scene.identity()));
    file.set_attr("seed", AttrValue::U64(scene.seed));
    file.set_attr("units", text(scene.units().description()));
    file.set_attr("work", AttrValue::U64(record.work));
    file.set_attr("scene", text(&json));
    // For people only, so it may be missing: it is no file to run without the spheres, and TOML has
    // no whole numbers beyond 64 signed bits.
    if rest.is_none()
        && let Ok(toml) = toml::to_string(scene)
    {
        file.set_attr("scene_toml", text(&toml));
    }
    if !record.milestones.is_empty() {
        let json = serde_json::to_string(&record.milestones).map_err(|error| error.to_string())?;
        file.set_attr("milestones", text(&json));
    }
    match &record.outcome {
        Outcome::Completed => file.set_attr("outcome", text("completed")),
        Outcome::Unstable(instability) => {
            file.set_attr("outcome", text("unstable"));
            file.set_attr("guard", text(instability.guard.name()));
            file.set_attr("guard_step", AttrValue::U64(instability.step));
            file.set_attr("guard_time", AttrValue::F64(instability.time));
            file.set_attr("guard_sphere", AttrValue::U64(instability.sphere as u64));
            file.set_attr("guard_detail", text(&instability.detail));
        }
    }
    Ok(())
}

fn start(part: &mut RecordPart<'_>, spheres: &[StartSphere]) -> Result<(), String> {
    let finite = |sphere: &StartSphere| {
        let vectors = [sphere.position, sphere.velocity, sphere.spin];
        let mut numbers = vectors.as_flattened().iter().chain(&sphere.radius);
        numbers.all(|number| number.is_finite())
    };
    if !spheres.iter().all(finite) {
        return Err(NOT_FINITE.to_owned());
    }
    type Vector = fn(&StartSphere) -> &[f64; 3];
    let parts: [(StoredQuantity<'_>, Vector); 3] = [
        (POSITION, |it| &it.position),
        (VELOCITY, |it| &it.velocity),
        (SPIN, |it| &it.spin),
    ];
    for (quantity, vector) in parts {
        let values: Vec<f64> = spheres.iter().flat_map(vector).copied().collect();
        let axes = [
            (DatasetAxis::Sphere, spheres.len()),
            (DatasetAxis::Component, 3),
        ];
        part.dataset(quantity, &axes, &values);
    }
    let radius = |it: &StartSphere| it.radius.unwrap_or(f64::NAN);
    let values: Vec<f64> = spheres.iter().map(radius).collect();
    let description = "Radius of every sphere; not a number for the scene's radius";
    let quantity = StoredQuantity("radius", "m", description);
    part.dataset(quantity, &[(DatasetAxis::Sphere, spheres.len())], &values);
    Ok(())
}

const POSITION: StoredQuantity<'_> = StoredQuantity("position", "m", "Centres x, y, z");
const VELOCITY: StoredQuantity<'_> = StoredQuantity("velocity", "m/s", "Velocities x, y, z");
const SPIN: StoredQuantity<'_> = StoredQuantity("spin", "rad/s", "Spins x, y, z");

fn spheres(part: &mut RecordPart<'_>, record: &RunRecord) {
    let axes = [(DatasetAxis::Sphere, record.radius.len())];
    let quantity = StoredQuantity("radius", "m", "Radius of every sphere");
    part.dataset(quantity, &axes, &record.radius);
    let axes = [(DatasetAxis::Sphere, record.mass.len())];
    let quantity = StoredQuantity("mass", "kg", "Mass of every sphere");
    part.dataset(quantity, &axes, &record.mass);
}

fn observations(part: &mut RecordPart<'_>, observations: &Observations, unit_of_time: &str) {
    let frames = (DatasetAxis::Time, observations.frames());
    for series in observations.scalars() {
        let quantity = StoredQuantity(series.name, series.unit, series.description);
        part.dataset(quantity, &[frames], series.values);
    }
    let quantity = StoredQuantity(
        "profile",
        "m",
        "Height of the highest centre in each radial bin, inner bin first; \
         not a number for an empty bin. Shape: frames x bins",
    );
    let profile = observations.profile.as_standard_layout();
    let values = profile.as_slice().expect("standard layout");
    let bins = (DatasetAxis::BinRadius, profile.ncols());
    part.dataset(quantity, &[frames, bins], values);
    let quantity = StoredQuantity(
        "rising",
        "1",
        "Number of spheres within a radius fraction that rose faster than the mean by a speed. \
         Shape: frames x rise_radii x rise_speeds of the scene's output table",
    );
    let rising = observations.rising.as_standard_layout();
    let values = rising.as_slice().expect("standard layout");
    let (_, radii, speeds) = rising.dim();
    let axes = [
        frames,
        (DatasetAxis::RiseRadius, radii),
        (DatasetAxis::RiseSpeed, speeds),
    ];
    part.dataset(quantity, &axes, values);
    part.time(unit_of_time, "Time of each frame", &observations.time);
}

fn check_observations(observations: &Observations) -> Result<(), String> {
    let frames = observations.frames();
    let scalars = observations.scalars();
    let lengths = scalars
        .iter()
        .map(|series| (series.name, series.values.len()))
        .chain([
            ("profile", observations.profile.nrows()),
            ("rising", observations.rising.shape()[0]),
        ]);
    for (name, length) in lengths {
        if length != frames {
            return Err(format!(
                "`{name}` has {length} frames, but `time` has {frames}"
            ));
        }
    }
    Ok(())
}

fn snapshots(part: &mut RecordPart<'_>, snapshots: &[Snapshot]) -> Result<(), String> {
    type Vectors = fn(&Snapshot) -> &Array2<f64>;
    let parts: [(StoredQuantity<'_>, Vectors); 3] = [
        (POSITION, |at| &at.position),
        (VELOCITY, |at| &at.velocity),
        (SPIN, |at| &at.spin),
    ];
    let count = snapshots[0].position.nrows();
    let spins = snapshots[0].spin.nrows();
    for (quantity, vectors) in parts {
        let rows = if quantity.0 == "spin" { spins } else { count };
        if let Some(odd) = snapshots.iter().find(|at| vectors(at).dim() != (rows, 3)) {
            let name = quantity.0;
            return Err(format!(
                "`{name}` at t = {} s has shape {:?}, but ({rows}, 3) is expected",
                odd.time,
                vectors(odd).dim()
            ));
        }
        if quantity.0 == "spin" && spins == 0 {
            continue;
        }
        let values: Vec<f64> = snapshots.iter().flat_map(vectors).copied().collect();
        let states = (DatasetAxis::Time, snapshots.len());
        let axes = [
            states,
            (DatasetAxis::Sphere, rows),
            (DatasetAxis::Component, 3),
        ];
        part.dataset(quantity, &axes, &values);
    }
    let time: Vec<f64> = snapshots.iter().map(|snapshot| snapshot.time).collect();
    part.time("s", "Time of each snapshot", &time);
    Ok(())
}

/// The axes that groups share.
fn common_axes(file: &mut FileBuilder, record: &RunRecord, scales: &mut DimensionScales) {
    let output = &record.scene.output;
    let radius = record.scene.tank.as_ref().and_then(|tank| tank.radius);
    let bins = record.observations.profile.ncols();
    let centre = |bin: usize, radius: f64| (bin as f64 + 0.5) * radius / bins as f64;
    for axis in DatasetAxis::COMMON {
        let values = match axis {
            DatasetAxis::BinRadius => {
                radius.map(|it| (0..bins).map(|bin| centre(bin, it)).collect())
            }
            DatasetAxis::RiseRadius => Some(output.rise_radii.clone()),
            DatasetAxis::RiseSpeed => Some(output.rise_speeds.clone()),
            DatasetAxis::Time | DatasetAxis::Sphere | DatasetAxis::Component => None,
        };
        common_axis(file, axis, values, scales);
    }
}
