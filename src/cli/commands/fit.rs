//! `phase fit`: fits the parameters of a simpler model to a run.

use crate::cli::columns::{in_columns, written};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::folders;
use crate::cli::options::Window;
use phase::compare::{MeasuredDrainage, SpotFit};
use phase::scene::{Scene, Units};
use phase::statistics::Estimate;
use phase::store;
use serde::Serialize;
use std::path::PathBuf;

/// Fit the parameters of the spot model to the record of a drainage, and write a scene with them.
///
/// Follows Rycroft, Bazant, Grest and Landry (2006): b from the width of the flow, w from the
/// diffusion of spheres, the radius from the correlation of velocities, the rates from the outflow
/// and from the drop of the density. Each has a 95 % interval over ten states or blocks of time.
#[derive(clap::Args)]
#[command(after_help = "\
Example: fit spots to a run of discrete elements, and compare
  phase fit dem.h5 --times 40,160 --out spots.toml
  phase run spots.toml
  phase compare dem.h5 results/spots.h5 --times 40,160")]
pub(crate) struct Arguments {
    /// The record (HDF5) of `phase run`.
    #[arg(value_name = "RECORD")]
    record: PathBuf,
    /// The model.
    #[arg(long, default_value = "spot")]
    model: Model,
    #[command(flatten)]
    window: Window,
    /// The scene to write (TOML).
    #[arg(short, long, value_name = "TOML")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Model {
    /// Diffusing spots of free volume.
    Spot,
}

/// A parameter: its key in a scene, its symbol, the value that Rycroft, Wong and Bazant (2010)
/// fitted to their discrete elements, in units of the spheres, and how.
struct Parameter {
    key: &'static str,
    symbol: &'static str,
    paper: f64,
    dimension: Dimension,
    from: &'static str,
    value: fn(&SpotFit) -> Estimate,
}

/// Dimension of a parameter.
#[derive(Clone, Copy)]
enum Dimension {
    /// A length, in diameters d.
    Length,
    Ratio,
    /// A rate, per tau = sqrt(d/g).
    Rate,
}

const PARAMETERS: [Parameter; 5] = [
    Parameter {
        key: "diffusion_length",
        symbol: "b",
        paper: 2.28,
        dimension: Dimension::Length,
        from: "width of the flow",
        value: |fit| fit.diffusion_length,
    },
    Parameter {
        key: "displacement_ratio",
        symbol: "w",
        paper: 399.0,
        dimension: Dimension::Ratio,
        from: "diffusion of spheres",
        value: |fit| fit.displacement_ratio,
    },
    Parameter {
        key: "radius",
        symbol: "r_s",
        paper: 2.60,
        dimension: Dimension::Length,
        from: "correlation of velocities",
        value: |fit| fit.radius,
    },
    Parameter {
        key: "insertion_rate",
        symbol: "λ",
        paper: 375.0,
        dimension: Dimension::Rate,
        from: "outflow",
        value: |fit| fit.insertion_rate,
    },
    Parameter {
        key: "move_rate",
        symbol: "μ",
        paper: 28.0,
        dimension: Dimension::Rate,
        from: "drop of the density",
        value: |fit| fit.move_rate,
    },
];

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let Model::Spot = arguments.model;
    if let Some(scene) = &arguments.out {
        folders::refuse_to_replace(scene, "a scene of this command", HEAD.as_bytes())?;
        folders::make_for(scene)?;
    }
    let path = arguments.record.display();
    let record = store::read_record(&arguments.record)?;
    let lacks = |needs: &str| Failure::refused(format_args!("{path}: a fit needs {needs}"));
    let drainage = MeasuredDrainage::new(&record, arguments.window.times).map_err(lacks)?;
    let fit = SpotFit::of(&drainage).map_err(lacks)?;
    let head = ["key", "symbol", "fit", "paper", "from"].map(str::to_owned);
    let rows = PARAMETERS.iter().map(|it| row(it, &fit, &record.scene));
    let rows: Vec<[String; 5]> = std::iter::once(head).chain(rows).collect();
    for line in in_columns(&rows) {
        console.result(line);
    }
    console.note(
        "the intervals are the scatter within this run, not the error of the procedure: \
         analysis/spot.md of the project fits spots whose parameters are known",
    );
    if let Some(path) = &arguments.out {
        let text = scene(&drainage, &fit);
        store::write_atomic(path, text.as_bytes())?;
        console.file(path);
        if let Err(error) = Scene::from_toml(&text, path) {
            console.warning(format_args!(
                "spots with these parameters cannot be run in this box; `phase run` will refuse \
                 the scene:\n{error}"
            ));
        }
    }
    let entry = |it: &Parameter| Entry::new(it, &fit, &record.scene);
    console.answer_with_files(&Answer {
        parameters: PARAMETERS.iter().map(entry).collect(),
    });
    Ok(Exit::Done)
}

