//! From the bytes of an HDF5 file to a record.

use super::{FORMAT, FORMAT_VERSION, RecordHeader, seal};
use crate::observe::{Observations, OwnSeries, Snapshot};
use crate::record::{Guard, Instability, Milestone, Outcome, Program, RunRecord};
use crate::scene::{Scene, Start, StartSphere};
use crate::store::StoreError;
use hdf5_pure::{AttrValue, File, H5Element};
use ndarray::{Array, Array1, Array2, Array3, Axis, Dimension};
use std::collections::HashMap;
use std::path::Path;

/// Datasets of the observations that are no scalars of single precision.
const NOT_SCALAR: [&str; 3] = ["time", "profile", "rising"];

/// An open record whose checksum and format are right.
pub(super) struct Reader<'a> {
    path: &'a Path,
    file: File,
    attributes: HashMap<String, AttrValue>,
}

impl<'a> Reader<'a> {
    pub(super) fn open(path: &'a Path) -> Result<Self, StoreError> {
        let mut bytes = std::fs::read(path).map_err(|error| StoreError::reading(path, error))?;
        seal::verify(&mut bytes, path)?;
        let damaged = |error| StoreError::damaged(path, error);
        let file = File::from_bytes(bytes).map_err(damaged)?;
        let attributes = file.root().attrs().map_err(damaged)?;
        let reader = Self {
            path,
            file,
            attributes,
        };
        reader.check_format()?;
        Ok(reader)
    }

    fn check_format(&self) -> Result<(), StoreError> {
        if self.text("format").ok() != Some(FORMAT) {
            return Err(StoreError::NotARecord {
                path: self.path.to_owned(),
                reason: format!("its attribute `format` is not `{FORMAT}`"),
            });
        }
        match self.whole("format_version")? {
            FORMAT_VERSION => Ok(()),
            found => Err(StoreError::Read(format!(
                "{} has record format {found} (written by phase {}), but this program reads \
                 format {FORMAT_VERSION}; use that version, or delete the record and run the \
                 sweep again",
                self.path.display(),
                self.text("program_version").unwrap_or("unknown")
            ))),
        }
    }

    pub(super) fn header(&self) -> Result<RecordHeader, StoreError> {
        Ok(RecordHeader {
            scene: self.scene()?,
            program: Program {
                version: self.text("program_version")?.to_owned(),
                commit: self.text("program_commit")?.to_owned(),
            },
            outcome: self.outcome()?,
            work: self.whole("work")?,
            cpu_seconds: self.number("cpu_seconds")?,
        })
    }

    fn scene(&self) -> Result<Scene, StoreError> {
        let mut scene = Scene::from_json(self.text("scene")?)
            .map_err(|error| self.damaged(format!("its scene: {error}")))?;
        // A long list stands in datasets instead of the text.
        if matches!(&scene.start, Start::List { spheres } if spheres.is_empty()) {
            scene.start = self.start(scene.spheres.count)?;
        }
        Ok(scene)
    }

    fn start(&self, count: usize) -> Result<Start, StoreError> {
        let other = |name| {
            let reason = format!("`start/{name}` is not one row for each of {count} spheres");
            self.damaged(reason)
        };
        let vectors = |name| -> Result<Vec<[f64; 3]>, StoreError> {
            let array: Array2<f64> = self.array(&format!("start/{name}"))?;
            if array.dim() != (count, 3) {
                return Err(other(name));
            }
            let rows = array.rows().into_iter();
            Ok(rows.map(|row| [row[0], row[1], row[2]]).collect())
        };
        let radius: Vec<f64> = self.values("start/radius")?;
        if radius.len() != count {
            return Err(other("radius"));
        }
        let (position, velocity) = (vectors("position")?, vectors("velocity")?);
        let vectors = position.into_iter().zip(velocity).zip(vectors("spin")?);
        let spheres = vectors.zip(&radius);
        let sphere = |(((position, velocity), spin), radius): (_, &f64)| StartSphere {
            position,
            velocity,
            spin,
            radius: (!radius.is_nan()).then_some(*radius),
        };
        Ok(Start::list(spheres.map(sphere).collect()))
    }

    pub(super) fn record(&self) -> Result<RunRecord, StoreError> {
        let RecordHeader {
            scene,
            program,
            outcome,
            work,
            cpu_seconds,
        } = self.header()?;
        let record = RunRecord {
            scene,
            program,
            outcome,
            radius: self.values("spheres/radius")?,
            mass: self.values("spheres/mass")?,
            milestones: self.milestones()?,
            observations: self.observations()?,
            snapshots: self.snapshots("snapshots")?,
            trajectory: self.snapshots("trajectory")?,
            work,
            cpu_seconds,
        };
        match mismatch(&record) {
            Some(reason) => Err(self.damaged(reason)),
            None => Ok(record),
        }
    }

