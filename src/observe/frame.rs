//! The state of a simulation at one frame, as an observer sees it.

use super::Snapshot;
use ndarray::Array2;

/// The state of a simulation at one frame, borrowed from the engine. Every slice holds one entry
/// per sphere, and a sphere keeps its index throughout a run.
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    /// Coordinates x, y and z of the centres (m).
    pub position: [&'a [f64]; 3],
    /// Components of the velocities (m/s).
    pub velocity: [&'a [f64]; 3],
    /// Components of the spins (rad/s); absent in a scene without rotation.
    pub spin: Option<[&'a [f64]; 3]>,
    /// Radii (m).
    pub radius: &'a [f64],
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Moments of inertia about the centre (kg m2); read only where there are spins.
    pub inertia: &'a [f64],
    /// Elastic energy of all contacts (J).
    pub elastic_energy: f64,
}

impl FrameView<'_> {
    /// Number of spheres.
    pub fn count(&self) -> usize {
        self.radius.len()
    }
}

impl Snapshot {
    /// A copy of all spheres of a frame at `time` (s).
    pub fn take(time: f64, frame: &FrameView<'_>) -> Self {
        Self {
            time,
            position: rows(frame.position),
            velocity: rows(frame.velocity),
            spin: frame.spin.map_or_else(|| Array2::zeros((0, 3)), rows),
        }
    }
}

/// One row per sphere from one slice per component.
fn rows(components: [&[f64]; 3]) -> Array2<f64> {
    Array2::from_shape_fn((components[0].len(), 3), |(sphere, axis)| {
        components[axis][sphere]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn a_snapshot_has_one_row_per_sphere() {
        let view = FrameView {
            position: [&[1.0, 2.0], &[3.0, 4.0], &[5.0, 6.0]],
            velocity: [&[0.1, 0.2], &[0.3, 0.4], &[0.5, 0.6]],
            spin: None,
            radius: &[1.0, 1.0],
            mass: &[1.0, 1.0],
            inertia: &[],
            elastic_energy: 0.0,
        };
        let snapshot = Snapshot::take(0.25, &view);
        assert_eq!(snapshot.time, 0.25);
        assert_eq!(snapshot.position, array![[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
        assert_eq!(snapshot.velocity, array![[0.1, 0.3, 0.5], [0.2, 0.4, 0.6]]);
        assert_eq!(snapshot.spin.dim(), (0, 3));

        let spinning = FrameView {
            spin: Some([&[7.0, 8.0], &[9.0, 10.0], &[11.0, 12.0]]),
            ..view
        };
        assert_eq!(
            Snapshot::take(0.0, &spinning).spin,
            array![[7.0, 9.0, 11.0], [8.0, 10.0, 12.0]]
        );
    }
}
