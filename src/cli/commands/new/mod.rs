//! `phase new`: writes a file to start from.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders;
use phase::store;
use std::path::{Path, PathBuf};

/// Write a file to start from, with comments: a scene, sweep, silo, spot or program, or a hopper, a
/// drum, a chute, a shaken box.
#[derive(clap::Args)]
#[command(after_help = "\
Example: a tank, and a sweep over it
  phase new scene tank
  phase new sweep diagram --scene tank.toml
Example: a grain silo
  phase new silo my-silo
Example: a silo drained by the spot model
  phase new spot my-drainage
Example: a bin with a cone and a gate
  phase new hopper my-hopper
Example: a sweep of a program of your own, with its script
  phase new program epidemic")]
pub(crate) struct Arguments {
    /// The kind of file.
    kind: Kind,
    /// Name of the file, with or without .toml.
    name: PathBuf,
    /// The scene file that the sweep starts from [default: a scene within the new file].
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Replace a file of that name.
    #[arg(short, long)]
    force: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// One simulation.
    Scene,
    /// A scene, and what is varied in it.
    Sweep,
    /// One simulation of a grain silo: filled, at rest, drained.
    Silo,
    /// One simulation of a silo by the spot model.
    Spot,
    /// A sweep of a program of your own, and a script that it runs.
    Program,
    /// One simulation of a bin that drains through a cone.
    Hopper,
    /// One simulation of a drum that turns.
    Drum,
    /// One simulation of a chute between periodic sides.
    Chute,
    /// One simulation of a shaken box.
    Shaken,
}

const SCENE: &str = include_str!("scene.toml");
const SILO: &str = include_str!("silo.toml");
const SPOT: &str = include_str!("spot.toml");
const PROGRAM: &str = include_str!("program.toml");
const MODEL: &str = include_str!("model.py");
const SWEEP: &str = include_str!("sweep.toml");
const HOPPER: &str = include_str!("../../../../sweeps/scenes/hopper.toml");
const DRUM: &str = include_str!("../../../../sweeps/scenes/drum.toml");
const CHUTE: &str = include_str!("../../../../sweeps/scenes/chute.toml");
const SHAKEN: &str = include_str!("../../../../sweeps/scenes/shaken.toml");

/// The line of the starter sweep that names its scene.
const SCENE_LINE: &str = "scene = \"tank.toml\"";

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let path = match arguments.name.extension() {
        Some(end) if end == "toml" => arguments.name.clone(),
        _ => arguments.name.with_added_extension("toml"),
    };
    if arguments.kind != Kind::Sweep && arguments.scene.is_some() {
        return Err(Failure::refused("--scene is for `phase new sweep` only"));
    }
    let script = (arguments.kind == Kind::Program).then(|| path.with_extension("py"));
    for file in [&path].into_iter().chain(&script) {
        if file.exists() && !arguments.force {
            return Err(Failure::refused(
                "the file exists already; choose another name, or replace it with --force",
            )
            .at(file));
        }
    }
    folders::make_for(&path)?;
    let text = match (arguments.kind, &arguments.scene) {
        (Kind::Scene, _) => SCENE.to_owned(),
        (Kind::Silo, _) => SILO.to_owned(),
        (Kind::Spot, _) => SPOT.to_owned(),
        (Kind::Program, _) => program_of(&path),
        (Kind::Hopper, _) => shipped(HOPPER),
        (Kind::Drum, _) => shipped(DRUM),
        (Kind::Chute, _) => shipped(CHUTE),
        (Kind::Shaken, _) => shipped(SHAKEN),
        (Kind::Sweep, Some(scene)) => sweep_of_file(&from_folder_of(&path, scene))?,
        (Kind::Sweep, None) => sweep_of_table(),
    };
    store::write_atomic(&path, text.as_bytes())?;
    console.file(&path);
    if let Some(script) = script {
        store::write_atomic(&script, MODEL.as_bytes())?;
        console.file(&script);
    }
    if arguments.scene.is_some()
        && let Err(error) = phase::sweep::load(&path)
    {
        console.warning(format_args!(
            "the sweep does not fit its scene yet; edit it first: {error}"
        ));
    }
    let kind = match arguments.kind {
        Kind::Scene
        | Kind::Silo
        | Kind::Spot
        | Kind::Hopper
        | Kind::Drum
        | Kind::Chute
        | Kind::Shaken => "scene",
        Kind::Sweep | Kind::Program => "sweep",
    };
    console.note(format_args!(
        "for help from an editor: `phase generate schema {kind} > {kind}.json`, and `#:schema \
         {kind}.json` as the first line of the file"
    ));
    Ok(Exit::Done)
}

