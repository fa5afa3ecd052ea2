//! Thresholds that a page offers to move: the labels that follow are those of `phase classify`.

use super::{read, sieved};
use crate::rule::sweeps::cells;
use crate::support::{TinySweep, Workplace, silo_file};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Seed of the thresholds that are tried.
const SEED: u64 = 49;

/// The label of each run, by the identity of its record, as `src/report/page/README.md` says that
/// it follows from a document.
fn labels(section: &Value, thresholds: &BTreeMap<String, f64>) -> BTreeMap<String, String> {
    let rules = &section["rules"];
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let stored = list(&section["runs"]["label"]);
    let ids = list(&section["runs"]["id"]);
    let value = |comparison: &Value, run: usize| -> Option<f64> {
        if let Some(name) = comparison["measure"].as_str() {
            let measures = list(&section["measures"]);
            let measure = measures.iter().find(|it| it["name"] == name).unwrap();
            return measure["values"][run].as_f64();
        }
        let key = comparison["by"]["key"].as_str().unwrap();
        let known = list(&rules["thresholds"]);
        let threshold = known.iter().find(|it| it["key"] == key).unwrap();
        let stops = list(&threshold["stops"]);
        let stop = stops
            .iter()
            .position(|it| it.as_f64() == Some(thresholds[key]));
        comparison["by"]["columns"][stop.unwrap()][run].as_f64()
    };
    let compares = |comparison: &Value, run: usize| {
        let threshold = match comparison["threshold"].as_str() {
            Some(key) => thresholds[key],
            None => comparison["threshold"].as_f64().unwrap(),
        };
        let holds = |value: f64| match comparison["order"].as_str().unwrap() {
            ">=" => value >= threshold,
            ">" => value > threshold,
            "<=" => value <= threshold,
            "<" => value < threshold,
            other => panic!("{other}"),
        };
        value(comparison, run).is_some_and(holds)
    };
    let name = |label: &Value| {
        let label = &section["labels"][label.as_u64().unwrap() as usize];
        label["name"].as_str().unwrap().to_owned()
    };
    let label = |run: usize| {
        if list(&rules["fixed"]).contains(&stored[run]) {
            return name(&stored[run]);
        }
        let holds = |rule: &Value| {
            let is_stored = rule.get("stored").is_none_or(|it| it[run] == 1);
            is_stored
                && list(&rule["comparisons"])
                    .iter()
                    .all(|it| compares(it, run))
        };
        let rule = list(&rules["list"]).into_iter().find(holds);
        name(&rule.map_or(rules["otherwise"].clone(), |rule| rule["label"].clone()))
    };
    let runs = 0..ids.len();
    runs.map(|run| (ids[run].as_str().unwrap().to_owned(), label(run)))
        .collect()
}

/// The thresholds as they are stored.
fn stored(section: &Value) -> BTreeMap<String, f64> {
    let thresholds = section["rules"]["thresholds"].as_array().unwrap();
    let pair = |it: &Value| {
        (
            it["key"].as_str().unwrap().to_owned(),
            it["value"].as_f64().unwrap(),
        )
    };
    thresholds.iter().map(pair).collect()
}

/// The labels of the table of a folder.
fn in_table(place: &Workplace, folder: &str) -> BTreeMap<String, String> {
    let rows = cells(place, &format!("{folder}/labels.csv"), &["id", "label"]);
    rows.into_iter()
        .map(|row| (row[0].clone(), row[1].clone()))
        .collect()
}

/// Values within the range of each threshold, at a stop, or near the evidence of a run.
fn drawn(section: &Value, random: &mut Pcg64) -> BTreeMap<String, f64> {
    let thresholds = section["rules"]["thresholds"].as_array().unwrap();
    let mut value = |it: &Value| -> f64 {
        let number = |name: &str| it[name].as_f64().unwrap();
        if let Some(stops) = it.get("stops").and_then(Value::as_array) {
            let stop = (random.random::<f64>() * stops.len() as f64) as usize;
            return stops[stop].as_f64().unwrap();
        }
        let value = number("low") + (number("high") - number("low")) * random.random::<f64>();
        match it.get("is_whole") {
            Some(_) => value.round(),
            None => value,
        }
    };
    let pair = |it: &Value| (it["key"].as_str().unwrap().to_owned(), value(it));
    thresholds.iter().map(pair).collect()
}

