//! States of spheres that another program left.

use super::run_folder::RunFolder;
use crate::replay::{StateTime, WrittenState};
use crate::simulation::Snapshot;
use crate::store;
use ndarray::Array2;
use std::collections::BTreeMap;
use std::fs;

/// Largest number of coordinates of all states together.
const MOST_COORDINATES: usize = 100_000_000;

/// The states in a file of the folder, with the number of spheres. Velocities are unknown, and the
/// places of spheres that a state lacks: they are not numbers.
pub(super) fn read(
    file: &str,
    most_bytes: u64,
    run_folder: &RunFolder,
) -> Result<(Vec<Snapshot>, usize), String> {
    let path = run_folder.path().join(file);
    let size = fs::metadata(&path).map(|it| it.is_file().then_some(it.len()));
    match size {
        Ok(Some(size)) if size <= most_bytes => {}
        Ok(Some(size)) => return Err(format!("{}: {size} bytes are too many", path.display())),
        Ok(None) => return Err(format!("{}: this is no file", path.display())),
        Err(error) => return Err(format!("{}: {error}", path.display())),
    }
    let states = store::read_states(&path).map_err(|error| error.to_string())?;
    let numbers = states.iter().flat_map(|it| &it.spheres).map(|it| (it.0, 0));
    let mut places: BTreeMap<u64, usize> = numbers.collect();
    for (place, (_, found)) in places.iter_mut().enumerate() {
        *found = place;
    }
    let count = places.len();
    if count.saturating_mul(3 * states.len()) > MOST_COORDINATES {
        return Err(format!(
            "{}: {} states of {count} spheres are too many to keep; write fewer states",
            path.display(),
            states.len()
        ));
    }
    let snapshots = states.iter().map(|state| snapshot(state, &places));
    Ok((snapshots.collect(), count))
}

fn snapshot(state: &WrittenState, places: &BTreeMap<u64, usize>) -> Snapshot {
    let unknown = || Array2::from_elem((places.len(), 3), f64::NAN);
    let mut position = unknown();
    for (number, centre) in &state.spheres {
        let row = places[number];
        for (axis, value) in centre.iter().enumerate() {
            position[(row, axis)] = *value;
        }
    }
    Snapshot {
        time: match state.moment {
            StateTime::Time(time) => time,
            StateTime::Step(step) => step as f64,
        },
        position,
        velocity: unknown(),
        spin: Array2::zeros((0, 3)),
    }
}
