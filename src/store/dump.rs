//! The thesis's own dump: a `.npy` array of frames x n x 4 with x, y, z (m) and energy (J) of every
//! sphere, whose name says radius, density and rotation of the air.
//!
//! The names are as in the thesis's control script (Rice, 2012, section 7.2):
//! `dump_r00.003_p03750.0_f006.0.npy`. The script pads the radius to six characters, the analysis
//! of section 7.3 cuts out five. For a seed other than 1, `_s2` and so on follows (the thesis has
//! no seeds). Where several runs have the same numbers, the seed and then the name of each follow,
//! such as `_s1_heavy`. In the dump of an unstable run all coordinates are 1 from the end of the
//! run on; by this the analysis recognises it.

use super::StoreError;
use super::export::write_array;
use super::zip;
use crate::observe::Snapshot;
use crate::record::{Outcome, RunRecord};
use ndarray::{Array3, ArrayView3};
use ndarray_npy::{ReadNpyExt, ViewNpyError, ViewNpyExt};
use std::borrow::Cow;
use std::fmt;
use std::fs;
use std::path::Path;

/// The name of a dump.
#[derive(Clone, Debug, PartialEq)]
pub struct DumpName {
    /// Radius of the spheres (m), their mean if they differ.
    pub radius: f64,
    /// Density of the spheres (kg/m3).
    ///
    /// Rice's program makes the mass pi r^3 of this (an integer division); here it is the mass in
    /// the true volume, 4/3 pi r^3.
    pub density: f64,
    /// Angular velocity Omega of the air (rad/s), 0 without swirl.
    pub omega: f64,
    /// Seed of the run.
    pub seed: u64,
    /// Name of the run, where others have the same numbers.
    pub run: Option<String>,
}

impl DumpName {
    /// The name for the dump of a record.
    pub fn of_record(record: &RunRecord) -> Self {
        let scene = &record.scene;
        let radii = &record.radius;
        // The mean of equal numbers need not be that number.
        let radius = if radii.iter().all(|radius| *radius == radii[0]) {
            radii[0]
        } else {
            radii.iter().sum::<f64>() / radii.len() as f64
        };
        Self {
            radius,
            density: scene.spheres.density,
            omega: scene
                .dem
                .effects
                .swirl
                .as_ref()
                .map_or(0.0, |swirl| swirl.omega),
            seed: scene.seed,
            run: None,
        }
    }
}

impl fmt::Display for DumpName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            radius,
            density,
            omega,
            seed,
            run,
        } = self;
        // Zeros go between the sign and the digits.
        write!(formatter, "dump_r{radius:06?}_p{density:07?}_f{omega:05?}")?;
        if *seed != 1 || run.is_some() {
            write!(formatter, "_s{seed}")?;
        }
        if let Some(run) = run {
            write!(formatter, "_{run}")?;
        }
        formatter.write_str(".npy")
    }
}

/// Writes states of a record as a dump.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_dump(record: &RunRecord, states: &[&Snapshot], path: &Path) -> Result<(), StoreError> {
    write_array(&values(record, states), path)
}

/// The array of a dump. The energy of a sphere is translational, rotational and gravitational (m g
/// z), without what contacts store.
fn values(record: &RunRecord, states: &[&Snapshot]) -> Array3<f64> {
    let count = record.radius.len();
    let gravity = record.scene.gravity_in_fluid();
    let inertial_factor = record.scene.inertial_factor();
    let inertia_factor = record.scene.spheres.shape.inertia_factor();
    let whole = record.scene.time.frames() as usize + 1;
    let (rows, broken) = match &record.outcome {
        Outcome::Completed => (states.len(), f64::INFINITY),
        Outcome::Unstable(instability) => (whole.max(states.len()), instability.time),
    };
    let mut values = Array3::zeros((rows, count, 4));
    for (row, mut spheres) in values.outer_iter_mut().enumerate() {
        let Some(state) = states.get(row).filter(|state| state.time < broken) else {
            (0..3).for_each(|axis| spheres.column_mut(axis).fill(1.0));
            continue;
        };
        for (sphere, mut entry) in spheres.outer_iter_mut().enumerate() {
            let square = |row: ndarray::ArrayView1<'_, f64>| row.dot(&row);
            let (mass, radius) = (record.mass[sphere], record.radius[sphere]);
            let mut energy = 0.5 * mass * inertial_factor * square(state.velocity.row(sphere));
            if state.spin.nrows() > 0 {
                let inertia = inertia_factor * mass * radius * radius;
                energy += 0.5 * inertia * square(state.spin.row(sphere));
            }
            let position = state.position.row(sphere);
            energy += gravity
                .as_ref()
                .map_or(0.0, |it| it.energy(mass, position[0], position[2]));
            for axis in 0..3 {
                entry[axis] = position[axis];
            }
            entry[3] = energy;
        }
    }
    values
}

/// Reads the array of a dump: frames x n x 4, alone or as the one array of a `.npz` archive.
///
/// # Errors
/// [`StoreError::Read`].
pub fn read_dump(path: &Path) -> Result<Array3<f64>, StoreError> {
    let not_a_dump = |reason: String| {
        StoreError::Read(format!(
            "{} is no dump, an array of frames x spheres x 4 of 64-bit floating point numbers: \
             {reason}",
            path.display()
        ))
    };
    let file = fs::read(path).map_err(|error| StoreError::reading(path, error))?;
    let bytes = match zip::is_archive(&file) {
        true => only_array(&file).map_err(not_a_dump)?,
        false => Cow::Borrowed(&file[..]),
    };
    // A header may promise more numbers than there are; a view asks for no memory before it knows.
    let values = match ArrayView3::<f64>::view_npy(&bytes) {
        Ok(view) => Ok(view.to_owned()),
        Err(ViewNpyError::MisalignedData) => {
            Array3::read_npy(&bytes[..]).map_err(|error| not_a_dump(error.to_string()))
        }
        Err(error) => Err(not_a_dump(error.to_string())),
    }?;
    match values.dim() {
        (frames, count, 4) if frames > 0 && count > 0 => Ok(values),
        shape => Err(not_a_dump(format!("its shape is {shape:?}"))),
    }
}

/// The bytes of the one array of an archive.
fn only_array(archive: &[u8]) -> Result<Cow<'_, [u8]>, String> {
    let text = |(message, help)| format!("{message}; {help}");
    let entries = zip::entries(archive).map_err(text)?;
    match &entries[..] {
        // It grows while it is unpacked, by no more than deflate can make of the file.
        [entry] => entry.unpack(archive, usize::MAX).map_err(text),
        _ => Err(format!(
            "the archive has {} arrays; save one alone",
            entries.len()
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_thesis() {
        let name = DumpName {
            radius: 0.003,
            density: 3750.0,
            omega: 6.0,
            seed: 1,
            run: None,
        };
        assert_eq!(name.to_string(), "dump_r00.003_p03750.0_f006.0.npy");
        let other = DumpName {
            omega: -6.5,
            seed: 12,
            ..name.clone()
        };
        assert_eq!(other.to_string(), "dump_r00.003_p03750.0_f-06.5_s12.npy");
        let named = DumpName {
            run: Some("as it was_s2".to_owned()),
            ..name
        };
        let text = "dump_r00.003_p03750.0_f006.0_s1_as it was_s2.npy";
        assert_eq!(named.to_string(), text);
    }
}
