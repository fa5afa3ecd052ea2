//! The phase diagram of the numerics: a panel for each integrator, with the theoretical limit of
//! the time step on top.

use super::contour::{Nodes, Piece};
use super::grid::{GridAxis, GridPanel};
use super::panel_curve::{PanelCurve, Stroke};
use super::svg::Svg;
use super::{Figure, PlotError, Source, StudyResult, phase};
use crate::dem::timestep::{Limit, limits};
use crate::record::Program;
use crate::store::StoreError;
use crate::study::comparison::RunRow;
use crate::study::stability::StabilityStudy;
use crate::sweep::{RunScenes, Sweep};
use std::path::Path;

/// What the legend calls the full and the dashed curves.
const LIMITS: [&str; 2] = ["limit of the time step", "advised limit of twelve contacts"];

pub(super) fn figure() -> Figure {
    let description = "where integrators are stable, with the limits of the time step";
    Figure::of_study("stability", description, |study, program| match study {
        StudyResult::Stability(study, rows) => Some(draw(study, rows, program)),
        _ => None,
    })
}

/// Draws the rows of a study.
fn draw(
    study: &StabilityStudy,
    rows: &[Option<RunRow>],
    program: &Program,
) -> Result<Svg, PlotError> {
    let sweep = &study.comparison.sweep;
    let table = study.labels(rows);
    let source = Source {
        sweep,
        refining: None,
        table: &table,
        failures: &[],
        record: &|id| {
            Err(StoreError::content(
                Path::new(id),
                "this figure looks at no records",
            ))
        },
        points: &[],
        times: None,
        program,
    };
    phase::with_diagram("stability", &source, |diagram| {
        let grid = diagram.grid;
        let curves = |panel: &GridPanel| match (grid.variant(panel), grid.axes(panel)) {
            (Some(place), (x, Some(y))) => curves(sweep, place, x, y),
            _ => Vec::new(),
        };
        diagram.draw_with(&source, &curves, LIMITS)
    })
}

/// The limit that decides, and the advised one of a sphere with twelve contacts, which there is not
/// with sub-steps or without contacts.
fn curves(sweep: &Sweep, integrator: f64, x: &GridAxis, y: &GridAxis) -> Vec<PanelCurve> {
    let (across, up) = (nodes(x), nodes(y));
    let at_nodes = across.iter().flat_map(|&x_value| {
        up.iter()
            .map(move |&y_value| [x_value, y_value, integrator])
    });
    let scenes = RunScenes::new(sweep).ok();
    let all: Vec<Option<(f64, Vec<Limit>)>> = at_nodes
        .map(|values| {
            let scene = scenes.as_ref()?.at(&values).ok()?;
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
        PanelCurve {
            pieces: of(|limit| limit.name == "twelve contacts"),
            stroke: Stroke::Dashed,
        },
        PanelCurve {
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
