//! Checks spheres that move along prescribed paths.

use super::plural;
use crate::document::Problem;
use crate::scene::{Scene, Shape};

impl Scene {
    pub(super) fn check_driven(&self, problems: &mut Vec<Problem>) {
        if self.dem.driven.is_empty() {
            return;
        }
        let mut refuse = |path: String, message: String, help: &str| {
            problems.push(Problem::new(path, message).help(help));
        };
        for (k, path) in self.dem.driven.iter().enumerate() {
            if path.sphere >= self.spheres.count {
                let spheres = plural(self.spheres.count, "sphere", "spheres");
                let message = format!(
                    "there is no sphere {}: the scene has {spheres}",
                    path.sphere
                );
                let help = "the first sphere is 0";
                refuse(format!("driven[{k}].sphere"), message, help);
            }
            if self.dem.driven[..k]
                .iter()
                .any(|it| it.sphere == path.sphere)
            {
                let message = format!("sphere {} has a path already", path.sphere);
                let help = "give each sphere one entry of [[driven]]";
                refuse(format!("driven[{k}].sphere"), message, help);
            }
            let out = path.velocity[1] != 0.0 || path.amplitude[1] != 0.0;
            if self.spheres.shape == Shape::Disc && out {
                let message = "discs lie in the plane y = 0, but this path leads out of it";
                let help = "set the second numbers to 0, or use `shape = \"sphere\"`";
                refuse(format!("driven[{k}]"), message.to_owned(), help);
            }
        }
    }
}
