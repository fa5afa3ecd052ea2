//! Programs that scenes start: whether they may, and their versions.

use super::console::Console;
use super::exit::Failure;
use super::interrupt;
use phase::document::shown;
use phase::external::find_version;
use phase::scene::{ExternalProgram, Scene};
use phase::sweep::{Folder, Plan, Sweep};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// The option that lets a file start programs.
#[derive(clap::Args)]
pub(super) struct AllowProgram {
    /// Start the program that the file names in [program]. Such a file is code: read it first.
    #[arg(long)]
    allow_program: bool,
}

/// What the user's own configuration says.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Configuration {
    /// Files that may start programs, and folders of such files.
    programs: Vec<PathBuf>,
}

impl AllowProgram {
    /// Makes a sweep ready whose scenes start programs: asks whether they may, and what their
    /// versions are. Returns whether there are any.
    pub(super) fn prepare(
        &self,
        sweep: &mut Sweep,
        file: &Path,
        console: &Console,
    ) -> Result<bool, Failure> {
        self.prepare_scenes(&mut sweep.scenes_mut().collect::<Vec<_>>(), file, console)
    }

    /// The same for a scene.
    pub(super) fn prepare_scene(
        &self,
        scene: &mut Scene,
        file: &Path,
        console: &Console,
    ) -> Result<bool, Failure> {
        self.prepare_scenes(&mut [scene], file, console)
    }

    /// Asks whether a sweep may start its programs, of which it then has some.
    pub(super) fn ask(&self, sweep: &mut Sweep, file: &Path) -> Result<bool, Failure> {
        self.ask_for(&sweep.scenes_mut().collect::<Vec<_>>(), file)
    }

    fn prepare_scenes(
        &self,
        scenes: &mut [&mut Scene],
        file: &Path,
        console: &Console,
    ) -> Result<bool, Failure> {
        if !self.ask_for(scenes, file)? {
            return Ok(false);
        }
        let stop = interrupt::stop_on_signal(console)?;
        find_versions(scenes, stop, console)?;
        Ok(true)
    }

    fn ask_for(&self, scenes: &[&mut Scene], file: &Path) -> Result<bool, Failure> {
        let programs = || scenes.iter().filter_map(|scene| scene.program.as_ref());
        let mut names: Vec<String> = programs()
            .flat_map(ExternalProgram::programs)
            .map(|it| format!("`{}`", shown(it)))
            .collect();
        names.sort_unstable();
        names.dedup();
        if names.is_empty() {
            return Ok(false);
        }
        if !self.allow_program && !is_listed(file)? {
            return Err(refuse(&names.join(", "), file));
        }
        Ok(true)
    }
}

/// Asks the programs for their versions, each command once.
fn find_versions(
    scenes: &mut [&mut Scene],
    stop: &AtomicBool,
    console: &Console,
) -> Result<(), Failure> {
    let mut known: BTreeMap<Vec<String>, String> = BTreeMap::new();
    for program in scenes.iter_mut().filter_map(|it| it.program.as_mut()) {
        if program.version.is_empty() {
            continue;
        }
        let found = match known.get(&program.version) {
            Some(found) => found.clone(),
            None => {
                let found = find_version(&program.version, stop).map_err(Failure::failed)?;
                console.detail(format_args!("{}: {}", program.version[0], shown(&found)));
                known.insert(program.version.clone(), found.clone());
                found
            }
        };
        program.found_version = Some(found);
    }
    Ok(())
}

/// How long a run took on average (s), if any run of a plan is done.
pub(super) fn seconds_of_runs(plan: &Plan) -> Option<f64> {
    let times = plan.done().map(|(_, done)| done.cpu_seconds);
    let (runs, seconds) = times.fold((0, 0.0), |(runs, sum), it| (runs + 1, sum + it));
    (runs > 0).then(|| seconds / f64::from(runs))
}

/// Gives the programs of a sweep the versions that a results folder keeps of them, if it does.
/// Starts none. Returns whether a version was found.
pub(super) fn take_versions(sweep: &mut Sweep, folder: &Folder) -> bool {
    let asks = |scene: &Scene| {
        let program = scene.program.as_ref();
        program.is_some_and(|it| !it.version.is_empty())
    };
    if !sweep.scenes().into_iter().any(asks) {
        return false;
    }
    let Ok(stored) = folder.read_sweep() else {
        return false;
    };
    let stored = stored.scenes().into_iter();
    let stored: Vec<ExternalProgram> = stored.filter_map(|it| it.program.clone()).collect();
    for scene in sweep.scenes_mut() {
        if let Some(program) = &mut scene.program {
            let same = stored.iter().find(|it| it.version == program.version);
            program.found_version = same.and_then(|it| it.found_version.clone());
        }
    }
    true
}

fn refuse(names: &str, file: &Path) -> Failure {
    let listed = match configuration_file() {
        Some(path) => format!(
            ", or list the file or its folder in {}: `programs = [\"{}\"]`",
            path.display(),
            file.canonicalize()
                .unwrap_or_else(|_| file.to_owned())
                .display()
        ),
        None => String::new(),
    };
    Failure::refused(format_args!(
        "{}: it starts {names}, and a file that starts programs is code; read it, then give \
         --allow-program{listed}",
        file.display()
    ))
}

/// Whether the user's own configuration lists a file, or a folder that it lies in.
fn is_listed(file: &Path) -> Result<bool, Failure> {
    let Some(path) = configuration_file() else {
        return Ok(false);
    };
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(Failure::refused(error).at(&path)),
    };
    let configuration: Configuration = toml::from_str(&text).map_err(|error| {
        let help = "it may say `programs = [\"/path/of/a/folder\"]`";
        Failure::refused(format_args!("{}; {help}", error.message())).at(&path)
    })?;
    // A results folder may come from anywhere.
    let Some(file) = file.canonicalize().ok().filter(|it| it.is_file()) else {
        return Ok(false);
    };
    let listed = configuration.programs.iter();
    let mut listed = listed.filter(|it| it.is_absolute());
    Ok(listed.any(|it| it.canonicalize().is_ok_and(|it| file.starts_with(it))))
}

/// The user's own configuration.
fn configuration_file() -> Option<PathBuf> {
    let set = |name| {
        env::var_os(name)
            .filter(|it| !it.is_empty())
            .map(PathBuf::from)
    };
    let folder = set("XDG_CONFIG_HOME").or_else(|| Some(set("HOME")?.join(".config")));
    Some(folder?.join("phase").join("config.toml"))
}
