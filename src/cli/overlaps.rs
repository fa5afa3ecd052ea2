//! Warnings of spheres that overlap at the start.

use super::console::Console;
use super::format;
use phase::dem::{Overlap, Release};
use phase::grid::{Axis, describe};
use phase::scene::Scene;
use phase::sweep::Job;

/// Warns of overlaps that are deep or push spheres apart faster than any impact of the scene.
pub(super) fn warn_of_scene(scene: &Scene, console: &Console) {
    if let Some(release) = Release::of_scene(scene) {
        warn(&release, "", console);
    }
}

/// As [`warn_of_scene`], for the job that has the fastest one.
pub(super) fn warn_of_jobs(jobs: &[Job], axes: &[Axis], console: &Console) {
    let releases = jobs.iter().filter_map(|job| {
        let release = Release::of_scene(&job.scene())?;
        Some((release, job))
    });
    let fastest = releases.max_by(|(a, _), (b, _)| a.fastest.speed.total_cmp(&b.fastest.speed));
    if let Some((release, job)) = fastest {
        let at = match axes {
            [] => String::new(),
            _ => format!(" at {}", describe(axes, &job.values, job.seed)),
        };
        warn(&release, &at, console);
    }
}

fn warn(release: &Release, at: &str, console: &Console) {
    let Release {
        fastest,
        others,
        impact,
    } = release;
    let Overlap {
        sphere,
        partner,
        depth,
        depth_in_radii,
        speed,
        ..
    } = fastest;
    let others = match others {
        0 => String::new(),
        _ => format!("; {} more like this", format::count(*others, "overlap")),
    };
    let faster = match speed > impact {
        true => format!(", faster than any impact expected in this scene ({impact:.3} m/s)"),
        false => String::new(),
    };
    console.warning(format_args!(
        "sphere {sphere} starts {depth:.3e} m ({depth_in_radii:.3} radii) deep in {partner}{at}: \
         the contact will push them apart at up to {speed:.3} m/s{faster}{others}"
    ));
}
