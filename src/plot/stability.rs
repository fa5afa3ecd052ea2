//! The phase diagram of the numerics: what became of the runs of a study, one panel per integrator,
//! with the theoretical limit of the time step over it.

use super::contour::{Nodes, Piece};
use super::diagram::{Diagram, Look, PanelCurve, Stroke};
use super::grid::{GridAxis, GridPanel, PanelGrid};
use super::legend::{LegendEntry, LegendKey};
use super::style::Fill;
use super::svg::Svg;
use super::{PlotError, palette};
use crate::dem::timestep::Limit;
use crate::record::Program;
use crate::scene::{Integrator, Scene};
use crate::study::stability::{Label, Row, Study, Theory};

/// What the legend calls the full and the dashed curves.
const LIMITS: [&str; 2] = ["limit of the time step", "advised limit of twelve contacts"];

/// Draws the rows of a study.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub fn draw(study: &Study, rows: &[Row], program: &Program) -> Result<Svg, PlotError> {
    let axis = |index| GridAxis::over(index, &study.axes, &study.scene, std::iter::empty());
    let (x, y) = (axis(0), axis(1));
    let panel = |&integrator: &Integrator| panel(study, rows, integrator, &x, &y);
    let panels = study.integrators.iter().map(panel).collect();
    let theory = |&integrator: &Integrator| curves(study, integrator, &x, &y);
    let curves: Vec<Vec<PanelCurve>> = study.integrators.iter().map(theory).collect();
    let grid = PanelGrid {
        x: x.clone(),
        y: Some(y.clone()),
        columns: None,
        rows: None,
        panels,
    };
    let occurs = |label: &Label| rows.iter().any(|row| row.label == *label);
    let legend = Label::ALL.into_iter().filter(occurs);
    let legend = legend.map(|label| LegendEntry::new(LegendKey::Fill(fill(label)), words(label)));
    let diagram = Diagram {
        name: "stability",
        grid: &grid,
        look: &|label: &Label| Some(Look::new(fill(*label), Some(*label as i8))),
        empty: "not run".to_owned(),
        legend: legend.collect(),
        bar: None,
    };
    let body = diagram.body(
        study.title.as_deref(),
        &curves,
        PanelCurve::entries(&curves, LIMITS),
    )?;
    let scene = Scene {
        title: study.title.clone(),
        ..study.scene.clone()
    };
    Ok(Svg::of_scene(diagram.name, &scene, program, &body))
}

fn words(label: Label) -> &'static str {
    match label {
        Label::Stable => "stable",
        Label::EnergyGain => "energy gain",
        Label::LostSphere => "lost sphere",
        Label::NotANumber => "not a number",
    }
}

fn fill(label: Label) -> Fill {
    Fill::Color(palette::stability(label))
}

fn panel(
    study: &Study,
    rows: &[Row],
    integrator: Integrator,
    x: &GridAxis,
    y: &GridAxis,
) -> GridPanel<Label> {
    let mut cells = vec![None; x.values.len() * y.values.len()];
    for row in rows.iter().filter(|row| row.integrator == integrator) {
        if let (Some(column), Some(line)) = (x.position(&row.values), y.position(&row.values)) {
            cells[column + line * x.values.len()] = Some(row.label);
        }
    }
    GridPanel {
        head: (study.integrators.len() > 1).then(|| integrator.name().to_owned()),
        column: None,
        row: None,
        cells,
    }
}

/// The limit that decides, and that of twelve contacts.
fn curves(study: &Study, integrator: Integrator, x: &GridAxis, y: &GridAxis) -> Vec<PanelCurve> {
    let (across, up) = (nodes(x), nodes(y));
    let theories: Vec<Option<(f64, Theory)>> = across
        .iter()
        .flat_map(|&x_value| up.iter().map(move |&y_value| [x_value, y_value]))
        .map(|values| {
            let scene = study.scene_at(&values, integrator).ok()?;
            Some((scene.time.dt, Theory::of(&scene)))
        })
        .collect();
    let theory = |i: usize, j: usize| theories[j + i * up.len()];
    let shown = |places: &[f64], axis: &GridAxis| -> Vec<f64> {
        places.iter().map(|place| place * axis.factor).collect()
    };
    let of = |limit: fn(&Theory) -> Option<Limit>| -> Vec<Piece> {
        let value = |i: usize, j: usize| {
            let (dt, theory) = theory(i, j)?;
            Some(dt / limit(&theory)?.seconds - 1.0)
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
        PanelCurve {
            pieces: of(|theory| theory.twelve_contacts),
            stroke: Stroke::Dashed,
        },
        PanelCurve {
            pieces: of(|theory| theory.decisive),
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