/// The tables of a sweep file with thresholds of sieves, as a page gives them to copy.
fn tables(thresholds: &BTreeMap<String, f64>) -> String {
    let mut tables: Map<String, Value> = Map::new();
    for (key, value) in thresholds {
        let (table, key) = key.rsplit_once('.').unwrap();
        let entry = tables
            .entry(table)
            .or_insert_with(|| Value::Object(Map::new()));
        let number = match key {
            "least" => Value::from(*value as u64),
            _ => Value::from(*value),
        };
        entry
            .as_object_mut()
            .unwrap()
            .insert(key.to_owned(), number);
    }
    let text = |(table, keys): (&String, &Value)| {
        let keys = keys.as_object().unwrap().iter();
        let lines = keys.map(|(key, value)| format!("{key} = {value}\n"));
        format!("[{table}]\n{}", lines.collect::<String>())
    };
    tables.iter().map(text).collect()
}

/// A sweep file whose sieves have these thresholds.
fn edited(text: &str, thresholds: &BTreeMap<String, f64>) -> String {
    let mut sweep: toml::Table = toml::from_str(text).unwrap();
    let changes: toml::Table = toml::from_str(&tables(thresholds)).unwrap();
    let sieves = sweep
        .entry("sieves")
        .or_insert_with(|| toml::Table::new().into());
    for (sieve, keys) in changes["sieves"].as_table().unwrap() {
        let own = sieves.as_table_mut().unwrap();
        let own = own
            .entry(sieve)
            .or_insert_with(|| toml::Table::new().into());
        own.as_table_mut()
            .unwrap()
            .extend(keys.as_table().unwrap().clone());
    }
    toml::to_string(&sweep).unwrap()
}

/// Moves thresholds of a page at random, and classifies the folder by the same ones, which `edit`
/// writes into the sweep file. Returns how often labels changed.
fn changes(
    place: &Workplace,
    text: &str,
    edit: impl Fn(&BTreeMap<String, f64>) -> String,
    trials: usize,
) -> usize {
    place.write("sweep.toml", text);
    place.phase(&["sweep", "sweep.toml", "--no-plot"]).code(0);
    place.phase(&["report", "results/sweep"]).code(0);
    let document = read(place, "results/sweep/report.html");
    let section = &document["sections"][0];
    let before = in_table(place, "results/sweep");
    assert_eq!(labels(section, &stored(section)), before);

    let mut random = Pcg64::seed_from_u64(SEED);
    let mut changed = 0;
    for _ in 0..trials {
        let thresholds = drawn(section, &mut random);
        place.write("edited.toml", &edit(&thresholds));
        place
            .phase(&["classify", "results/sweep", "--sweep", "edited.toml"])
            .code(0);
        let expected = in_table(place, "results/sweep");
        assert_eq!(labels(section, &thresholds), expected, "{thresholds:?}");
        changed += usize::from(expected != before);
    }
    changed
}

#[test]
fn thresholds_of_a_tank_label_as_classify_does() {
    let text = sieved().text();
    let changed = changes(&Workplace::new(), &text, |it| edited(&text, it), 16);
    assert!(changed > 4, "{changed}");
}

#[test]
fn thresholds_of_a_silo_label_as_classify_does() {
    let place = Workplace::new();
    place.write("silo.toml", &silo_file());
    let text = "scene = \"silo.toml\"\n[[axis]]\nkey = \"geometry.opening\"\n\
                values = [0.1, 0.15, 0.2]\n[seeds]\nlist = [1, 2]\n\
                [sieves.flowing]\nwindow = 30.0\n[sieves.arching]\nwindow = 30.0\n";
    changes(&place, text, |it| edited(text, it), 6);
}

/// The numbers of rules are sliders too; of a rule with several comparisons the page knows the
/// verdict.
#[test]
fn thresholds_of_rules_label_as_classify_does() {
    let text = |fast: f64, high: f64| {
        let rules = format!(
            "[[label]]\nname = \"fast\"\nwhen = \"last(rotation) > {fast}\"\n\
             [[label]]\nname = \"both\"\n\
             when = \"last(rotation) > 1e-3 and max(height_max) > 0.04\"\n\
             [[label]]\nname = \"high\"\nwhen = \"mean(height_mean) >= {high}\"\n\
             over = {{ last = 1.0 }}\n"
        );
        let sweep = TinySweep {
            more: rules,
            ..TinySweep::default()
        };
        sweep.text()
    };
    let edit = |it: &BTreeMap<String, f64>| text(it["label.fast"], it["label.high"]);
    let place = Workplace::new();
    let changed = changes(&place, &text(0.5, 0.0045), edit, 12);
    assert!(changed > 3, "{changed}");
}
