//! The state of a simulation at one frame, as an observer sees it.

use super::Snapshot;
use ndarray::Array2;

/// The spheres of a frame, block by block in the order of the scene.
///
/// A [`FrameView`] shows itself as one block. A model that stores its spheres in another order
/// reorders one block at a time, so no second copy of all spheres is needed.
pub trait Frame {
    /// Number of spheres.
    fn count(&self) -> usize;

    /// Shows all blocks. Each but the last has a multiple of [`FRAME_BLOCK`] spheres.
    fn show(&self, look: &mut dyn FnMut(&FrameView<'_>));
}

/// Blocks of a frame are multiples of this number of spheres. Sums over spheres have this many
/// partial sums, so their bits do not depend on where a block ends.
pub const FRAME_BLOCK: usize = 4;

/// The state of a simulation at one frame, or of one block of its spheres, borrowed from the model.
///
/// Every slice holds one entry per sphere that moves. A sphere keeps its index throughout a run,
/// unless spheres come and go. Fields that do not belong to single spheres describe the whole
/// frame, even in a block.
#[derive(Clone, Copy, Debug)]
pub struct FrameView<'a> {
    /// Coordinates x, y and z of the centres (m).
    pub position: [&'a [f64]; 3],
    /// Components of the velocities (m/s).
    pub velocity: [&'a [f64]; 3],
    /// Components of the spins (rad/s); `None` in a scene without rotation.
    pub spin: Option<[&'a [f64]; 3]>,
    /// Radii (m).
    pub radius: &'a [f64],
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Moments of inertia about the centre (kg m2); read only with spins.
    pub inertia: &'a [f64],
    /// Elastic energy of all contacts (J).
    pub elastic_energy: f64,
    /// Energy balance; `None` if the scene's output does not ask for it.
    pub ledger: Option<Ledger>,
    /// Number of each sphere in the scene, counted from 0, in ascending order; `None` if no sphere
    /// comes or goes.
    pub number: Option<&'a [u32]>,
    /// How spheres come and go; `None` if none does.
    pub flow: Option<Flow>,
}

/// Energy balance since the start (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Energy in tangential springs.
    pub springs: f64,
    /// Dissipation by the damping of contacts.
    pub damping: f64,
    /// Dissipation by friction: the work done against tangential forces that springs do not store.
    pub friction: f64,
    /// Work of the air, including the damping of spins.
    pub air: f64,
    /// Work of the shaking on the spheres, in the frame of the box.
    pub shaking: f64,
    /// Work of walls that move in themselves.
    pub walls: f64,
    /// Energy of spheres that came in, minus the energy of spheres that left.
    pub brought: f64,
}

/// How spheres come and go.
#[derive(Clone, Copy, Debug)]
pub struct Flow {
    /// Spheres of the scene, including those that are not in yet or have left.
    pub spheres: usize,
    /// Spheres that came in so far.
    pub released: usize,
    /// Spheres that left properly so far, not while a door was closed.
    pub discharged: usize,
    /// Spheres that left while the door was still closed.
    pub spilled: usize,
    /// Contacts of the frame's spheres. A contact between two of them counts twice.
    pub contacts: usize,
}

impl FrameView<'_> {
    /// Number of spheres.
    pub fn count(&self) -> usize {
        self.radius.len()
    }
}

impl Frame for FrameView<'_> {
    fn count(&self) -> usize {
        self.count()
    }

    fn show(&self, look: &mut dyn FnMut(&FrameView<'_>)) {
        look(self);
    }
}

impl Snapshot {
    /// A copy of all spheres of a frame at `time` (s). Spheres that are not in are NaN.
    pub fn take(time: f64, frame: &dyn Frame) -> Self {
        let mut rows = SnapshotRows::default();
        let mut first = 0;
        frame.show(&mut |block| {
            if first == 0 {
                rows = SnapshotRows::new(frame.count(), block);
            }
            rows.add(first, block);
            first += block.count();
        });
        let [position, velocity, spin] = rows.0;
        Self {
            time,
            position,
            velocity,
            spin,
        }
    }
}

/// Positions, velocities and spins, one row per sphere.
#[derive(Default)]
struct SnapshotRows([Array2<f64>; 3]);

impl SnapshotRows {
    /// Rows of spheres that are not in.
    fn new(count: usize, view: &FrameView<'_>) -> Self {
        let rows = |rows| match view.flow {
            Some(flow) => Array2::from_elem((flow.spheres, 3), f64::NAN),
            None => Array2::zeros((rows, 3)),
        };
        let spin = match view.spin {
            Some(_) => rows(count),
            None => Array2::zeros((0, 3)),
        };
        Self([rows(count), rows(count), spin])
    }

    /// Adds a block of spheres. `first` is the place of its first sphere in the frame.
    fn add(&mut self, first: usize, block: &FrameView<'_>) {
        let all = [Some(block.position), Some(block.velocity), block.spin];
        for (rows, components) in self.0.iter_mut().zip(all) {
            let Some(components) = components else {
                continue;
            };
            for at in 0..block.count() {
                let sphere = block.number.map_or(first + at, |it| it[at] as usize);
                for (axis, component) in components.iter().enumerate() {
                    let (entry, value) = (&mut rows[[sphere, axis]], component[at]);
                    // Zeros are not written: untouched pages take no memory, and many spheres start
                    // at rest.
                    if entry.to_bits() != value.to_bits() {
                        *entry = value;
                    }
                }
            }
        }
    }
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
            number: None,
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