/// A shipped scene without its first line, which leads to a schema beside it.
fn shipped(text: &str) -> String {
    let rest = text.split_once('\n').map_or(text, |(_, rest)| rest);
    rest.to_owned()
}

/// The path of a scene as the new file must write it: relative to the folder of the new file, which
/// exists. On the command line it is relative to the current folder.
fn from_folder_of(file: &Path, scene: &Path) -> PathBuf {
    let folder = file.parent().unwrap_or(Path::new(""));
    if scene.is_absolute() || folder.as_os_str().is_empty() {
        return scene.to_owned();
    }
    let (Ok(folder), Ok(scene_there)) = (std::path::absolute(folder), std::path::absolute(scene))
    else {
        return scene.to_owned();
    };
    // Where the system knows them, without links and `..`, which would lead elsewhere.
    let known = |path: PathBuf| path.canonicalize().unwrap_or(path);
    let folder = known(folder);
    let name = scene_there.file_name().unwrap_or_default().to_owned();
    let scene_folder = known(scene_there.parent().unwrap_or(Path::new("/")).to_owned());
    let (mut up, mut down) = (
        folder.components().peekable(),
        scene_folder.components().peekable(),
    );
    while up.peek().is_some() && up.peek() == down.peek() {
        up.next();
        down.next();
    }
    let mut path: PathBuf = up.map(|_| "..").collect();
    path.extend(down);
    path.join(name)
}

/// The starter sweep over a scene of its own file.
fn sweep_of_file(scene: &Path) -> Result<String, Failure> {
    let name = scene.to_str().ok_or_else(|| not_text(scene))?;
    let name = toml::Value::String(name.to_owned());
    Ok(SWEEP.replace(SCENE_LINE, &format!("scene = {name}")))
}

/// The failure of a path that no file of text can name.
fn not_text(scene: &Path) -> Failure {
    Failure::refused(format_args!(
        "--scene {}: a sweep file is UTF-8 text, and this path is not; rename the file or its \
         folders",
        scene.display()
    ))
}

/// The starter sweep of a program, in a file of that name with its script beside it.
fn program_of(path: &Path) -> String {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let text = PROGRAM.replace("program.toml", &format!("{name}.toml"));
    text.replace("model.py", &format!("{name}.py"))
}

/// The starter sweep with the starter scene in it.
fn sweep_of_table() -> String {
    let mut text = String::new();
    for line in SWEEP.lines().filter(|line| !line.starts_with(SCENE_LINE)) {
        text += &format!("{line}\n");
    }
    text += "\n# The scene that every simulation of the sweep starts from.\n[scene]\n";
    let is_accuracy = |line: &&str| line.starts_with("accuracy");
    for line in SCENE.lines().filter(is_accuracy) {
        text += &format!("{line}\n\n");
    }
    // The sweep has its own heading and title.
    let tables = SCENE.lines().skip_while(|line| !line.starts_with('['));
    for line in tables {
        text += &match line.strip_prefix('[') {
            Some(table) => format!("[scene.{table}\n"),
            None => format!("{line}\n"),
        };
    }
    text
}
