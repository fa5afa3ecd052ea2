//! Compares the labels and measures of two sweeps.

use super::{Answer, Arguments, Entry};
use crate::cli::columns::{in_columns, written};
use crate::cli::compared::table;
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::{figures, folders, labels};
use phase::classify::{Agreement, LabelRow, LabelTable, MeasureDifference};
use phase::compare::ComparisonRow;
use phase::grid::{Axis, VARIANT, Variant};
use phase::statistics::Estimate;
use phase::sweep::Folder;
use std::path::{Path, PathBuf};

pub(super) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let [one, other] = &arguments.paths[..] else {
        return Err(Failure::refused("give exactly two results folders"));
    };
    let unused = [
        (arguments.measured.window.times.is_some(), "--times"),
        (arguments.measured.scene.is_some(), "--scene"),
    ];
    if let Some((_, option)) = unused.iter().find(|(given, _)| *given) {
        return Err(Failure::refused(format_args!(
            "{option} is for records; folders are compared by their labels"
        )));
    }
    let read = |path: &PathBuf| labels::read(&Folder::new(path));
    let tables = [read(one)?, read(other)?];
    let agreement = Agreement::of(&tables[0], &tables[1]).map_err(|differ| {
        Failure::refused(format_args!(
            "{} and {} cannot be compared: {differ}",
            one.display(),
            other.display()
        ))
    })?;
    let names = [one, other].map(|path| path.display().to_string());
    for (letter, name) in ["A", "B"].iter().zip(&names) {
        console.result(format_args!("{letter}  {name}"));
    }
    let rules = |path| {
        Folder::new(path)
            .read_sweep()
            .ok()
            .map(|it| it.sieves.rules)
    };
    if rules(one) != rules(other) {
        console.note("the rules of their labels and measures differ");
    }
    console.result(sentence(&agreement));
    for (letter, share) in ["A", "B"].iter().zip(agreement.between_seeds) {
        if let Some(share) = share {
            let share = 100.0 * share;
            console.result(format_args!("two seeds of {letter} agree at {share:.1} %"));
        }
    }
    let head = ["", "A", "B", "B - A"].map(str::to_owned);
    let lines = agreement.measures.iter().map(line);
    let lines: Vec<[String; 4]> = std::iter::once(head).chain(lines).collect();
    for line in in_columns(&lines) {
        console.result(line);
    }
    let rows = rows(&agreement);
    if let Some(path) = &arguments.out {
        table::write(path, &rows, &names)?;
        console.file(path);
    }
    if let Some(figure) = &arguments.figure {
        draw_both(&tables, [one, other], figure, console)?;
    }
    console.answer_with_files(&Answer {
        records: names.to_vec(),
        rows: rows
            .iter()
            .map(|row| Entry::of_pairs(row, &agreement))
            .collect(),
    });
    Ok(Exit::Done)
}

/// Draws both phase diagrams in one figure, as if the folders were variants of one sweep.
fn draw_both(
    tables: &[LabelTable; 2],
    folders: [&PathBuf; 2],
    figure: &Path,
    console: &Console,
) -> Result<(), Failure> {
    let [first, second] = folders.map(|path| Folder::new(path).read_sweep());
    let (mut sweep, second) = (first?, second?);
    let scenes = [sweep.scene.clone(), second.scene];
    let variants = folders
        .into_iter()
        .zip(scenes)
        .map(|(path, scene)| Variant {
            name: path
                .file_name()
                .unwrap_or(path.as_os_str())
                .to_string_lossy()
                .into_owned(),
            scale: Vec::new(),
            scene,
        });
    let variants: Vec<Variant> = variants.collect();
    let mut both = tables[0].clone();
    both.axes.push(VARIANT.to_owned());
    both.variants = variants.iter().map(|it| it.name.clone()).collect();
    let rows = tables.iter().enumerate().flat_map(|(place, table)| {
        let with_place = move |row: &LabelRow| LabelRow {
            values: [row.values.as_slice(), &[place as f64]].concat(),
            ..row.clone()
        };
        table.rows.iter().map(with_place)
    });
    both.rows = rows.collect();
    sweep.axes.push(Axis::of_variants(variants));
    sweep.plot.panels = None;
    let drawn = figures::drawn(
        "phase",
        (&Folder::new(folders[0]), &sweep, &both),
        (&[], None),
    )?;
    folders::make_for(figure)?;
    figures::write(&drawn, |end| figure.with_added_extension(end), console)
}

fn sentence(agreement: &Agreement) -> String {
    let (share, [low, high]) = agreement.share();
    let what = match agreement.by_runs {
        true => "runs with the same point and seed",
        false => "points, by the majority label of their seeds",
    };
    let percent = |share: f64| format!("{:.1}", 100.0 * share);
    let alone = match agreement.alone {
        [0, 0] => String::new(),
        [one, other] => format!("; {one} only in A, {other} only in B"),
    };
    format!(
        "{} of {} {what} have equal labels: {} % (95 %: {} to {} %){alone}",
        agreement.equal,
        agreement.pairs,
        percent(share),
        percent(low),
        percent(high),
    )
}

fn line(measure: &MeasureDifference) -> [String; 4] {
    let unit = match measure.unit {
        "" => String::new(),
        unit => format!(" ({unit})"),
    };
    let mean = |value: f64| {
        written(Estimate {
            value,
            half_width: f64::INFINITY,
        })
    };
    [
        format!("{}{unit}", measure.name),
        mean(measure.means[0]),
        mean(measure.means[1]),
        written(measure.difference),
    ]
}

/// The share of equal labels, and the measures.
fn rows(agreement: &Agreement) -> Vec<ComparisonRow> {
    let exact = |value: f64| {
        Some(Estimate {
            value,
            half_width: f64::INFINITY,
        })
    };
    let (share, _) = agreement.share();
    let labels = ComparisonRow {
        name: "share of equal labels".to_owned(),
        unit: String::new(),
        values: vec![exact(1.0), exact(share)],
    };
    let measure = |it: &MeasureDifference| ComparisonRow {
        name: it.name.to_owned(),
        unit: it.unit.to_owned(),
        values: it.means.map(exact).to_vec(),
    };
    let measures = agreement.measures.iter().map(measure);
    std::iter::once(labels).chain(measures).collect()
}

impl Entry {
    /// The same with the interval of paired differences.
    fn of_pairs(row: &ComparisonRow, agreement: &Agreement) -> Self {
        let own = agreement.measures.iter().find(|it| it.name == row.name);
        let half_width = own.map(|it| it.difference.half_width);
        Self {
            difference_half_width: half_width.filter(|it| it.is_finite()),
            ..Self::new(row, false)
        }
    }
}
