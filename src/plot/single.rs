//! Figures of single runs, drawn of one record without a sweep.

use super::{PlotError, Source, Svg, all};
use crate::classify::{Family, Label, Sieves, Verdict, classify};
use crate::classify::{LabelRow, LabelTable};
use crate::record::RunRecord;
use crate::sweep::{PlotSettings, Sweep};

/// Draws the figure `name`, one of those that take points, of a single run of any family.
///
/// # Errors
/// Those of [`draw`](super::draw), but that of another family.
pub fn draw_single(name: &str, record: &RunRecord) -> Result<Svg, PlotError> {
    let scene = record.scene.clone();
    let (id, seed, family) = (scene.identity(), scene.seed, Family::of(&scene));
    let sieves = Sieves::default();
    // A figure of energies needs no label; a scene that no sieve can judge has none.
    let verdict =
        classify(record, &sieves).unwrap_or_else(|_| Verdict::unmeasured(family, Label::UNSETTLED));
    let row = LabelRow {
        id,
        values: Vec::new(),
        seed,
        verdict,
    };
    let sweep = Sweep {
        title: scene.title.clone(),
        axes: Vec::new(),
        seeds: vec![seed],
        scene,
        sieves,
        plot: PlotSettings::default(),
    };
    let table = LabelTable {
        family,
        axes: Vec::new(),
        rows: vec![row],
    };
    let source = Source {
        sweep: &sweep,
        table: &table,
        record: &|_| Ok(record.clone()),
        points: &[],
        program: &record.program,
    };
    let figures = all().into_iter();
    let mut figures = figures.filter(|figure| figure.default_runs().is_some());
    match figures.find(|figure| figure.name() == name) {
        Some(figure) => figure.draw(&source),
        None => Err(PlotError::NoPoints(name.to_owned())),
    }
}
