//! Whether walls of fixed discs hold the spheres.

use phase::dem::{WallFailure, WeakestWall, timestep};
use phase::grid::{Axis, describe};
use phase::scene::FixedSphere;
use phase::sweep::Job;
use serde::Serialize;

/// The weakest wall of all jobs, and what hits it.
pub(super) struct Walls<'a> {
    wall: WeakestWall,
    /// Fastest impact expected in the scene (m/s).
    impact: f64,
    job: &'a Job,
}

/// The wall of all jobs that comes closest to being passed.
pub(super) fn weakest(jobs: &[Job]) -> Option<Walls<'_>> {
    let walls = jobs.iter().filter_map(|job| {
        let scene = job.scene();
        Some(Walls {
            wall: WeakestWall::of_scene(&scene)?,
            impact: timestep::fastest_impact(&scene),
            job,
        })
    });
    walls.min_by(|a, b| a.margin().total_cmp(&b.margin()))
}

impl Walls<'_> {
    /// Speed that the wall holds over the speed of the fastest impact.
    fn margin(&self) -> f64 {
        self.wall.speed / self.impact
    }

    pub(super) fn describe(&self, axes: &[Axis]) -> String {
        let WeakestWall {
            speed,
            radius,
            fixed: [one, other],
            failure,
        } = self.wall;
        let at = describe(axes, &self.job.values, self.job.seed);
        let mut text = format!(
            "hold spheres of radius {radius} m up to {speed:.3} m/s; they may arrive at {:.3} m/s \
             at {at}",
            self.impact
        );
        if self.margin() < 1.0 {
            let place = |fixed: FixedSphere| {
                format!("({:.4}, {:.4}) m", fixed.position[0], fixed.position[2])
            };
            let warning = match failure {
                WallFailure::Passed => format!(
                    "faster ones squeeze through, first between {} and {}",
                    place(one),
                    place(other)
                ),
                WallFailure::OverlapGuard => format!(
                    "faster ones may break the overlap guard, first at {}",
                    place(one)
                ),
            };
            let indent = "";
            text += &format!(
                "\n{indent:14}WARNING: {warning};\n{indent:14}increase the stiffness, or make the \
                 spheres lighter or slower"
            );
        }
        text
    }

    pub(super) fn answer(&self) -> Answer {
        Answer {
            holds_up_to: self.wall.speed,
            fastest_impact: self.impact,
            radius: self.wall.radius,
            hold: self.margin() >= 1.0,
        }
    }
}

/// The `--json` result.
#[derive(Serialize)]
pub(super) struct Answer {
    /// Speed above which a sphere squeezes through, or breaks the overlap guard (m/s); and the
    /// radius of that sphere (m).
    holds_up_to: f64,
    radius: f64,
    /// Fastest impact expected in the scene (m/s).
    fastest_impact: f64,
    hold: bool,
}
