//! Inputs of a comparison: records, files of other programs, tables of earlier comparisons.

pub(super) mod table;

use crate::cli::exit::Failure;
use crate::cli::runs;
use phase::classify::{DRAINAGE, Family, Measure, Sieves, classify};
use phase::compare::{ComparisonRow, DrainageComparison};
use phase::plot;
use phase::record::RunRecord;
use phase::scene::Units;
use phase::statistics::Estimate;
use std::path::{Path, PathBuf};
use table::Column;

/// A file that is compared.
pub(in crate::cli) enum Input {
    /// A run.
    Run(PathBuf, Box<RunRecord>),
    /// The columns of a table.
    Table(Vec<Column>),
}

/// Reads all files. Files of other programs take the given scene, or else the first record's.
pub(in crate::cli) fn read(paths: &[PathBuf], scene: Option<&Path>) -> Result<Vec<Input>, Failure> {
    let is_table = |path: &&PathBuf| {
        path.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("csv"))
    };
    let of_runs: Vec<PathBuf> = paths.iter().filter(|it| !is_table(it)).cloned().collect();
    let mut records = runs::read(&of_runs, scene)?.into_iter();
    let mut inputs = Vec::new();
    for path in paths {
        match is_table(&path) {
            true => inputs.push(Input::Table(table::read(path)?)),
            false => {
                let record = records.next().map(Box::new);
                inputs.extend(record.map(|record| Input::Run(path.clone(), record)));
            }
        }
    }
    Ok(inputs)
}

/// The numbers of all inputs, one column for each record: for drainages measurements on their
/// states within `times`, for other runs the measures of their sieves.
pub(in crate::cli) fn columns(
    inputs: &[Input],
    times: Option<[f64; 2]>,
) -> Result<Vec<Column>, Failure> {
    let of_runs = inputs.iter().filter_map(|input| match input {
        Input::Run(path, record) => Some((path, &**record)),
        Input::Table(_) => None,
    });
    let (paths, records): (Vec<&PathBuf>, Vec<&RunRecord>) = of_runs.unzip();
    if times.is_some() && records.is_empty() {
        return Err(Failure::refused(
            "--times is for records; compare the records again instead of this table",
        ));
    }
    let family = records.first().map(|record| Family::of(&record.scene));
    let mut of_runs = match family {
        Some(family) if family.measures().count() > 0 && family != &DRAINAGE => {
            of_family(family, &paths, &records, times)?
        }
        _ => of_drainages(&paths, &records, times)?,
    }
    .into_iter();
    let mut columns = Vec::new();
    for input in inputs {
        match input {
            Input::Run(..) => columns.extend(of_runs.next()),
            Input::Table(table) => columns.extend(table.iter().map(|it| Column {
                name: it.name.clone(),
                values: it.values.clone(),
                window: None,
            })),
        }
    }
    Ok(columns)
}

/// The units of the drainages. Numbers of two units are not compared.
pub(in crate::cli) fn units(inputs: &[Input]) -> Result<Units, Failure> {
    let scenes = inputs.iter().filter_map(|input| match input {
        Input::Run(path, record) if Family::of(&record.scene) == &DRAINAGE => {
            Some((path, record.scene.units()))
        }
        Input::Run(..) | Input::Table(_) => None,
    });
    let scenes: Vec<(&PathBuf, Units)> = scenes.collect();
    let Some((first, units)) = scenes.first() else {
        return Ok(Units::Si);
    };
    match scenes.iter().find(|(_, other)| other != units) {
        None => Ok(*units),
        Some((path, other)) => Err(Failure::refused(format_args!(
            "its scene is in units {}, the scene of {} in units {}; compare runs in the same units",
            other.description(),
            first.display(),
            units.description()
        ))
        .at(path)),
    }
}

