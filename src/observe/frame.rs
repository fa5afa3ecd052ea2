//! The state of a simulation at one frame, as an observer sees it.

use super::Snapshot;
use ndarray::Array2;

/// The state of a simulation at one frame, borrowed from the engine. Every slice holds one entry
/// per sphere that moves; a sphere keeps its index throughout a run, unless spheres come and go.
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
    /// Where the energy went; absent if the scene's output does not ask for it.
    pub ledger: Option<Ledger>,
    /// How spheres come and go; absent where none does.
    pub flow: Option<Flow<'a>>,
}

/// Where the energy went since the start (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// What tangential springs hold.
    pub springs: f64,
    /// What the damping of contacts dissipated.
    pub damping: f64,
    /// What friction dissipated: the work done against tangential forces that springs do not hold.
    pub friction: f64,
    /// Work of the air, the damping of spins included.
    pub air: f64,
    /// Energy of the spheres that came in, less that of those that left.
    pub brought: f64,
}

/// How spheres come and go.
#[derive(Clone, Copy, Debug)]
pub struct Flow<'a> {
    /// Number of each sphere of the frame among all of the scene, counted from 0, in rising order.
    pub number: &'a [u32],
    /// Spheres of the scene, those included that are not in yet or have left.
    pub spheres: usize,
    /// Spheres that came in so far.
    pub released: usize,
    /// Spheres that left so far, as they should: not while a door was closed.
    pub discharged: usize,
    /// Spheres that left while the door was still closed.
    pub spilled: usize,
    /// Contacts of the spheres of the frame, one between two of them counted for each.
    pub contacts: usize,
}

impl FrameView<'_> {
    /// Number of spheres.
    pub fn count(&self) -> usize {
        self.radius.len()
    }
}

impl Snapshot {
    /// A copy of all spheres of a frame at `time` (s). Where spheres come and go, one that is not
    /// in has no numbers (NaN).
    pub fn take(time: f64, frame: &FrameView<'_>) -> Self {
        let rows = |components| rows(components, frame.flow.as_ref());
        Self {
            time,
            position: rows(frame.position),
            velocity: rows(frame.velocity),
            spin: frame.spin.map_or_else(|| Array2::zeros((0, 3)), rows),
        }
    }
}

/// One row per sphere from one slice per component.
fn rows(components: [&[f64]; 3], flow: Option<&Flow<'_>>) -> Array2<f64> {
    let Some(flow) = flow else {
        return Array2::from_shape_fn((components[0].len(), 3), |(sphere, axis)| {
            components[axis][sphere]
        });
    };
    let mut rows = Array2::from_elem((flow.spheres, 3), f64::NAN);
    for (at, &sphere) in flow.number.iter().enumerate() {
        for axis in 0..3 {
            rows[[sphere as usize, axis]] = components[axis][at];
        }
    }
    rows
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
            ledger: None,
            flow: None,
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
