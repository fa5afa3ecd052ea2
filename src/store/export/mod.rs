//! States of all spheres, for other programs: one file per format.

mod npy;
mod page;
mod svg;
mod table;
mod vtk;
mod xyz;

pub(in crate::store) use npy::write_array;
pub use npy::{ARRAYS, write_arrays};
pub use page::PAGE_SIGNATURE;
pub use page::write_page;
pub use svg::write_svg;
pub use table::{SPHERES_SIGNATURE, write_fixed, write_observations, write_spheres};
pub use vtk::{VTK_SIGNATURE, vtk_names, write_vtk};
pub use xyz::{write_fixed_xyz, write_xyz};

use super::StoreError;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::FixedSpheres;
use std::fs;
use std::path::Path;

/// Name of the file of one state, counted from 0.
pub fn frame_name(frame: usize, extension: &str) -> String {
    format!("frame_{frame:05}.{extension}")
}

/// The spheres that are in. Where spheres come and go, others have no numbers.
fn present(record: &RunRecord, state: &Snapshot) -> Vec<usize> {
    let has_flow = record.scene.has_flow();
    let is_in = |&sphere: &usize| !has_flow || !state.position[[sphere, 0]].is_nan();
    (0..record.radius.len()).filter(is_in).collect()
}

/// The fixed spheres of a scene: walls and door.
fn fixed(record: &RunRecord) -> FixedSpheres {
    record.scene.fixed_in_box()
}

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
