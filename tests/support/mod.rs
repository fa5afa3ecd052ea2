//! Runs the built program in a temporary folder, on sweeps that take milliseconds.
#![allow(dead_code, reason = "each test program uses a part of it")]

pub(crate) mod caller;

use caller::command;
use phase::store::{content_digest, read_record};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A temporary folder to work in.
pub(crate) struct Workplace {
    folder: tempfile::TempDir,
}

/// What the program answered.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Workplace {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = command(env!("CARGO_BIN_EXE_phase"));
        command.current_dir(self.folder.path()).args(arguments);
        // Packings that the program makes are kept here.
        command.env("XDG_CACHE_HOME", self.path("cache"));
        command
    }

    /// Runs a line of the shell in which `phase` stands for the built program.
    pub(crate) fn shell(&self, line: &str) -> Command {
        let phase = env!("CARGO_BIN_EXE_phase");
        let mut command = command("sh");
        command
            .args(["-c", &line.replace("phase ", &format!("'{phase}' "))])
            .current_dir(self.folder.path())
            .env("XDG_CACHE_HOME", self.path("cache"));
        command
    }

    /// Runs `phase` with these arguments.
    pub(crate) fn phase(&self, arguments: &[&str]) -> Answer {
        let output = assert_cmd::Command::from_std(self.command(arguments))
            .output()
            .unwrap();
        Answer {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Starts `phase` with these arguments, and does not wait.
    pub(crate) fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Names of the records in a results folder.
    pub(crate) fn records(&self, results: &str) -> Vec<String> {
        let Ok(entries) = std::fs::read_dir(self.path(results).join("records")) else {
            return Vec::new();
        };
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.filter(|name| name.ends_with(".h5")).collect();
        names.sort();
        names
    }

    /// What the records of a results folder measured, by name.
    pub(crate) fn digests(&self, results: &str) -> BTreeMap<String, String> {
        let digest = |name: String| {
            let record = read_record(&self.path(results).join("records").join(&name)).unwrap();
            (name, content_digest(&record).unwrap())
        };
        self.records(results).into_iter().map(digest).collect()
    }
}

impl Answer {
    /// Asserts the exit code.
    #[track_caller]
    pub(crate) fn code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        self
    }

    /// Asserts that the standard output holds a text.
    #[track_caller]
    pub(crate) fn says(self, text: &str) -> Self {
        assert!(self.stdout.contains(text), "no `{text}` in {self:#?}");
        self
    }

    /// Asserts that the standard error holds a text.
    #[track_caller]
    pub(crate) fn complains(self, text: &str) -> Self {
        assert!(self.stderr.contains(text), "no `{text}` in {self:#?}");
        self
    }
}

/// A sweep over the rotation of the air about a few spheres in a small tank.
#[derive(Clone)]
pub(crate) struct TinySweep {
    pub(crate) omegas: Vec<f64>,
    pub(crate) seeds: Vec<u64>,
    pub(crate) duration: f64,
    pub(crate) frame_interval: f64,
    /// More tables.
    pub(crate) more: String,
}

impl Default for TinySweep {
    fn default() -> Self {
        Self {
            omegas: vec![0.0, 4.0, 8.0],
            seeds: vec![1, 2],
            duration: 2.0,
            frame_interval: 0.01,
            more: String::new(),
        }
    }
}

impl TinySweep {
    /// One whose jobs take a few tenths of a second each.
    pub(crate) fn slow() -> Self {
        Self {
            duration: 120.0,
            frame_interval: 0.1,
            ..Self::default()
        }
    }

    pub(crate) fn jobs(&self) -> usize {
        self.omegas.len() * self.seeds.len()
    }

    pub(crate) fn text(&self) -> String {
        let scene = scene("scene.", self.duration, self.frame_interval);
        let Self {
            omegas,
            seeds,
            more,
            ..
        } = self;
        format!(
            "title = \"tiny\"\n{scene}\n\
             [[axis]]\nkey = \"swirl.omega\"\nvalues = {omegas:?}\n\
             [seeds]\nlist = {seeds:?}\n{more}\n"
        )
    }
}

/// A scene file.
pub(crate) fn scene_file() -> String {
    scene("", 2.0, 0.01)
}

