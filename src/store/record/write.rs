//! From a record to the bytes of an HDF5 file.

use super::{FORMAT, FORMAT_VERSION, MOST_IN_TEXT};
use crate::observe::{Observations, Snapshot};
use crate::record::{Outcome, Program, RunRecord};
use crate::scene::{Scene, StartSphere};
use hdf5_pure::{AttrValue, FileBuilder, GroupBuilder, H5Element};
use ndarray::Array2;

/// Effort of the compression, 1 to 9. Most of what is measured is noise in its last digits: on a
/// record of 5001 frames (0.96 MB) level 1 saves a quarter in 6 ms, level 6 as much in 20 ms.
const DEFLATE_LEVEL: u32 = 1;
/// Datasets below this size (bytes) are stored as they are.
const COMPRESS_FROM: usize = 4096;
/// Largest chunk of a dataset (bytes): what a reader must unpack to see one frame, or a part of a
/// large one.
const CHUNK: usize = 1 << 20;
/// Why a scene has no text that gives it back.
const NOT_FINITE: &str = "its scene holds a number that is not finite; check the scene file";
/// Most entries of a chunk along an axis: HDF5 2.0 refuses the extents of larger ones as they are
/// written here, in four bytes where it would take three.
const WIDEST: usize = u16::MAX as usize;

/// What the HDF5 file of a record holds, with the program and its processor time if they are
/// wanted. It is still to be written, as it may be most of what fits into memory.
pub(super) fn build(
    record: &RunRecord,
    provenance: Option<(&Program, f64)>,
) -> Result<FileBuilder, String> {
    check_observations(&record.observations)?;
    let mut file = FileBuilder::new();
    if let Some((program, cpu_seconds)) = provenance {
        file.set_attr("program_version", text(&program.version));
        file.set_attr("program_commit", text(&program.commit));
        file.set_attr("cpu_seconds", AttrValue::F64(cpu_seconds));
    }
    let long_start = long_start(&record.scene);
    header(&mut file, record, long_start.as_ref().map(|(rest, _)| rest))?;
    if let Some((_, spheres)) = long_start {
        let mut group = file.create_group("start");
        start(&mut group, spheres)?;
        file.add_group(group.finish());
    }
    let mut group = file.create_group("spheres");
    spheres(&mut group, record);
    file.add_group(group.finish());
    let mut group = file.create_group("observations");
    let unit = record.scene.unit_of_time();
    observations(&mut group, &record.observations, unit);
    file.add_group(group.finish());
    for (name, states) in [
        ("snapshots", &record.snapshots),
        ("trajectory", &record.trajectory),
    ] {
        if !states.is_empty() {
            let mut group = file.create_group(name);
            snapshots(&mut group, states).map_err(|reason| format!("{name}: {reason}"))?;
            file.add_group(group.finish());
        }
    }
    Ok(file)
}

fn text(value: &str) -> AttrValue {
    AttrValue::VarLenString(value.to_owned())
}

