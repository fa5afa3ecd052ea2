//! Figures of single runs, drawn of records without a sweep.

use super::{PlotError, Source, Svg, all, captions as names, draw_with_options, text};
use crate::classify::{Family, Label, Sieves, Verdict, classify};
use crate::classify::{LabelRow, LabelTable};
use crate::record::RunRecord;
use crate::scene::Scene;
use crate::store::DataSet;
use crate::sweep::{PlotSettings, Sweep};

/// Draws the figure `name`, one of those that take points, of records of one family, one or more.
/// Several are named by the keys in which their scenes differ.
///
/// * `labels`: what names them instead; none for the keys
/// * `times`: first and last time (s) of the states that count, as of [`Source::times`]
/// * `data`: curves of other sources beside them
///
/// # Errors
/// Those of [`draw`](super::draw); [`PlotError::Families`] for records of several families.
pub fn draw_records(
    name: &str,
    records: &[RunRecord],
    times: Option<[f64; 2]>,
    labels: &[String],
    data: &[DataSet],
) -> Result<Svg, PlotError> {
    let Some(first) = records.first() else {
        return Err(PlotError::EmptyTable);
    };
    let family = Family::of(&first.scene);
    if let Some(other) = records.iter().find(|it| Family::of(&it.scene) != family) {
        return Err(PlotError::Families {
            first: family.name,
            other: Family::of(&other.scene).name,
        });
    }
    let sieves = Sieves::default();
    let row = |(index, record): (usize, &RunRecord)| LabelRow {
        id: index.to_string(),
        values: Vec::new(),
        seed: record.scene.seed,
        // A figure of energies needs no label; a scene that no sieve can judge has none.
        verdict: classify(record, &sieves)
            .unwrap_or_else(|_| Verdict::unmeasured(family, Label::UNSETTLED)),
    };
    let table = LabelTable {
        family,
        axes: Vec::new(),
        variants: Vec::new(),
        rows: records.iter().enumerate().map(row).collect(),
    };
    let scenes: Vec<&Scene> = records.iter().map(|it| &it.scene).collect();
    let captions = match labels {
        [] => names::of(&scenes),
        labels => labels.iter().map(|label| vec![label.clone()]).collect(),
    };
    let is_common = |scene: &&Scene| scene.title == first.scene.title;
    let sweep = Sweep {
        title: first
            .scene
            .title
            .clone()
            .filter(|_| scenes.iter().all(is_common)),
        axes: Vec::new(),
        seeds: table.rows.iter().map(|row| row.seed).collect(),
        refine: None,
        scene: first.scene.clone(),
        sieves,
        plot: PlotSettings::default(),
    };
    let record = |id: &str| {
        let index = id
            .parse()
            .ok()
            .filter(|index: &usize| *index < records.len());
        Ok(records[index.unwrap_or(0)].clone())
    };
    let source = Source {
        sweep: &sweep,
        refining: None,
        table: &table,
        record: &record,
        points: &[],
        times,
        captions: &captions,
        data,
        program: &first.program,
    };
    let figures = all().into_iter();
    let mut figures = figures.filter(|figure| figure.default_runs().is_some());
    match figures.find(|figure| figure.name() == name) {
        Some(figure) => draw_with_options(figure, &source),
        None => Err(PlotError::NoPoints(name.to_owned())),
    }
}

/// What names each of several records, without markup: the keys in which their scenes differ.
pub fn captions(records: &[&RunRecord]) -> Vec<Vec<String>> {
    let scenes: Vec<&Scene> = records.iter().map(|it| &it.scene).collect();
    plainly(names::of(&scenes))
}

/// The values of each of several records, without markup, of the keys in which their scenes differ
/// but for those that are `told` otherwise. Nothing where the scenes differ in no other.
pub fn differences(records: &[&RunRecord], told: &[&str]) -> Vec<Vec<String>> {
    let scenes: Vec<&Scene> = records.iter().map(|it| &it.scene).collect();
    plainly(names::differences(&scenes, told))
}

fn plainly(captions: Vec<Vec<String>>) -> Vec<Vec<String>> {
    let plainly = |parts: Vec<String>| parts.iter().map(|it| text::plain(it)).collect();
    captions.into_iter().map(plainly).collect()
}
