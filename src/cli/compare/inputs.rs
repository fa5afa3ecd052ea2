//! What is compared: records, files of other programs, tables of earlier comparisons.

use super::super::exit::Failure;
use super::table;
use phase::compare::{Comparison, Row};
use phase::plot;
use phase::record::RunRecord;
use phase::replay::replay_states;
use phase::scene::Scene;
use phase::statistics::Estimate;
use phase::store;
use std::path::{Path, PathBuf};

/// A file that is compared.
pub(super) enum Input {
    /// A run.
    Run(PathBuf, Box<RunRecord>),
    /// The columns of a table.
    Table(Vec<Column>),
}

/// The numbers of a record: name and unit of each, and its value.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) values: Vec<([String; 2], Option<Estimate>)>,
}

/// Reads all files. Those of other programs take the scene that is given, or that of the first
/// record.
pub(super) fn read(paths: &[PathBuf], scene: Option<&Path>) -> Result<Vec<Input>, Failure> {
    let mut scene = match scene {
        Some(path) => Some(Scene::load(path).map_err(Failure::refused)?),
        None => None,
    };
    let mut inputs: Vec<Option<Input>> = paths.iter().map(|_| None).collect();
    for (input, path) in inputs.iter_mut().zip(paths) {
        match kind(path) {
            Kind::Record => {
                let record = store::read_record(path).map_err(Failure::refused)?;
                scene.get_or_insert_with(|| record.scene.clone());
                *input = Some(Input::Run(path.clone(), Box::new(record)));
            }
            Kind::Table => *input = Some(Input::Table(table::read(path)?)),
            Kind::States => {}
        }
    }
    for (input, path) in inputs.iter_mut().zip(paths) {
        if input.is_some() {
            continue;
        }
        let scene = scene.as_ref().ok_or_else(|| {
            Failure::refused(format_args!(
                "{}: a file of another program does not say its box; give a record beside it, or \
                 its scene with `--scene`",
                path.display()
            ))
        })?;
        let states = store::read_states(path).map_err(Failure::refused)?;
        let record = replay_states(&states, scene)
            .map_err(|error| Failure::refused(format_args!("{}: {error}", path.display())))?;
        *input = Some(Input::Run(path.clone(), Box::new(record)));
    }
    Ok(inputs.into_iter().flatten().collect())
}

enum Kind {
    Record,
    Table,
    States,
}

fn kind(path: &Path) -> Kind {
    let end = path.extension().and_then(|it| it.to_str());
    match end {
        Some("csv") => Kind::Table,
        Some("xyz" | "extxyz" | "dump" | "lammpstrj") => Kind::States,
        Some("pvd" | "series" | "vtk" | "vtp" | "vtu") => Kind::States,
        _ => Kind::Record,
    }
}

/// The numbers of all inputs, one column for each record.
pub(super) fn columns(inputs: &[Input], times: Option<[f64; 2]>) -> Result<Vec<Column>, Failure> {
    let runs = inputs.iter().filter_map(|input| match input {
        Input::Run(path, record) => Some((path, &**record)),
        Input::Table(_) => None,
    });
    let (paths, records): (Vec<&PathBuf>, Vec<&RunRecord>) = runs.unzip();
    let comparison = Comparison::new(&records, times).map_err(|(place, needs)| {
        let file = paths[place].display();
        Failure::refused(format_args!(
            "{file}: a comparison of drainages needs {needs}"
        ))
    })?;
    let mut of_runs = names(&records, &paths)
        .into_iter()
        .enumerate()
        .map(|(run, name)| {
            let value = |row: &Row| ([row.name.clone(), row.unit.clone()], row.values[run]);
            Column {
                name,
                values: comparison.rows.iter().map(value).collect(),
            }
        });
    let mut columns = Vec::new();
    for input in inputs {
        match input {
            Input::Run(..) => columns.extend(of_runs.next()),
            Input::Table(table) => columns.extend(table.iter().map(|it| Column {
                name: it.name.clone(),
                values: it.values.clone(),
            })),
        }
    }
    Ok(columns)
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
pub(super) fn rows(columns: &[Column]) -> Vec<Row> {
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
    let row = |quantity: &[String; 2]| Row {
        name: quantity[0].clone(),
        unit: quantity[1].clone(),
        values: columns.iter().map(|it| value(it, quantity)).collect(),
    };
    quantities.into_iter().map(row).collect()
}