/// The columns of drainages.
fn of_drainages(
    paths: &[&PathBuf],
    records: &[&RunRecord],
    times: Option<[f64; 2]>,
) -> Result<Vec<Column>, Failure> {
    let comparison = DrainageComparison::new(records, times).map_err(|(place, needs)| {
        let file = paths[place].display();
        Failure::refused(format_args!(
            "{file}: a comparison of drainages needs {needs}"
        ))
    })?;
    let named = names(records, paths).into_iter().enumerate();
    let columns = named.map(|(run, name)| {
        let value = |row: &ComparisonRow| ([row.name.clone(), row.unit.clone()], row.values[run]);
        Column {
            name,
            values: comparison.rows.iter().map(value).collect(),
            window: Some(comparison.windows[run]),
        }
    });
    Ok(columns.collect())
}

/// The columns of runs of another family, with their labels.
fn of_family(
    family: &'static Family,
    paths: &[&PathBuf],
    records: &[&RunRecord],
    times: Option<[f64; 2]>,
) -> Result<Vec<Column>, Failure> {
    if times.is_some() {
        return Err(Failure::refused(format_args!(
            "--times is for drainages; the sieves of a {} use the whole run",
            family.name
        )));
    }
    let named = names(records, paths).into_iter().zip(records);
    let column = |((name, record), path): ((String, &&RunRecord), &&PathBuf)| {
        let refused = |error: String| Failure::refused(error).at(path);
        let own = Family::of(&record.scene);
        if own != family {
            return Err(refused(format!(
                "a run of a {}, but the first one is a run of a {}; compare runs of one kind",
                own.name, family.name
            )));
        }
        // What all runs of the family have, and what the rules of its scene measure besides.
        let of_family = Sieves::without_rules();
        let verdicts = [of_family, Sieves::default()].map(|sieves| classify(record, &sieves));
        let [of_family, of_rules] = verdicts;
        let of_family = of_family.map_err(|error| refused(error.to_string()))?;
        let verdict = of_rules.map_err(|error| refused(error.to_string()))?;
        let own = verdict.family.measures();
        let own = own.filter(|measure| of_family.family.measures().all(|it| it != *measure));
        let measures = family.measures().chain(own);
        let measures = measures.filter(|measure| !measure.is_evidence);
        let exact = |value: f64| Estimate {
            value,
            half_width: f64::INFINITY,
        };
        let value = |measure: &Measure| {
            let key = [measure.name.replace('_', " "), measure.unit.to_owned()];
            let value = of_family.value(measure.name);
            let value = value.or_else(|| verdict.value(measure.name));
            (key, value.map(exact))
        };
        Ok(Column {
            name: format!("{name}: {}", verdict.label.name),
            values: measures.map(value).collect(),
            window: None,
        })
    };
    named.zip(paths).map(column).collect()
}

/// A record by its file, and by what differs.
fn names(records: &[&RunRecord], paths: &[&PathBuf]) -> Vec<String> {
    let captions = plot::captions(records).into_iter();
    let named = paths.iter().zip(captions);
    let name = |(path, parts): (&&PathBuf, Vec<String>)| {
        let file = [path.display().to_string()];
        file.into_iter().chain(parts).collect::<Vec<_>>().join(", ")
    };
    named.map(name).collect()
}

/// The columns as rows, one for each quantity that any of them has.
pub(in crate::cli) fn rows(columns: &[Column]) -> Vec<ComparisonRow> {
    let mut quantities: Vec<&[String; 2]> = Vec::new();
    for (quantity, _) in columns.iter().flat_map(|it| &it.values) {
        if !quantities.contains(&quantity) {
            quantities.push(quantity);
        }
    }
    let value = |column: &Column, quantity: &[String; 2]| {
        let own = column.values.iter().find(|(it, _)| it == quantity);
        own.and_then(|(_, value)| *value)
    };
    let row = |quantity: &[String; 2]| ComparisonRow {
        name: quantity[0].clone(),
        unit: quantity[1].clone(),
        values: columns.iter().map(|it| value(it, quantity)).collect(),
    };
    quantities.into_iter().map(row).collect()
}
