//! Whether sieves can read a record.

use super::ClassifyError;
use crate::record::RunRecord;

/// Whether all spheres have radius and mass, and all observables one entry per frame.
pub(super) fn check_lengths(record: &RunRecord) -> Result<(), ClassifyError> {
    let inconsistent = |message: String| Err(ClassifyError::Inconsistent(message));
    let observations = &record.observations;
    let frames = observations.frames();
    if record.radius.is_empty() || record.mass.len() != record.radius.len() {
        let (radii, masses) = (record.radius.len(), record.mass.len());
        return inconsistent(format!("it holds {radii} radii and {masses} masses"));
    }
    let scalars = observations.scalars().into_iter();
    let lengths = scalars
        .map(|series| (series.name, series.values.len()))
        .chain([("profile", observations.profile.nrows())]);
    for (name, length) in lengths {
        if length != frames {
            return inconsistent(format!("`{name}` holds {length} of {frames} frames"));
        }
    }
    Ok(())
}
