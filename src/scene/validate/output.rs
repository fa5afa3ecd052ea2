//! Checks whether the output of a scene fits into memory.

use super::rounded;
use super::time::{MOST_FRAMES, multiple};
use crate::document::{Problem, accepted, number};
use crate::scene::{ProfileAxis, Scene};

/// Largest number of values of an observable with several per frame: one gigabyte.
const MOST_NUMBERS: f64 = 2.5e8;

/// Largest number of values in the states of all spheres in a record: eight gigabytes.
const MOST_IN_STATES: f64 = 1e9;

/// Numbers in the state of a sphere: position, velocity, spin.
const NUMBERS_OF_A_SPHERE: f64 = 9.0;

/// Most bins of a profile.
const MOST_BINS: usize = 200;

impl Scene {
    pub(super) fn check_output(&self, problems: &mut Vec<Problem>) {
        self.check_states(problems);
        self.check_columns(problems);
        let frames = self.time.duration / self.time.frame_interval;
        if frames > MOST_FRAMES {
            // Refused elsewhere.
            return;
        }
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
                let help = format!("use `profile_bins = {}` or less in [output]", most as u64);
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

impl Scene {
    /// Whether runs can have the further columns that are asked for.
    fn check_columns(&self, problems: &mut Vec<Problem>) {
        let columns = &self.output.columns;
        for (index, column) in columns.iter().enumerate() {
            let path = format!("output.columns[{index}]");
            if let Some(why) = column.absent_in(self) {
                let message = format!("this scene has no column `{}`: {why}", column.name());
                problems.push(Problem::new(path, message).help("remove it"));
            } else if columns[..index].contains(column) {
                let message = format!("`{}` is listed twice", column.name());
                problems.push(Problem::new(path, message).help("remove it"));
            }
        }
        self.check_profiles(problems);
        if self.output.walls
            && let Some(why) = self.without_wall_columns()
        {
            let message = format!("this scene has no forces on walls: {why}");
            problems.push(Problem::new("output.walls", message).help("remove it"));
        }
        if let Some(layer) = &self.output.layer
            && layer.z_max <= layer.z_min
        {
            let message = "the upper side of the layer is not above its lower side";
            let problem = Problem::new("output.layer.z_max", message);
            problems.push(problem.help("give a larger height"));
        }
    }

    /// Whether runs can have the profiles that are asked for.
    fn check_profiles(&self, problems: &mut Vec<Problem>) {
        let profiles = &self.output.profiles;
        for (index, profile) in profiles.iter().enumerate() {
            let mut refuse = |key: &str, message: String, help: &str| {
                let path = format!("output.profiles[{index}].{key}");
                problems.push(Problem::new(path, message).help(help));
            };
            let name = profile.of.name();
            if let Some(why) = profile.absent_in(self) {
                refuse(
                    "of",
                    format!("this scene has no profile `{name}`: {why}"),
                    "remove it",
                );
            }
            if profile.bins > MOST_BINS {
                let message = format!("{} bins are too many", profile.bins);
                refuse("bins", message, &format!("use {MOST_BINS} or fewer"));
            }
            if profile.to <= profile.from {
                let message = "the last bin does not end above the beginning of the first";
                refuse("to", message.to_owned(), "give a larger number");
            }
            if profile.over == ProfileAxis::Radius && profile.from < 0.0 {
                let message = "a distance from the axis is not below 0";
                refuse("from", message.to_owned(), "give 0 or more");
            }
            if profiles[..index]
                .iter()
                .any(|it| it.stem() == profile.stem())
            {
                let message = format!(
                    "another profile has the columns `{}1` already",
                    profile.stem()
                );
                refuse("of", message, "join their bins, or remove one");
            }
        }
    }

    /// Whether all states that are requested fit into memory.
    fn check_states(&self, problems: &mut Vec<Problem>) {
        let state = NUMBERS_OF_A_SPHERE * self.spheres.count as f64;
        let most = libm::floor(MOST_IN_STATES / state).max(1.0);
        let states = |interval: f64| libm::floor(self.time.duration / interval) + 1.0;
        let mut refuse = |key: &str, states: f64, help: String| {
            let message = format!(
                "the record would hold {} states of {} spheres, which is too much",
                rounded(states),
                number(self.spheres.count as f64)
            );
            problems.push(Problem::new(key, message).help(help));
        };
        let frames = states(self.time.frame_interval);
        if self.output.trajectory && frames > most {
            let help = "set `trajectory = false`, or use a larger `frame_interval`";
            refuse("output.trajectory", frames, help.to_owned());
        }
        let interval = self.output.snapshot_interval;
        let fits = |interval: f64| states(interval) <= most.max(2.0);
        if interval > 0.0 && !fits(interval) {
            let frame = self.time.frame_interval;
            // The smallest number of frames between snapshots that fits.
            let apart = libm::floor(self.time.duration / (most.max(2.0) * frame)) + 1.0;
            let least = accepted(apart * frame, |it| fits(it) && multiple(it, frame));
            let help = match least {
                Some(least) => format!(
                    "use `snapshot_interval = {least}` or more, or 0 for the last one alone"
                ),
                None => "use a longer one, or 0 for the last one alone".to_owned(),
            };
            refuse("output.snapshot_interval", states(interval), help);
        }
    }
}
