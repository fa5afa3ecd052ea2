//! Whether a random start finds room for the spheres.

use crate::document::Problem;
use crate::scene::{Scene, Start, Tank, plural, rounded};
use crate::start;

/// Largest share of the space open to the spheres that a random start may fill. Random placement
/// one by one without overlap cannot exceed 0.384 (Zhang and Torquato, Phys. Rev. E 88, 053312
/// (2013)) and needs ever more attempts on the way there.
const PACKING_LIMIT: f64 = 0.30;

/// Share up to which a random start is taken to succeed without a trial.
const CERTAIN_PACKING: f64 = 0.10;

/// Largest number of spheres that are placed on trial. Larger numbers are small against their tank.
const MOST_TRIED: usize = 10_000;

impl Scene {
    /// Checks that a random start has enough room. Other starts bring their own positions.
    pub(super) fn check_room(&self, problems: &mut Vec<Problem>) {
        let Start::Random { z_min, z_max, .. } = self.start else {
            return;
        };
        let area = self.tank.as_ref().and_then(Tank::area);
        if let Some(area) = area.filter(|_| z_min <= z_max && self.misfit().is_none()) {
            self.check_room_between(area, z_min, z_max, problems);
        }
    }

    /// Whether the spheres fit between `z_min` and `z_max` within walls that enclose `area` (m2).
    fn check_room_between(&self, area: f64, z_min: f64, z_max: f64, problems: &mut Vec<Problem>) {
        let radii = &self.spheres.radius;
        let volume = self.spheres.count as f64 * radii.mean_volume();
        let height_for = |fraction: f64| volume / (fraction * area);
        let height = z_max - z_min + 2.0 * radii.mean();
        let fraction = height_for(1.0) / height;
        let limit = match fraction {
            fraction if fraction > PACKING_LIMIT => PACKING_LIMIT,
            // Spheres that are not small against the tank find less room: only a trial tells.
            fraction if fraction > CERTAIN_PACKING && self.trial_fails() => CERTAIN_PACKING,
            _ => return,
        };
        let message = format!(
            "{} do not fit: they would fill {:.0} % of the space between `start.z_min` and \
             `start.z_max`, and a random start without overlap fills {:.0} % at most",
            plural(self.spheres.count, "sphere", "spheres"),
            100.0 * fraction,
            100.0 * PACKING_LIMIT,
        );
        let message = if limit < PACKING_LIMIT {
            format!("{message} (less where spheres are large against the tank)")
        } else {
            message
        };
        let z_max = z_min + 1.01 * (height_for(limit) - 2.0 * radii.mean());
        let help = format!(
            "use `z_max = {}` or more, or fewer or smaller spheres",
            rounded(z_max)
        );
        problems.push(Problem::new("start.z_max", message).help(help));
    }

    /// Whether the spheres, if they are not too many for a quick trial, cannot be placed.
    fn trial_fails(&self) -> bool {
        self.spheres.count <= MOST_TRIED && start::place(self).is_err()
    }
}