    fn outcome(&self) -> Result<Outcome, StoreError> {
        match self.text("outcome")? {
            "completed" => Ok(Outcome::Completed),
            "unstable" => {
                let name = self.text("guard")?;
                let guard = Guard::ALL.into_iter().find(|guard| guard.name() == name);
                Ok(Outcome::Unstable(Instability {
                    guard: guard.ok_or_else(|| self.damaged(format!("no guard is `{name}`")))?,
                    step: self.whole("guard_step")?,
                    time: self.number("guard_time")?,
                    sphere: usize::try_from(self.whole("guard_sphere")?)
                        .map_err(|error| self.damaged(error))?,
                    detail: self.text("guard_detail")?.to_owned(),
                }))
            }
            other => Err(self.damaged(format!("no outcome is `{other}`"))),
        }
    }

    /// Absent where no sphere comes or goes.
    fn milestones(&self) -> Result<Vec<Milestone>, StoreError> {
        match self.text("milestones") {
            Ok(text) => serde_json::from_str(text)
                .map_err(|error| self.damaged(format!("its milestones: {error}"))),
            Err(_) => Ok(Vec::new()),
        }
    }

    fn observations(&self) -> Result<Observations, StoreError> {
        let mut observations = Observations {
            time: self.values("observations/time")?,
            profile: self.array("observations/profile")?,
            rising: self.array("observations/rising")?,
            ..Observations::default()
        };
        let group = self.file.group("observations");
        let names = group.and_then(|group| group.datasets());
        let names = names.map_err(|error| self.damaged(format!("its observations: {error}")))?;
        for name in names {
            if NOT_SCALAR.contains(&name.as_str()) {
                continue;
            }
            let path = format!("observations/{name}");
            let values = self.values(&path)?;
            match observations.scalar_mut(&name) {
                Some(series) => *series = values,
                None => observations.own.push(self.own_series(name, &path, values)?),
            }
        }
        Ok(observations)
    }

    /// An observable that a model declared for itself.
    fn own_series(
        &self,
        name: String,
        path: &str,
        values: Vec<f32>,
    ) -> Result<OwnSeries, StoreError> {
        let dataset = self.file.dataset(path);
        let attributes = dataset.and_then(|dataset| dataset.attrs());
        let attributes =
            attributes.map_err(|error| self.damaged(format!("its dataset `{path}`: {error}")))?;
        let text = |key: &str| {
            let value = attributes.get(key).and_then(AttrValue::as_str);
            value.unwrap_or_default().to_owned()
        };
        Ok(OwnSeries {
            name,
            unit: text("unit"),
            description: text("description"),
            values,
        })
    }

    fn snapshots(&self, group: &str) -> Result<Vec<Snapshot>, StoreError> {
        if self.file.group(group).is_err() {
            return Ok(Vec::new());
        }
        let time: Vec<f64> = self.values(&format!("{group}/time"))?;
        let position: Array3<f64> = self.array(&format!("{group}/position"))?;
        let velocity: Array3<f64> = self.array(&format!("{group}/velocity"))?;
        let spin = format!("{group}/spin");
        let spin: Array3<f64> = match self.file.dataset(&spin) {
            Ok(_) => self.array(&spin)?,
            Err(_) => Array::zeros((time.len(), 0, 3)),
        };
        for (name, array) in [
            ("position", &position),
            ("velocity", &velocity),
            ("spin", &spin),
        ] {
            if array.len_of(Axis(0)) != time.len() {
                return Err(self.damaged(format!("`{group}/{name}` does not match its times")));
            }
        }
        let at = |array: &Array3<f64>, index| array.index_axis(Axis(0), index).to_owned();
        let snapshot = |(index, &time)| Snapshot {
            time,
            position: at(&position, index),
            velocity: at(&velocity, index),
            spin: at(&spin, index),
        };
        Ok(time.iter().enumerate().map(snapshot).collect())
    }

    fn values<T: H5Element>(&self, name: &str) -> Result<Vec<T>, StoreError> {
        let array: Array1<T> = self.array(name)?;
        Ok(array.into_raw_vec_and_offset().0)
    }

    fn array<T: H5Element, D: Dimension>(&self, name: &str) -> Result<Array<T, D>, StoreError> {
        self.file
            .dataset(name)
            .and_then(|dataset| dataset.read_array())
            .map_err(|error| self.damaged(format!("its dataset `{name}`: {error}")))
    }

    fn text(&self, name: &str) -> Result<&str, StoreError> {
        self.attribute(name, AttrValue::as_str)
    }

    fn whole(&self, name: &str) -> Result<u64, StoreError> {
        self.attribute(name, AttrValue::as_u64)
    }

