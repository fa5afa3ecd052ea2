//! Whether what a scene wants to be stored can be held in memory.

use super::rounded;
use crate::document::{Problem, number};
use crate::scene::Scene;

/// Most numbers of an observable with several per frame: a gigabyte of them.
const MOST_NUMBERS: f64 = 2.5e8;

impl Scene {
    pub(super) fn check_output(&self, problems: &mut Vec<Problem>) {
        let frames = self.time.duration / self.time.frame_interval;
        let most = libm::floor(MOST_NUMBERS / frames);
        let tank = self.tank.as_ref().and_then(|tank| tank.radius);
        if let Some(radius) = tank {
            let natural = libm::round(radius / (2.0 * self.spheres.radius.mean()));
            let (bins, whose) = match self.output.profile_bins {
                Some(bins) => (bins as f64, "asks for"),
                None => (natural, "has by default, tank radius over sphere diameter,"),
            };
            if bins > most {
                let message = format!(
                    "the surface profile {whose} {} bins in each of {} frames, which is too much",
                    rounded(bins),
                    rounded(frames)
                );
                let help = format!(
                    "use `profile_bins = {}` or less in [output]",
                    number(most.max(1.0))
                );
                problems.push(Problem::new("output.profile_bins", message).help(help));
            }
        }
        let counts = (self.output.rise_speeds.len() * self.output.rise_radii.len()) as f64;
        if counts > most {
            let message = format!(
                "{} counts of rising spheres in each frame are too many",
                number(counts)
            );
            let help = "list fewer `rise_speeds` and `rise_radii`";
            problems.push(Problem::new("output.rise_speeds", message).help(help));
        }
    }
}
