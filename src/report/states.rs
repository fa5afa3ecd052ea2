//! Animations of spheres on a page.

use super::codes::{Codes, ends, rounded};
use super::document::{RadiiEntry, StatesEntry, WallsEntry};
use crate::record::RunRecord;
use crate::render::flat::edges;
use crate::scene::{Geometry, Scene, Shape};

/// Distance of fixed spheres over the sum of their radii up to which they make one wall.
const GAP: f64 = 3.0;

/// The spheres of a run at its snapshots; none without any.
pub(super) fn states(run: usize, record: &RunRecord) -> Option<StatesEntry> {
    let domain = record.scene.domain();
    let snapshots = record.sound_states().iter();
    let snapshots: Vec<_> = snapshots.map(|it| it.wrapped(domain)).collect();
    let spheres = record.radius.len();
    if snapshots.is_empty() || spheres == 0 {
        return None;
    }
    let along = |axis: usize| -> Vec<f64> {
        let positions = snapshots
            .iter()
            .flat_map(|it| it.position.column(axis).to_vec());
        positions.collect()
    };
    let ends = [0, 1, 2].map(|axis| ends(&along(axis)));
    let mut codes = Codes::new(2);
    for snapshot in &snapshots {
        for (axis, ends) in ends.iter().enumerate() {
            codes.add(&snapshot.position.column(axis).to_vec(), *ends);
        }
    }
    let radii: Vec<f64> = record.radius.iter().map(|it| rounded(*it)).collect();
    Some(StatesEntry {
        run,
        times: snapshots.iter().map(|it| rounded(it.time)).collect(),
        count: spheres,
        radii: match radii.iter().all(|radius| *radius == radii[0]) {
            true => RadiiEntry::One(radii[0]),
            false => RadiiEntry::Each(radii),
        },
        low: ends.map(|ends| ends[0]),
        high: ends.map(|ends| ends[1]),
        is_flat: record.scene.spheres.shape == Shape::Disc,
        walls: walls(&record.scene, ends[2][1]),
        data: codes.text(),
    })
}

/// The walls that a picture shows: a round tank, or lines in the plane of the picture.
fn walls(scene: &Scene, top: f64) -> Option<WallsEntry> {
    let mut segments = scene.dem.geometry.as_ref().map_or(Vec::new(), lines);
    if let Some(tank) = &scene.tank {
        if let (Some(radius), Some(floor)) = (tank.radius, tank.floor) {
            return Some(WallsEntry::Tank { radius, floor });
        }
        let [reach, _] = tank.reach();
        let floor = tank.floor;
        if let (Some(reach), Some(floor)) = (reach, floor) {
            segments.extend([-reach, reach].map(|side| [side, floor, side, top.max(floor)]));
            let half = tank.opening().map_or(0.0, |(_, half)| half);
            segments.extend([[-reach, floor, -half, floor], [half, floor, reach, floor]]);
        }
    }
    segments.extend(
        edges(scene)
            .into_iter()
            .map(|[[x, z], [end_x, end_z]]| [x, z, end_x, end_z].map(rounded)),
    );
    (!segments.is_empty()).then_some(WallsEntry::Segments { segments })
}

/// Lines through fixed spheres that follow one another closely.
fn lines(geometry: &Geometry) -> Vec<[f64; 4]> {
    let walls = geometry.spheres().walls;
    let pairs = walls.windows(2);
    let near = pairs.filter(|pair| {
        let [from, to] = [&pair[0], &pair[1]];
        let [x, z] = [0, 2].map(|axis| to.position[axis] - from.position[axis]);
        libm::hypot(x, z) <= GAP * (from.radius + to.radius)
    });
    near.map(|pair| {
        let [from, to] = [pair[0].position, pair[1].position];
        [from[0], from[2], to[0], to[2]].map(rounded)
    })
    .collect()
}