/// A text of a fixed length. One of a variable length takes 4 kB of the file, which for two texts
/// of each dataset is more than the record of a short run holds.
fn short_text(value: &str) -> AttrValue {
    AttrValue::String(value.to_owned())
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

fn start(group: &mut GroupBuilder, spheres: &[StartSphere]) -> Result<(), String> {
    let finite = |sphere: &StartSphere| {
        let vectors = [sphere.position, sphere.velocity, sphere.spin];
        let mut numbers = vectors.as_flattened().iter().chain(&sphere.radius);
        numbers.all(|number| number.is_finite())
    };
    if !spheres.iter().all(finite) {
        return Err(NOT_FINITE.to_owned());
    }
    type Part = fn(&StartSphere) -> &[f64; 3];
    let parts: [(StoredQuantity<'_>, Part); 3] = [
        (POSITION, |it| &it.position),
        (VELOCITY, |it| &it.velocity),
        (SPIN, |it| &it.spin),
    ];
    for (quantity, part) in parts {
        let values: Vec<f64> = spheres.iter().flat_map(part).copied().collect();
        dataset(group, quantity, &[spheres.len(), 3], &values);
    }
    let radius = |it: &StartSphere| it.radius.unwrap_or(f64::NAN);
    let values: Vec<f64> = spheres.iter().map(radius).collect();
    let description = "Radius of every sphere; not a number for the scene's radius";
    let quantity = StoredQuantity("radius", "m", description);
    dataset(group, quantity, &[spheres.len()], &values);
    Ok(())
}

/// Name, unit and description of a dataset.
struct StoredQuantity<'a>(&'a str, &'a str, &'a str);

const POSITION: StoredQuantity<'_> = StoredQuantity("position", "m", "Centres x, y, z");
const VELOCITY: StoredQuantity<'_> = StoredQuantity("velocity", "m/s", "Velocities x, y, z");
const SPIN: StoredQuantity<'_> = StoredQuantity("spin", "rad/s", "Spins x, y, z");

fn dataset<T: H5Element>(
    group: &mut GroupBuilder,
    StoredQuantity(name, unit, description): StoredQuantity<'_>,
    shape: &[usize],
    values: &[T],
) {
    let shape: Vec<u64> = shape.iter().map(|&extent| extent as u64).collect();
    let dataset = group.create_dataset(name);
    dataset
        .with_data(values)
        .with_shape(&shape)
        .set_attr("unit", short_text(unit))
        .set_attr("description", short_text(description));
    let size = size_of_val(values);
    if size >= COMPRESS_FROM {
        dataset
            .with_chunks(&chunk(&shape, size_of::<T>()))
            .with_shuffle()
            .with_deflate(DEFLATE_LEVEL);
    }
}

/// Extents of the chunks of a dataset with entries of that size (bytes): whole rows as far as they
/// fit.
fn chunk(shape: &[u64], size: usize) -> Vec<u64> {
    let mut chunk = shape.to_vec();
    let mut room = CHUNK / size;
    for extent in chunk.iter_mut().rev() {
        let entries = (*extent as usize).min(WIDEST).min(room).max(1);
        room /= entries;
        *extent = entries as u64;
    }
    chunk
}

fn spheres(group: &mut GroupBuilder, record: &RunRecord) {
    let count = [record.radius.len()];
    let quantity = StoredQuantity("radius", "m", "Radius of every sphere");
    dataset(group, quantity, &count, &record.radius);
    let count = [record.mass.len()];
    let quantity = StoredQuantity("mass", "kg", "Mass of every sphere");
    dataset(group, quantity, &count, &record.mass);
}

fn observations(group: &mut GroupBuilder, observations: &Observations, unit_of_time: &str) {
    let frames = [observations.frames()];
    let quantity = StoredQuantity("time", unit_of_time, "Time of each frame");
    dataset(group, quantity, &frames, &observations.time);
    for series in observations.scalars() {
        let quantity = StoredQuantity(series.name, series.unit, series.description);
        dataset(group, quantity, &frames, series.values);
    }
    let quantity = StoredQuantity(
        "profile",
        "m",
        "Height of the highest centre in each radial bin, inner bin first; \
         not a number for an empty bin. Shape: frames x bins",
    );
    let profile = observations.profile.as_standard_layout();
    let values = profile.as_slice().expect("standard layout");
    dataset(group, quantity, profile.shape(), values);
    let quantity = StoredQuantity(
        "rising",
        "1",
        "Number of spheres within a radius fraction that rose faster than the mean by a speed. \
         Shape: frames x rise_radii x rise_speeds of the scene's output table",
    );
    let rising = observations.rising.as_standard_layout();
    let values = rising.as_slice().expect("standard layout");
    dataset(group, quantity, rising.shape(), values);
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

fn snapshots(group: &mut GroupBuilder, snapshots: &[Snapshot]) -> Result<(), String> {
    let time: Vec<f64> = snapshots.iter().map(|snapshot| snapshot.time).collect();
    let quantity = StoredQuantity("time", "s", "Time of each snapshot");
    dataset(group, quantity, &[snapshots.len()], &time);

    type Part = fn(&Snapshot) -> &Array2<f64>;
    let parts: [(StoredQuantity<'_>, Part); 3] = [
        (POSITION, |at| &at.position),
        (VELOCITY, |at| &at.velocity),
        (SPIN, |at| &at.spin),
    ];
    let count = snapshots[0].position.nrows();
    let spins = snapshots[0].spin.nrows();
    for (quantity, part) in parts {
        let rows = if quantity.0 == "spin" { spins } else { count };
        if let Some(odd) = snapshots.iter().find(|at| part(at).dim() != (rows, 3)) {
            let name = quantity.0;
            return Err(format!(
                "`{name}` at t = {} s has shape {:?}, but ({rows}, 3) is expected",
                odd.time,
                part(odd).dim()
            ));
        }
        if quantity.0 == "spin" && spins == 0 {
            continue;
        }
        let values: Vec<f64> = snapshots.iter().flat_map(part).copied().collect();
        dataset(group, quantity, &[snapshots.len(), rows, 3], &values);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_chunk_is_some_frames_or_a_part_of_one() {
        assert_eq!(chunk(&[5001, 256, 3], 8), [170, 256, 3]);
        assert_eq!(chunk(&[2, 40_000, 3], 8), [1, 40_000, 3]);
        assert_eq!(chunk(&[2, 1_000_000, 3], 8), [1, 43_690, 3]);
        assert_eq!(chunk(&[1_000_000], 8), [65_535]);
    }

    proptest! {
        #[test]
        fn chunks_are_neither_too_large_nor_too_wide(
            shape in prop::collection::vec(1_u64..3_000_000, 1..4),
        ) {
            let chunk = chunk(&shape, 8);
            prop_assert!(chunk.iter().product::<u64>() * 8 <= CHUNK as u64);
            for (extent, all) in chunk.iter().zip(&shape) {
                prop_assert!((1..=WIDEST as u64).contains(extent) && extent <= all);
            }
        }
    }
}