impl Parameter {
    /// The paper's value in SI units for spheres of this scene; `None` if their tau is not known.
    fn of_paper(&self, scene: &Scene) -> Option<f64> {
        let diameter = 2.0 * scene.spheres.radius.mean();
        let gravity = match (&scene.dem.effects.gravity, scene.units()) {
            (Some(gravity), _) => Some(gravity.acceleration),
            // Spots know no gravity.
            (None, Units::OfSpheres) => Some(1.0),
            (None, Units::Si) => None,
        };
        match self.dimension {
            Dimension::Length => Some(self.paper * diameter),
            Dimension::Ratio => Some(self.paper),
            Dimension::Rate => gravity.map(|gravity| self.paper * (gravity / diameter).sqrt()),
        }
    }
}

fn row(parameter: &Parameter, fit: &SpotFit, scene: &Scene) -> [String; 5] {
    let paper = parameter.of_paper(scene);
    [
        format!("spot.{}", parameter.key),
        parameter.symbol.to_owned(),
        written((parameter.value)(fit)),
        paper.map_or_else(|| "-".to_owned(), |paper| rounded(paper).to_string()),
        parameter.from.to_owned(),
    ]
}

/// A number with four digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// First line of the scenes that this command writes.
const HEAD: &str = "# Parameters of the spot model, fitted by `phase fit`.";

/// The scene of the same drainage by spots.
fn scene(drainage: &MeasuredDrainage<'_>, fit: &SpotFit) -> String {
    let scene = &drainage.record.scene;
    let tank = scene.tank.clone().unwrap_or_default();
    let opening = match (tank.orifice_radius, tank.slit_width) {
        (Some(radius), _) => format!("orifice_radius = {radius:?}"),
        (None, Some(width)) => format!("slit_width = {width:?}"),
        (None, None) => String::new(),
    };
    let walls = [
        ("width", tank.width),
        ("depth", tank.depth),
        ("floor", tank.floor),
    ];
    let walls = walls.map(|(key, value)| format!("{key} = {:?}\n", value.unwrap_or_default()));
    let parameters = PARAMETERS.iter().map(|it| {
        let Estimate { value, half_width } = (it.value)(fit);
        let digits = format!("{value:.4e}").parse().unwrap_or(value);
        let half = format!("{half_width:.1e}").parse().unwrap_or(half_width);
        format!(
            "{} = {digits:?}    # {} ± {half:?}: {}\n",
            it.key, it.symbol, it.from
        )
    });
    format!(
        "{HEAD}\n\ntitle = \"Spots, fitted\"\nseed = {}\n\n[spheres]\ncount = {}\nradius = {:?}\n\
         density = {:?}\n\n[tank]\n{}{opening}\n\n[start]\nkind = \"packing\"\n\n[spot]\n{}\
         vertical_step = {:?}    # a tenth of a diameter\n\n[time]\nduration = {:?}\n\
         frame_interval = {:?}\n\n[output]\nsnapshot_interval = {:?}\n",
        scene.seed,
        scene.spheres.count,
        scene.spheres.radius.mean(),
        scene.spheres.density,
        walls.concat(),
        parameters.collect::<String>(),
        fit.vertical_step,
        drainage.duration(),
        scene.time.frame_interval,
        scene.output.snapshot_interval,
    )
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    parameters: Vec<Entry>,
}

/// A parameter.
#[derive(Serialize)]
struct Entry {
    key: String,
    value: f64,
    /// Half the width of its interval of 95 %, if its scatter is known.
    half_width: Option<f64>,
    /// The value of Rycroft, Wong and Bazant (2010) for spheres of this size, if tau is known.
    paper: Option<f64>,
}

impl Entry {
    fn new(parameter: &Parameter, fit: &SpotFit, scene: &Scene) -> Self {
        let Estimate { value, half_width } = (parameter.value)(fit);
        Self {
            key: format!("spot.{}", parameter.key),
            value,
            half_width: Some(half_width).filter(|it| it.is_finite()),
            paper: parameter.of_paper(scene).map(rounded),
        }
    }
}
