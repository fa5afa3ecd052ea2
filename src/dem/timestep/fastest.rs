//! The fastest speeds that a scene lets expect.

use super::fall::{Fall, Open};
use crate::scene::{Driven, Scene, Start, StartSphere, Tank};

/// The fastest speeds (m/s) that a scene lets expect.
pub(in crate::dem) struct Fastest {
    /// Of two partners relative to each other, where they meet.
    pub(in crate::dem) impact: f64,
    /// Of a sphere, wherever it is: on its way to the outlet too.
    pub(super) motion: f64,
    /// Where nothing bounds these speeds; they then follow from what is known.
    pub(super) open: Option<Open>,
}

impl Fastest {
    pub(in crate::dem) fn of(scene: &Scene) -> Self {
        let start = start_speed(scene);
        let (reach, open_outward) = reach(scene);
        let effects = &scene.dem.effects;
        let of_effects = effects.fastest(reach);
        let mut fall = Fall::of(scene);
        if fall.open.is_some()
            && let Some(terminal) = terminal_speed(scene)
        {
            // Relative to the air, which moves itself.
            let speed = terminal + of_effects;
            fall = Fall {
                impact: speed,
                motion: speed,
                open: None,
            };
        }
        // A sphere from the feed starts to fall with its own speed.
        let fallen = |speed: f64| match scene.start {
            Start::Feed { .. } => libm::hypot(speed, start),
            _ => speed,
        };
        let of_paths = scene.dem.driven.iter().map(Driven::fastest);
        let of_walls = scene.dem.walls.iter().map(|wall| wall.fastest(reach));
        let of_effects = of_paths.chain(of_walls).fold(of_effects, f64::max);
        let impact = start.max(fallen(fall.impact)).max(of_effects);
        let motion = impact.max(fallen(fall.motion));
        let shaken = effects.fastest_change_by_shaking();
        Self {
            impact: impact + shaken,
            motion: motion + shaken,
            open: fall.open.or(open_outward),
        }
    }
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// A bound on the speeds of the spheres at the start and on their differences (m/s).
fn start_speed(scene: &Scene) -> f64 {
    match &scene.start {
        // Two spheres may meet with opposite velocities.
        Start::Random { speed, .. } => 2.0 * 3.0_f64.sqrt() * speed,
        Start::List { .. } => {
            let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
            let mut fastest = None;
            for (_, StartSphere { velocity, .. }) in scene.free_listed() {
                fastest = Some(norm(*velocity).max(fastest.unwrap_or(0.0)));
                for axis in 0..3 {
                    low[axis] = low[axis].min(velocity[axis]);
                    high[axis] = high[axis].max(velocity[axis]);
                }
            }
            let spread = || norm([0, 1, 2].map(|axis| high[axis] - low[axis]));
            fastest.map_or(0.0, |fastest| fastest.max(spread()))
        }
        Start::Feed { velocity, .. } => norm(*velocity),
        Start::Packing {} | Start::File { .. } => 0.0,
    }
}

/// The largest distance of a sphere from the axis (m); and whether a swirl drives spheres farther
/// out, where there are no walls all around.
fn reach(scene: &Scene) -> (f64, Option<Open>) {
    let aside = |place: [f64; 3]| norm([place[0], place[1], 0.0]);
    let widest = match &scene.start {
        Start::List { spheres } => spheres
            .iter()
            .map(|it| aside(it.position))
            .fold(0.0, f64::max),
        Start::Feed { position, .. } => aside(*position),
        Start::Random { .. } | Start::Packing {} | Start::File { .. } => 0.0,
    };
    let wall = scene.tank.as_ref().and_then(farthest_wall);
    let fixed = scene.dem.geometry.as_ref().map(|geometry| {
        let fixed = geometry.spheres();
        let fixed = fixed.walls.iter().chain(&fixed.door);
        fixed.map(|it| aside(it.position)).fold(widest, f64::max)
    });
    let effects = &scene.dem.effects;
    let turns = effects.swirl.as_ref().is_some_and(|it| it.omega != 0.0);
    // Spheres no heavier than their fluid are pressed to the axis.
    let buoyancy = effects.buoyancy.as_ref();
    let is_heavy = buoyancy.is_none_or(|it| it.density < scene.spheres.density);
    let is_held = (wall.is_some() || fixed.is_some()) && scene.dem.contact.is_some();
    let open = (turns && is_heavy && !is_held).then_some(Open::Outward);
    (wall.or(fixed).unwrap_or(widest), open)
}

/// The largest distance of a sphere from the axis (m), if there are walls all around it.
fn farthest_wall(tank: &Tank) -> Option<f64> {
    let [x, y] = tank.reach();
    tank.radius
        .or(x.zip(y).map(|(x, y)| (x * x + y * y).sqrt()))
}

/// The terminal speed (m/s) of the largest sphere through the air, if there is drag.
fn terminal_speed(scene: &Scene) -> Option<f64> {
    let (_, radius) = scene.radius_range();
    let alone = scene.spheres.count == 1;
    let density = scene.spheres.density;
    (scene.dem.effects).terminal_speed(radius, scene.largest_mass(), density, alone)
}
