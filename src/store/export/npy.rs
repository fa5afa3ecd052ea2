//! NumPy arrays: a folder with one `.npy` file per quantity.

use super::{fixed, make_folder, rotate};
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::scene::FixedSphere;
use crate::store::StoreError;
use crate::store::atomic::write_atomic_with;
use ndarray::{Array1, Array2, Array3, ArrayBase, ArrayView2, Axis, Data, Dimension};
use ndarray_npy::{WriteNpyError, WriteNpyExt};
use std::io;
use std::path::Path;

/// Names of the arrays that every folder of them holds.
pub const ARRAYS: [&str; 5] = [
    "time.npy",
    "position.npy",
    "velocity.npy",
    "radius.npy",
    "mass.npy",
];

/// Writes these states of a record into `folder` as arrays of 64-bit floating point numbers: `time`
/// (s; states), `position` (m), `velocity` (m/s) and, of spheres that rotate, `spin` (rad/s; all
/// states x n x 3), `radius` (m; n), `mass` (kg; n). Where spheres come and go, one that is not in
/// has no numbers (NaN). Of fixed spheres `walls` and `door` (x, y, z and radius, all in m; number
/// of spheres x 4).
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_arrays(
    record: &RunRecord,
    states: &[&Snapshot],
    folder: &Path,
) -> Result<(), StoreError> {
    make_folder(folder)?;
    let file = |name: &str| folder.join(name).with_extension("npy");
    let time: Array1<f64> = states.iter().map(|state| state.time).collect();
    write_array(&time, &file("time"))?;
    write_array(&stack(states, |state| &state.position), &file("position"))?;
    write_array(&stack(states, |state| &state.velocity), &file("velocity"))?;
    if rotate(states) {
        write_array(&stack(states, |state| &state.spin), &file("spin"))?;
    }
    write_array(&Array1::from(record.radius.clone()), &file("radius"))?;
    write_array(&Array1::from(record.mass.clone()), &file("mass"))?;
    let fixed = fixed(record);
    for (name, spheres) in [("walls", &fixed.walls), ("door", &fixed.door)] {
        if !spheres.is_empty() {
            write_array(&rows(spheres), &file(name))?;
        }
    }
    Ok(())
}

/// One row of x, y, z and radius per sphere.
fn rows(spheres: &[FixedSphere]) -> Array2<f64> {
    Array2::from_shape_fn((spheres.len(), 4), |(sphere, column)| {
        let FixedSphere { position, radius } = spheres[sphere];
        position.get(column).copied().unwrap_or(radius)
    })
}

fn stack(states: &[&Snapshot], part: impl Fn(&Snapshot) -> &Array2<f64>) -> Array3<f64> {
    let parts: Vec<ArrayView2<'_, f64>> = states.iter().map(|state| part(state).view()).collect();
    ndarray::stack(Axis(0), &parts).expect("the states of a record have one shape")
}

/// Writes one array.
pub(in crate::store) fn write_array<S, D>(
    array: &ArrayBase<S, D>,
    path: &Path,
) -> Result<(), StoreError>
where
    S: Data<Elem = f64>,
    D: Dimension,
{
    write_atomic_with(path, |file| {
        array.write_npy(file).map_err(|error| match error {
            WriteNpyError::Io(error) => error,
            other => io::Error::other(other),
        })
    })
}
