//! The phase diagram of the numerics: what became of the runs of a study, one panel per integrator,
//! with the theoretical limit of the time step over it.

use super::contour::{Nodes, Piece};
use super::diagram::{Curve, Diagram, Look, Stroke};
use super::grid::{Grid, GridAxis, Panel};
use super::legend::{Entry, Key};
use super::style::Fill;
use super::svg::Svg;
use super::{PlotError, palette};
use crate::classify::{Label, NUMERICS};
use crate::dem::timestep::{Limit, limits};
use crate::record::Program;
use crate::scene::Scene;
use crate::study::comparison::{RunRow, Setting};
use crate::study::stability::StabilityStudy;

/// What the legend calls the full and the dashed curves.
const LIMITS: [&str; 2] = ["limit of the time step", "advised limit of twelve contacts"];

/// Draws the rows of a study.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub fn draw(
    study: &StabilityStudy,
    rows: &[Option<RunRow>],
    program: &Program,
) -> Result<Svg, PlotError> {
    let sweep = &study.comparison.settings[0].sweep;
    let axis = |index| GridAxis::over(index, &sweep.axes, &sweep.scene, std::iter::empty());
    let (x, y) = (axis(0), axis(1));
    let settings = study.comparison.settings.iter();
    let curves = settings.map(|it| curves(study, it, &x, &y));
    let curves: Vec<Vec<Curve>> = curves.collect();
    let grid = Grid {
        panels: panels(study, rows, &x, &y),
        x,
        y: Some(y),
        columns: None,
        rows: None,
    };
    let occurs = |label: &Label| rows.iter().flatten().any(|row| row.label == *label);
    let legend = NUMERICS.labels.iter().filter(|label| occurs(label));
    let legend =
        legend.map(|label| Entry::new(Key::Fill(fill(*label)), &label.name.replace('-', " ")));
    let diagram = Diagram {
        name: "stability",
        grid: &grid,
        look: &|label: &Label| Some(Look::new(fill(*label), Some(label.code))),
        empty: "not run".to_owned(),
        legend: legend.collect(),
        bar: None,
    };
    let entries = Curve::entries(&curves, LIMITS);
    let body = diagram.body(sweep.title.as_deref(), &curves, entries)?;
    let scene = Scene {
        title: sweep.title.clone(),
        ..sweep.scene.clone()
    };
    Ok(Svg::of_scene(diagram.name, &scene, program, &body))
}

fn fill(label: Label) -> Fill {
    Fill::Color(palette::state(label))
}

/// A panel for each integrator.
fn panels(
    study: &StabilityStudy,
    rows: &[Option<RunRow>],
    x: &GridAxis,
    y: &GridAxis,
) -> Vec<Panel<Label>> {
    let settings = &study.comparison.settings;
    let panel = |(place, setting): (usize, &Setting)| {
        let mut cells = vec![None; x.values.len() * y.values.len()];
        let runs = study.comparison.sample(place, rows).points;
        for (values, runs) in setting.sweep.grid().zip(runs) {
            if let (Some(column), Some(line)) = (x.position(&values), y.position(&values)) {
                let run = runs.first().copied().flatten();
                cells[column + line * x.values.len()] = run.map(|run| run.label);
            }
        }
        Panel {
            head: (settings.len() > 1).then(|| setting.name.clone()),
            column: None,
            row: None,
            cells,
        }
    };
    settings.iter().enumerate().map(panel).collect()
}

/// The limit that decides, and the advised one of a sphere with twelve contacts, which there is not
/// with sub-steps or without contacts.
fn curves(study: &StabilityStudy, setting: &Setting, x: &GridAxis, y: &GridAxis) -> Vec<Curve> {
    let (across, up) = (nodes(x), nodes(y));
    let at_nodes = across
        .iter()
        .flat_map(|&x_value| up.iter().map(move |&y_value| [x_value, y_value]));
    let all: Vec<Option<(f64, Vec<Limit>)>> = at_nodes
        .map(|values| {
            let scene = study.frames.scene_at(&setting.sweep, &values).ok()?;
            Some((scene.time.dt, limits(&scene)))
        })
        .collect();
    let shown = |places: &[f64], axis: &GridAxis| -> Vec<f64> {
        places.iter().map(|place| place * axis.factor).collect()
    };
    let of = |is_meant: fn(&&Limit) -> bool| -> Vec<Piece> {
        let value = |i: usize, j: usize| {
            let (dt, limits) = all[j + i * up.len()].as_ref()?;
            Some(dt / limits.iter().find(is_meant)?.seconds - 1.0)
        };
        Nodes {
            x: &shown(&across, x),
            y: &shown(&up, y),
            value: &value,
            logarithmic: [x, y].map(|axis| axis.spacing().is_logarithmic()),
        }
        .contour()
    };
    vec![
        Curve {
            pieces: of(|limit| limit.name == "twelve contacts"),
            stroke: Stroke::Dashed,
        },
        Curve {
            pieces: of(|limit| limit.decisive),
            stroke: Stroke::Full,
        },
    ]
}

/// Values of an axis and its two ends, where limits are looked at.
fn nodes(axis: &GridAxis) -> Vec<f64> {
    let mut nodes = axis.values.clone();
    let end = |fraction| axis.value(axis.along(fraction));
    nodes.insert(0, end(0.0));
    nodes.push(end(1.0));
    nodes
}