/// A small box that spots drain: a scene file that ends with its table `[spot]`.
pub(crate) fn drainage_file() -> String {
    r#"
spheres = { count = 400, radius = 0.5, density = 1.9 }
start = { kind = "packing" }
tank = { width = 9.0, depth = 6.0, floor = 0.0, orifice_radius = 2.0 }
time = { duration = 4.0, frame_interval = 0.5 }
output = { snapshot_interval = 1.0 }

[spot]
radius = 2.6
displacement_ratio = 399.0
diffusion_length = 2.28
vertical_step = 0.1
insertion_rate = 375.0
move_rate = 28.0
"#
    .to_owned()
}

/// A silo that twelve grains of two sizes fill, come to rest in and leave, in 3.6 s.
pub(crate) fn silo_file() -> String {
    r#"
title = "Small <silo> & more"
[spheres]
count = 12
radius = [{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]
shape = "disc"
density = 1.0
[contact]
law = "linear"
stiffness = 100.0
damping = 0.05
drag = "whole"
[gravity]
acceleration = 9.81
[geometry]
kind = "hopper"
half_width = 0.3
top = 0.9
foot = 0.4
slope = 0.75
opening = 0.2
spacing = 0.05
radius = 0.03
[start]
kind = "feed"
position = [0.01, 0.0, 0.9]
velocity = [0.0, 0.0, -1.0]
interval = 0.1
[rest]
kinetic_energy = 1e-4
hold = 0.2
[door]
[outlet]
height = -0.3
[time]
dt = 1e-3
duration = 30.0
frame_interval = 0.05
integrator = "velocity-verlet"
[output]
snapshot_interval = 0.2
"#
    .to_owned()
}

fn scene(prefix: &str, duration: f64, frame_interval: f64) -> String {
    format!(
        r#"
[{prefix}spheres]
count = 8
radius = 0.004
density = 3750.0
[{prefix}contact]
law = "hertz"
young_modulus = 5.657e5
poisson_ratio = 0.3
dissipation_time = 1e-3
[{prefix}tank]
radius = 0.03
floor = 0.0
[{prefix}start]
kind = "random"
z_min = 0.01
z_max = 0.05
speed = 0.005
[{prefix}gravity]
acceleration = 9.8
[{prefix}drag]
linear = 100.0
law = "cross-section"
[{prefix}swirl]
omega = 4.0
[{prefix}time]
dt = 1e-4
duration = {duration:?}
frame_interval = {frame_interval:?}
"#
    )
}

/// Waits until something holds, and fails after five minutes.
#[track_caller]
pub(crate) fn wait_until(mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        // Long enough for a machine that builds beside; only a program that hangs waits so long.
        assert!(start.elapsed() < Duration::from_mins(5), "waited in vain");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Sends a signal, such as `INT`, to a process.
#[cfg(unix)]
pub(crate) fn signal(child: &Child, name: &str) {
    use rustix::process::{Pid, Signal, kill_process};
    let signal = match name {
        "HUP" => Signal::HUP,
        "INT" => Signal::INT,
        "TERM" => Signal::TERM,
        "STOP" => Signal::STOP,
        "CONT" => Signal::CONT,
        _ => panic!("no signal {name}"),
    };
    kill_process(Pid::from_child(child), signal).unwrap();
}

#[cfg(not(unix))]
pub(crate) fn signal(_: &Child, name: &str) {
    panic!("this system has no signal {name}");
}

/// Waits for a process to end.
pub(crate) fn end(child: Child) -> Answer {
    let output = child.wait_with_output().unwrap();
    Answer {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Changes a byte in the middle of a file.
pub(crate) fn damage(path: &Path) {
    let mut bytes = std::fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    std::fs::write(path, bytes).unwrap();
}

/// The texts of an SVG, without tags.
pub(crate) fn texts(svg: &str) -> Vec<String> {
    let lines = svg.lines().filter(|line| line.starts_with("<text"));
    lines
        .map(|line| {
            let parts = line.split('<').filter_map(|part| part.split_once('>'));
            parts.map(|(_, text)| text).collect()
        })
        .collect()
}
