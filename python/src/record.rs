//! The record of one run as a data set.

use crate::error::Failure;
use crate::table::{Attribute, Table, Values, Variable};
use crate::watch::watched;
use phase::classify::{Sieves, Verdict, classify};
use phase::record::{Outcome, RunRecord};
use phase::simulation::Snapshot;
use phase::store;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// The record of one run.
#[pyclass(frozen, module = "phase._lib")]
pub(crate) struct Record(pub(crate) Arc<RunRecord>);

#[pymethods]
impl Record {
    /// Variables, coordinates and attributes of its data set.
    fn table(&self, py: Python<'_>) -> PyResult<Table> {
        watched(py, None, |_| table_of(&self.0))
    }
}

/// Reads a record.
#[pyfunction]
pub(crate) fn read_record(py: Python<'_>, path: PathBuf) -> PyResult<Record> {
    watched(py, None, |_| {
        let record = store::read_record(&path);
        let record = record.map_err(|error| Failure::from(error).of(&path))?;
        Ok(Record(Arc::new(record)))
    })
}

/// Whether a file is a record that can be read.
#[pyfunction]
pub(crate) fn is_record(py: Python<'_>, path: PathBuf) -> PyResult<bool> {
    watched(py, None, |_| Ok(store::read_record_header(&path).is_ok()))
}

fn table_of(record: &RunRecord) -> Result<Table, Failure> {
    let mut table = Table {
        attributes: attributes_of(record)?,
        ..Table::default()
    };
    add_observations(&mut table, record);
    add_spheres(&mut table, record);
    add_states(&mut table, record.states().all());
    Ok(table)
}

/// What is known of the run as a whole, its label among it.
fn attributes_of(record: &RunRecord) -> Result<Vec<(&'static str, Attribute)>, Failure> {
    let scene = &record.scene;
    let text = serde_json::to_string(scene).map_err(Failure::failed)?;
    let outcome = match &record.outcome {
        Outcome::Completed => "completed".to_owned(),
        Outcome::Unstable(instability) => format!("unstable: {instability}"),
    };
    let title = scene.title.clone();
    let mut attributes: Vec<(&'static str, Attribute)> = Vec::new();
    attributes.extend(title.map(|title| ("title", Attribute::Text(title))));
    attributes.extend([
        ("identity", Attribute::Text(scene.identity())),
        ("seed", Attribute::Integer(scene.seed.cast_signed())),
        ("outcome", Attribute::Text(outcome)),
        ("scene", Attribute::Text(text)),
        (
            "program_version",
            Attribute::Text(record.program.version.clone()),
        ),
        (
            "program_commit",
            Attribute::Text(record.program.commit.clone()),
        ),
        ("cpu_seconds", Attribute::Number(record.cpu_seconds)),
    ]);
    for milestone in &record.milestones {
        attributes.push((milestone.kind.name(), Attribute::Number(milestone.time)));
    }
    // Sieves that cannot judge a scene leave its runs without a label.
    if let Ok(verdict) = classify(record, &Sieves::default()) {
        attributes.extend(evidence_of(&verdict));
    }
    Ok(attributes)
}

/// Label, code and evidence of a run.
fn evidence_of(verdict: &Verdict) -> Vec<(&'static str, Attribute)> {
    let mut evidence = vec![
        ("label", Attribute::from(verdict.label.name)),
        ("code", Attribute::Integer(verdict.label.code.into())),
    ];
    let measures = verdict.family.measures().zip(&verdict.values);
    let known = measures.filter_map(|(measure, value)| Some((measure.name, (*value)?)));
    evidence.extend(known.map(|(name, value)| (name, Attribute::Number(value))));
    evidence
}

fn add_observations(table: &mut Table, record: &RunRecord) {
    let observations = &record.observations;
    let frames = ("time", observations.frames());
    let time = Variable::coordinate("time", Values::Double(observations.time.clone()));
    let time = time.of(record.scene.unit_of_time(), "Time of each frame");
    table.coordinates.push(time);
    for series in observations.scalars() {
        let values = Values::Single(series.values.to_vec());
        let variable = Variable::new(series.name, &[frames], values);
        table
            .variables
            .push(variable.of(series.unit, series.description));
    }
    let (profile, rising) = (&observations.profile, &observations.rising);
    if !profile.is_empty() {
        let dimensions = [frames, ("bin", profile.ncols())];
        let values = Values::Single(profile.iter().copied().collect());
        let variable = Variable::new("profile", &dimensions, values);
        let description = "Height of the highest centre in each radial bin, inner bin first";
        table.variables.push(variable.of("m", description));
    }
    if !rising.is_empty() {
        let output = &record.scene.output;
        let extents = rising.shape();
        let dimensions = [
            frames,
            ("rise_radius", extents[1]),
            ("rise_speed", extents[2]),
        ];
        let values = Values::Integer(rising.iter().map(|it| i64::from(*it)).collect());
        let variable = Variable::new("rising", &dimensions, values);
        let description = "Number of spheres near the axis that rise faster than the mean";
        table.variables.push(variable.of("1", description));
        let radii = Values::Double(output.rise_radii.clone());
        let radii = Variable::coordinate("rise_radius", radii);
        table
            .coordinates
            .push(radii.of("1", "Distance from the axis over the tank radius"));
        let speeds = Values::Double(output.rise_speeds.clone());
        let speeds = Variable::coordinate("rise_speed", speeds);
        table
            .coordinates
            .push(speeds.of("1/s", "Rise speed in radii per second"));
    }
}

fn add_spheres(table: &mut Table, record: &RunRecord) {
    if record.radius.is_empty() {
        return;
    }
    let spheres = [("sphere", record.radius.len())];
    let radius = Variable::new("radius", &spheres, Values::Double(record.radius.clone()));
    table
        .variables
        .push(radius.of("m", "Radius of every sphere"));
    let mass = Variable::new("mass", &spheres, Values::Double(record.mass.clone()));
    table.variables.push(mass.of("kg", "Mass of every sphere"));
}

/// The finest states that the record holds, if it holds any.
fn add_states(table: &mut Table, states: &[Snapshot]) {
    let Some(first) = states.first() else { return };
    let components = Values::Text(["x", "y", "z"].map(str::to_owned).to_vec());
    table
        .coordinates
        .push(Variable::coordinate("component", components));
    let times = Values::Double(states.iter().map(|state| state.time).collect());
    let times = Variable::coordinate("snapshot", times);
    table
        .coordinates
        .push(times.of("s", "Time of each state of the spheres"));
    let shape = [
        ("snapshot", states.len()),
        ("sphere", first.position.nrows()),
        ("component", 3),
    ];
    let mut add = |name: &str, unit: &str, description: &str, values: Vec<f64>| {
        let variable = Variable::new(name, &shape, Values::Double(values));
        table.variables.push(variable.of(unit, description));
    };
    let positions = states.iter().flat_map(|state| &state.position);
    add(
        "position",
        "m",
        "Centres of the spheres",
        positions.copied().collect(),
    );
    let velocities = states.iter().flat_map(|state| &state.velocity);
    add(
        "velocity",
        "m/s",
        "Velocities of the spheres",
        velocities.copied().collect(),
    );
    // Scenes without rotation have no spins.
    if !first.spin.is_empty() {
        let spins = states.iter().flat_map(|state| &state.spin);
        add(
            "spin",
            "rad/s",
            "Spins of the spheres",
            spins.copied().collect(),
        );
    }
}
