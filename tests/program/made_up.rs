//! Sweeps that were never run, their tables, and figures of these.

use phase::classify::{Family, LabelRow, LabelTable, Sieves, Verdict};
use phase::grid::Axis;
use phase::plot::Source;
use phase::record::Program;
use phase::scene::Scene;
use phase::sweep::{PlotSettings, Sweep};

pub(crate) fn axis((key, name): (&str, &str), values: &[f64]) -> Axis {
    Axis::of_numbers(key, name, values.to_vec())
}

pub(crate) fn sweep(title: &str, scene: Scene, axes: Vec<Axis>, seeds: &[u64]) -> Sweep {
    Sweep {
        title: Some(title.to_owned()),
        scene,
        axes,
        seeds: seeds.to_vec(),
        refine: None,
        study: None,
        sieves: Sieves::default(),
        plot: PlotSettings::default(),
    }
}

/// The table of a sweep whose verdicts are given by values and seed.
pub(crate) fn table(
    family: &'static Family,
    sweep: &Sweep,
    verdict: impl Fn(&[f64], u64) -> Option<Verdict>,
) -> LabelTable {
    let mut points = vec![Vec::new()];
    for axis in &sweep.axes {
        points = points
            .into_iter()
            .flat_map(|point: Vec<f64>| {
                let extend = move |value: &f64| [point.clone(), vec![*value]].concat();
                axis.values.iter().map(extend).collect::<Vec<_>>()
            })
            .collect();
    }
    let mut rows = Vec::new();
    for values in points {
        for &seed in &sweep.seeds {
            if let Some(verdict) = verdict(&values, seed) {
                rows.push(LabelRow {
                    id: format!("{:016x}", rows.len()),
                    values: values.clone(),
                    seed,
                    verdict,
                });
            }
        }
    }
    LabelTable {
        family,
        axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
        variants: sweep.variants(),
        rows,
    }
}

/// What figures of a table alone are drawn from.
pub(crate) fn source<'a>(
    sweep: &'a Sweep,
    table: &'a LabelTable,
    program: &'a Program,
) -> Source<'a> {
    Source {
        sweep,
        refining: None,
        table,
        failures: &[],
        record: &|id| panic!("a figure of a table read the record {id}"),
        points: &[],
        times: None,
        program,
    }
}