    fn number(&self, name: &str) -> Result<f64, StoreError> {
        self.attribute(name, AttrValue::as_f64)
    }

    fn attribute<'s, T>(
        &'s self,
        name: &str,
        value: impl Fn(&'s AttrValue) -> Option<T>,
    ) -> Result<T, StoreError> {
        let attribute = self.attributes.get(name).and_then(value);
        attribute.ok_or_else(|| self.damaged(format!("its attribute `{name}` is missing")))
    }

    fn damaged(&self, reason: impl ToString) -> StoreError {
        StoreError::damaged(self.path, reason)
    }
}

/// What of a record does not fit together, if anything does not.
fn mismatch(record: &RunRecord) -> Option<String> {
    let observations = &record.observations;
    let frames = observations.frames();
    let scalars = observations.scalars();
    let scalars = scalars.iter().map(|it| (it.name, it.values.len()));
    let arrays = [
        ("profile", observations.profile.nrows()),
        ("rising", observations.rising.shape()[0]),
    ];
    let mut observed = scalars.chain(arrays);
    if let Some((name, length)) = observed.find(|(_, length)| *length != frames) {
        return Some(format!(
            "`observations/{name}` holds {length} frames, but `observations/time` {frames}"
        ));
    }
    let spheres = record.radius.len();
    if record.mass.len() != spheres {
        let masses = record.mass.len();
        return Some(format!(
            "`spheres/mass` holds {masses} spheres, but `spheres/radius` {spheres}"
        ));
    }
    let states = [
        ("snapshots", &record.snapshots),
        ("trajectory", &record.trajectory),
    ];
    for (group, states) in states {
        for state in states {
            let of_state = [("position", &state.position), ("velocity", &state.velocity)];
            // Without rotation there are no spins.
            let spin = Some(("spin", &state.spin)).filter(|(_, spin)| spin.nrows() > 0);
            let mut of_state = of_state.into_iter().chain(spin);
            if let Some((name, array)) = of_state.find(|(_, it)| it.dim() != (spheres, 3)) {
                return Some(format!(
                    "`{group}/{name}` has the shape {:?} at t = {} s, but ({spheres}, 3) is \
                     expected",
                    array.dim(),
                    state.time
                ));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array3;

    fn sound() -> RunRecord {
        let scene = r#"
            spheres = { count = 2, radius = 0.004, density = 1000.0 }
            start = { kind = "random", z_min = 0.0, z_max = 1.0 }
            time = { dt = 1e-3, duration = 0.01, frame_interval = 1e-3 }
        "#;
        let state = Snapshot {
            time: 0.0,
            position: Array2::zeros((2, 3)),
            velocity: Array2::zeros((2, 3)),
            spin: Array2::zeros((0, 3)),
        };
        RunRecord {
            scene: toml::from_str(scene).unwrap(),
            program: Program::current(),
            outcome: Outcome::Completed,
            radius: vec![0.004; 2],
            mass: vec![1.0; 2],
            milestones: Vec::new(),
            observations: Observations {
                time: vec![0.0, 1e-3],
                kinetic: vec![0.0; 2],
                profile: Array2::zeros((2, 0)),
                rising: Array3::zeros((2, 0, 3)),
                ..Observations::default()
            },
            snapshots: vec![state.clone()],
            trajectory: vec![state],
            work: 0,
            cpu_seconds: 0.0,
        }
    }

    /// Symptom: exports of records with a right checksum panicked. Cause: lengths that disagree
    /// were believed.
    #[test]
    fn what_does_not_fit_together_is_named() {
        assert_eq!(mismatch(&sound()), None);
        type Spoil = fn(&mut RunRecord);
        let spoils: [(&str, Spoil); 8] = [
            ("`spheres/mass`", |it| it.mass.push(1.0)),
            ("`spheres/mass`", |it| it.radius.truncate(1)),
            ("`observations/kinetic`", |it| {
                it.observations.kinetic.truncate(1);
            }),
            ("`observations/profile`", |it| {
                it.observations.profile = Array2::zeros((3, 4));
            }),
            ("`observations/rising`", |it| {
                it.observations.rising = Array3::zeros((1, 0, 3));
            }),
            ("`snapshots/velocity`", |it| {
                it.snapshots[0].velocity = Array2::zeros((1, 3));
            }),
            ("`trajectory/spin`", |it| {
                it.trajectory[0].spin = Array2::zeros((3, 3));
            }),
            ("`trajectory/position`", |it| {
                it.trajectory[0].position = Array2::zeros((2, 2));
            }),
        ];
        for (place, spoil) in spoils {
            let mut record = sound();
            spoil(&mut record);
            let reason = mismatch(&record).unwrap_or_default();
            assert!(reason.starts_with(place), "{place}: {reason}");
        }
    }
}
