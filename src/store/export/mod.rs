//! States of all spheres, for other programs: one file per format.

mod npy;
mod table;
mod vtk;
mod xyz;

pub(in crate::store) use npy::write_array;
pub use npy::write_arrays;
pub use table::{SPHERES_SIGNATURE, write_observations, write_spheres};
pub use vtk::write_vtk;
pub use xyz::write_xyz;

use super::StoreError;
use crate::observe::Snapshot;
use std::fs;
use std::path::Path;

fn make_folder(path: &Path) -> Result<(), StoreError> {
    fs::create_dir_all(path).map_err(|error| StoreError::writing(path, error))
}

/// Whether the spheres have spins.
fn rotate(states: &[&Snapshot]) -> bool {
    states.iter().any(|state| state.spin.nrows() > 0)
}

/// The box (m) that holds all spheres of all states: its corners with the least and with the
/// largest coordinates.
fn bounds(states: &[&Snapshot], radius: &[f64]) -> [[f64; 3]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for state in states {
        for (centre, radius) in state.position.rows().into_iter().zip(radius) {
            for axis in 0..3 {
                low[axis] = low[axis].min(centre[axis] - radius);
                high[axis] = high[axis].max(centre[axis] + radius);
            }
        }
    }
    [low, high]
}
