//! Rows of the table of borders.

use crate::refine::{Borders, Code};
use crate::scene::Scene;
use crate::store::BorderRow;
use crate::sweep::Sweep;
use crate::theory;

/// The crossings of a sweep's borders as rows of a table.
pub(super) fn rows(
    sweep: &Sweep,
    borders: &Borders,
    name: &dyn Fn(Code) -> &'static str,
) -> Vec<BorderRow> {
    let crossings = borders.crossings.iter();
    let row = |crossing: &crate::refine::Crossing| BorderRow {
        values: crossing.values.clone(),
        along: sweep.axes[borders.axis].name.clone(),
        labels: crossing.labels.map(name),
        band68: crossing.band68,
        band95: crossing.band95,
        width: crossing.width,
        critical_rotation: critical_rotation(sweep, &crossing.values),
    };
    crossings.map(row).collect()
}

/// The critical rotation of the scene at a place, if it has one.
fn critical_rotation(sweep: &Sweep, values: &[f64]) -> Option<f64> {
    sweep.scene.dem.effects.swirl.as_ref()?;
    let keys = sweep.axes.iter().map(|axis| axis.key.as_str());
    // Between whole numbers of spheres there is no scene.
    let pairs = keys.zip(values).map(|(key, value)| match key {
        "spheres.count" => (key, libm::round(*value)),
        _ => (key, *value),
    });
    let scene: Scene = sweep.scene.with_values(pairs).ok()?;
    Some(theory::critical_rotation(
        scene.spheres.count as f64,
        scene.spheres.radius.of_mean_volume(),
        scene.tank.as_ref()?.radius?,
        scene.dem.effects.gravity.as_ref()?.acceleration,
    ))
}
