//! Whether the spheres start within the bounds of the guards.

use crate::document::{Problem, at_least, number};
use crate::scene::{Scene, Start, Tank};

/// How far from the axis, along x or y, and from z = 0 a centre may start (m), and the key that
/// says so.
struct StartReach {
    path: String,
    aside: f64,
    height: f64,
}

impl StartReach {
    fn of(path: String, [x, y, z]: [f64; 3], spread: f64) -> Self {
        Self {
            path,
            aside: (x.abs() + spread).max(y.abs()),
            height: z.abs(),
        }
    }
}

impl Scene {
    /// Refuses starts beyond `guards.horizontal` or `guards.vertical`: the first step would end the
    /// run. The defaults of these keys lie beyond every start. Driven spheres may be anywhere.
    pub(super) fn check_bounds(&self, problems: &mut Vec<Problem>) {
        let guards = &self.dem.guards;
        let bounds = [
            ("guards.horizontal", guards.horizontal),
            ("guards.vertical", guards.vertical),
        ];
        if self.spot.is_some() || bounds.iter().all(|(_, bound)| bound.is_none()) {
            return;
        }
        let reaches = self.reaches_of_start();
        for (axis, (key, bound)) in bounds.into_iter().enumerate() {
            let Some(bound) = bound else { continue };
            let reach = |it: &StartReach| [it.aside, it.height][axis];
            let farthest = reaches.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)));
            let Some(farthest) = farthest.filter(|it| reach(it) > bound) else {
                continue;
            };
            let message = format!(
                "spheres start up to {} m away, beyond `{key}` = {} m, which ends the run",
                number(reach(farthest)),
                number(bound)
            );
            let least = at_least(reach(farthest));
            let help = format!("use `{key} = {least}` or more, or start nearer");
            problems.push(Problem::new(&farthest.path, message).help(help));
        }
    }

    fn reaches_of_start(&self) -> Vec<StartReach> {
        let tank = self.tank.clone().unwrap_or_default();
        let inside = |tank: &Tank| {
            let room = |side: Option<f64>| side.map_or(0.0, |side| side - self.smallest_radius());
            tank.reach().map(room)
        };
        let [x, y] = inside(&tank);
        match &self.start {
            Start::List { .. } => {
                let reach = self.free_listed().map(|(index, sphere)| {
                    let path = format!("start.spheres[{index}].position");
                    StartReach::of(path, sphere.position, 0.0)
                });
                reach.collect()
            }
            Start::Feed {
                position, spread, ..
            } => vec![StartReach::of(
                "start.position".to_owned(),
                *position,
                *spread,
            )],
            Start::Random { z_min, z_max, .. } => vec![
                StartReach::of("start.z_min".to_owned(), [x, y, *z_min], 0.0),
                StartReach::of("start.z_max".to_owned(), [x, y, *z_max], 0.0),
            ],
            Start::Packing {} => {
                let floor = tank.floor.unwrap_or(0.0);
                let top = floor + self.packed_height();
                let height = if top.abs() > floor.abs() { top } else { floor };
                vec![StartReach::of("start.kind".to_owned(), [x, y, height], 0.0)]
            }
            Start::File { .. } => Vec::new(),
        }
    }
}
