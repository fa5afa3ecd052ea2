//! Studies on a page, from the tables of their folders.

mod table;

use super::document::{
    AblationSection, AccuracySection, AxisOfPage, EffectEntry, FurtherColumn, MeasureEntry,
    QuantityWithUnit, RunColumns, Section, SettingEntry, SweepSection, ViewEntry,
};
use super::sweep::{by_axis, label_entry};
use crate::classify::{Family, Measure, NUMERICS};
use crate::store::StoreError;
use serde_json::Value;
use std::path::Path;
use table::Table;

/// The file of a study's folder from which a page follows, and how.
type OfFile = (&'static str, fn(&Table) -> Vec<Section>);

/// By kind of study; the table of runs is in every folder, and says most of one of stability.
const FILES: [OfFile; 3] = [
    ("accuracy.csv", accuracy),
    ("ablation.csv", ablation),
    ("runs.csv", stability),
];

/// The sections of the study in a folder; none if it holds none.
///
/// # Errors
/// A table that cannot be read, or lacks a column.
pub fn study(folder: &Path) -> Result<Option<Vec<Section>>, StoreError> {
    for (name, sections) in FILES {
        let path = folder.join(name);
        if path.is_file() {
            let table = Table::read(&path)?;
            return match sections(&table) {
                sections if sections.is_empty() => Err(StoreError::content(
                    &path,
                    "it has no rows that a page can show",
                )),
                sections => Ok(Some(sections)),
            };
        }
    }
    Ok(None)
}

/// Errors over processor time: one section for each error.
fn accuracy(table: &Table) -> Vec<Section> {
    let section = |error: &str, quantity: String, ends: Option<[String; 2]>| {
        let settings = (0..table.rows()).filter_map(|row| {
            let end = |place: usize| table.number(row, &ends.as_ref()?[place]);
            Some(SettingEntry {
                name: table.text(row, "setting").to_owned(),
                method: Some(table.text(row, "method").to_owned()).filter(|_| row > 0),
                work: table.number(row, "cpu_seconds")?,
                error: table.number(row, error)?,
                low: end(0),
                high: end(1),
                is_base: row == 0,
            })
        });
        let settings: Vec<SettingEntry> = settings.collect();
        let known = |name: &str, quantity: &str| FurtherColumn {
            quantity: quantity.to_owned(),
            unit: String::new(),
            values: (0..table.rows())
                .filter(|row| {
                    let number = |name| table.number(*row, name);
                    number("cpu_seconds").is_some() && number(error).is_some()
                })
                .map(|row| table.number(row, name))
                .collect(),
        };
        (!settings.is_empty()).then(|| {
            Section::Accuracy(AccuracySection {
                title: quantity.clone(),
                work: QuantityWithUnit::new("processor time of a run", "s"),
                error: QuantityWithUnit::new(&quantity, ""),
                columns: vec![
                    known("runs", "runs"),
                    known("unstable", "unstable runs"),
                    known("force_evaluations", "force evaluations of a run"),
                ],
                settings,
            })
        })
    };
    if table.has("chance") {
        let ends = ["chance_low", "chance_high"].map(str::to_owned);
        let quantity = "chance that a label is another".to_owned();
        return section("chance", quantity, Some(ends))
            .into_iter()
            .collect();
    }
    let errors = table
        .names()
        .filter_map(|name| Some((name, name.strip_prefix("error_")?)));
    let of_error = |(name, of): (&str, &str)| {
        let quantity = match of.parse::<usize>() {
            Ok(time) => format!("error at time {time} of the study"),
            Err(_) => format!("error of {}", of.replace('_', " ")),
        };
        section(name, quantity, None)
    };
    errors.filter_map(of_error).collect()
}

/// What changes without each effect.
fn ablation(table: &Table) -> Vec<Section> {
    let effects = (0..table.rows()).filter_map(|row| {
        let number = |name: &str| table.number(row, name);
        Some(EffectEntry {
            name: table.text(row, "without").to_owned(),
            verdict: table.text(row, "verdict").to_owned(),
            changed: number("excess")?,
            low: number("excess_low")?,
            high: number("excess_high")?,
            time_ratio: number("time_ratio")?,
        })
    });
    let effects: Vec<EffectEntry> = effects.collect();
    let section = Section::Ablation(AblationSection {
        title: "Which effects decide".to_owned(),
        effects,
    });
    vec![section]
}

/// Where integrators are stable: a diagram, as of a sweep, with the integrators as an axis.
fn stability(table: &Table) -> Vec<Section> {
    let names: Vec<&str> = table.names().collect();
    let place = |name: &str| names.iter().position(|it| *it == name);
    let (Some(seed), Some("setting")) = (place("seed"), names.first().copied()) else {
        return Vec::new();
    };
    let family: &Family = &NUMERICS;
    let labels = family.labels();
    let label_of = |row: usize| {
        labels
            .iter()
            .position(|it| it.name == table.text(row, "label"))
    };
    let rows: Vec<usize> = (0..table.rows())
        .filter(|row| label_of(*row).is_some())
        .collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let mut axes: Vec<AxisOfPage> = names[1..seed]
        .iter()
        .map(|name| {
            let values = rows.iter().filter_map(|row| table.number(*row, name));
            AxisOfPage::of_values(name, values.collect())
        })
        .collect();
    let mut settings: Vec<String> = Vec::new();
    for row in &rows {
        let setting = table.text(*row, "setting");
        if !settings.iter().any(|it| it == setting) {
            settings.push(setting.to_owned());
        }
    }
    let of_setting = |row: usize| {
        settings
            .iter()
            .position(|it| it == table.text(row, "setting"))
    };
    let places = rows.iter().map(|row| {
        let numbers = axes.iter().map(|axis| {
            let value = table.number(*row, &axis.name);
            axis.values
                .iter()
                .position(|it| Some(*it) == value)
                .unwrap_or(0)
        });
        numbers.chain(of_setting(*row)).collect()
    });
    let places = by_axis(places);
    axes.push(AxisOfPage::of_words("setting", settings));
    let measures = family.measures().filter(|it| table.has(it.name));
    let measure = |measure: &Measure| {
        let values = rows.iter().map(|row| table.number(*row, measure.name));
        MeasureEntry::new(measure, values.collect())
    };
    let view = ViewEntry {
        x: 0,
        y: if axes.len() > 2 { 1 } else { -1 },
    };
    let section = SweepSection {
        title: "Where integrators are stable".to_owned(),
        runs: RunColumns {
            label: rows.iter().filter_map(|row| label_of(*row)).collect(),
            places,
            seed: rows
                .iter()
                .map(|row| Value::from(table.text(*row, "seed")))
                .collect(),
            id: rows
                .iter()
                .map(|row| table.text(*row, "id").to_owned())
                .collect(),
            steady: Vec::new(),
        },
        measures: measures.map(measure).collect(),
        labels: labels.iter().map(label_entry).collect(),
        axes,
        view,
        ..SweepSection::default()
    };
    vec![Section::Sweep(Box::new(section))]
}
