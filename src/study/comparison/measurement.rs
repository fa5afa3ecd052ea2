//! What a comparison measures of a run.

use crate::classify::{
    ClassifyError, Family, Label, Measure, NUMERICS, Sieves, classify, judge_numerics,
    judge_numerics_again,
};
use crate::observe::Snapshot;
use crate::record::{Outcome, RunRecord};
use crate::scene::Scene;
use serde::Serialize;

/// Most spheres of which each velocity is compared by itself.
const FEW: usize = 8;

/// What is measured of every run of a comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measurement {
    /// The label that sieves give it, and the order parameters of its family; energies and moments
    /// of the motion at the end, of a family that has none.
    States(Box<Sieves>),
    /// Energies and moments of the motion at these times (s).
    Motion(Vec<f64>),
    /// What became of it numerically; with the largest gain of energy that is stable.
    Numerics(f64),
}

/// A measured quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quantity {
    /// Name, as of its column.
    pub name: String,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// Place among the times at which it is measured, if it is measured at times.
    pub time: Option<usize>,
}

/// What was measured of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its label.
    pub label: Label,
    /// Values in the order of the quantities; none where one is undefined.
    pub values: Vec<Option<f64>>,
}

impl Measurement {
    /// The family of runs of a scene, whose labels they have.
    pub(super) fn family(&self, scene: &Scene) -> &'static Family {
        match self {
            Self::States(sieves) => sieves.family(scene),
            Self::Motion(_) => Family::of(scene),
            Self::Numerics(_) => &NUMERICS,
        }
    }

    /// What is measured of runs of a scene.
    pub fn quantities(&self, scene: &Scene) -> Vec<Quantity> {
        match self {
            Self::States(sieves) => {
                let quantity = |name: &str, unit| Quantity {
                    name: name.to_owned(),
                    unit,
                    time: None,
                };
                match order_parameters(sieves.family(scene)) {
                    measures if measures.is_empty() => {
                        let moments = moments(scene).into_iter();
                        moments.map(|(name, unit)| quantity(&name, unit)).collect()
                    }
                    measures => {
                        let measures = measures.iter();
                        measures.map(|(_, it)| quantity(it.name, it.unit)).collect()
                    }
                }
            }
            Self::Motion(times) => {
                let at = |time: usize| {
                    let moments = moments(scene).into_iter();
                    moments.map(move |(name, unit)| Quantity {
                        name: format!("{name}_{}", time + 1),
                        unit,
                        time: Some(time),
                    })
                };
                (0..times.len()).flat_map(at).collect()
            }
            Self::Numerics(_) => {
                let measures = NUMERICS.measures();
                let quantity = |it: &'static Measure| Quantity {
                    name: it.name.to_owned(),
                    unit: it.unit,
                    time: None,
                };
                measures.map(quantity).collect()
            }
        }
    }

    /// Measures a run.
    ///
    /// # Errors
    /// If sieves cannot judge it.
    pub fn measure(&self, record: &RunRecord) -> Result<Measured, ClassifyError> {
        match self {
            Self::States(sieves) => {
                let verdict = classify(record, sieves)?;
                let values = match order_parameters(verdict.family) {
                    measures if measures.is_empty() => {
                        motion_at(record, record.scene.time.duration)
                    }
                    measures => measures
                        .iter()
                        .map(|(place, _)| verdict.values[*place])
                        .collect(),
                };
                Ok(Measured {
                    label: verdict.label,
                    values,
                })
            }
            Self::Motion(times) => {
                let label = match record.outcome {
                    Outcome::Completed => Label::STABLE,
                    Outcome::Unstable(_) => Label::UNSTABLE,
                };
                let values = times.iter().flat_map(|time| motion_at(record, *time));
                Ok(Measured {
                    label,
                    values: values.collect(),
                })
            }
            Self::Numerics(threshold) => {
                let verdict = judge_numerics(record, *threshold);
                Ok(Measured {
                    label: verdict.label,
                    values: verdict.values,
                })
            }
        }
    }

    /// The label of a run that was measured so before, perhaps with another threshold.
    pub(super) fn label_again(&self, label: Label, values: &[Option<f64>]) -> Label {
        match self {
            Self::Numerics(threshold) => judge_numerics_again(label, values, *threshold),
            Self::States(_) | Self::Motion(_) => label,
        }
    }

    /// Short name of the measurement: rows of another one cannot be used again.
    pub fn digest(&self) -> String {
        let text = match self {
            // Labels follow another threshold without a new run.
            Self::Numerics(_) => "numerics".to_owned(),
            of => serde_json::to_string(of).expect("thresholds and times are plain numbers"),
        };
        blake3::hash(text.as_bytes()).to_hex()[..8].to_owned()
    }
}

/// The measures of a family that say what a run did, with their places among all of them.
fn order_parameters(family: &Family) -> Vec<(usize, &'static Measure)> {
    let measures = family.measures().enumerate();
    measures
        .filter(|(_, measure)| !measure.is_evidence)
        .collect()
}

/// Names and units of what is measured of the motion at a time.
fn moments(scene: &Scene) -> Vec<(String, &'static str)> {
    let mut moments: Vec<(String, &'static str)> = [
        ("kinetic_energy", "J"),
        ("rotational_energy", "J"),
        ("mean_height", "m"),
        ("mean_distance", "m"),
        ("angular_momentum", "kg m²/s"),
    ]
    .map(|(name, unit)| (name.to_owned(), unit))
    .into();
    if scene.spheres.count <= FEW {
        for sphere in 0..scene.spheres.count {
            for axis in ["x", "y", "z"] {
                moments.push((format!("velocity_{axis}_of_{sphere}"), "m/s"));
            }
        }
    }
    moments
}

/// The moments of the snapshot at a time, none of which is known if there is no such snapshot.
fn motion_at(record: &RunRecord, time: f64) -> Vec<Option<f64>> {
    let half_frame = 0.5 * record.scene.time.frame_interval;
    let near = |snapshot: &&Snapshot| (snapshot.time - time).abs() < half_frame;
    let Some(snapshot) = record.sound_states().iter().find(near) else {
        return vec![None; moments(&record.scene).len()];
    };
    let inertia_factor = record.scene.spheres.shape.inertia_factor();
    let (mut kinetic, mut rotational, mut momentum) = (0.0, 0.0, 0.0);
    let (mut height, mut distance) = (0.0, 0.0);
    for (sphere, (&mass, &radius)) in record.mass.iter().zip(&record.radius).enumerate() {
        let [x, y, z] = [0, 1, 2].map(|axis| snapshot.position[[sphere, axis]]);
        let [vx, vy, vz] = [0, 1, 2].map(|axis| snapshot.velocity[[sphere, axis]]);
        kinetic += 0.5 * mass * (vx * vx + vy * vy + vz * vz);
        momentum += mass * (x * vy - y * vx);
        height += z;
        distance += libm::hypot(x, y);
        if snapshot.spin.nrows() > sphere {
            let squares = [0, 1, 2].map(|axis| snapshot.spin[[sphere, axis]]);
            let squared: f64 = squares.iter().map(|it| it * it).sum();
            rotational += 0.5 * inertia_factor * mass * radius * radius * squared;
        }
    }
    let count = record.mass.len() as f64;
    let mut values = vec![
        kinetic,
        rotational,
        height / count,
        distance / count,
        momentum,
    ];
    if record.scene.spheres.count <= FEW {
        values.extend(snapshot.velocity.iter());
    }
    values.into_iter().map(Some).collect()
}
