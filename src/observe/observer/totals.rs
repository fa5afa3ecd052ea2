//! Sums over the spheres of a frame.

use crate::observe::reduce::{Sum, largest, least};
use crate::simulation::{Flow, FrameView, Ledger};

/// Sums over all spheres of a frame.
#[derive(Debug)]
pub(super) struct Totals {
    pub(super) count: usize,
    pub(super) mass: Sum,
    pub(super) kinetic: Sum,
    pub(super) rotational: Sum,
    pub(super) gravitational: Sum,
    pub(super) speed: Sum,
    /// Vertical velocities (m/s).
    pub(super) rise: Sum,
    /// About the axis (kg m2/s), and the moment of inertia of the centres (kg m2).
    pub(super) momentum: Sum,
    pub(super) inertia: Sum,
    pub(super) distance: Sum,
    pub(super) height: Sum,
    /// The least distance from the axis, and the largest height (m); NaN without spheres.
    pub(super) nearest: f64,
    pub(super) highest: f64,
    pub(super) elastic_energy: f64,
    pub(super) ledger: Option<Ledger>,
    pub(super) flow: Option<Flow>,
}

impl Default for Totals {
    fn default() -> Self {
        Self {
            count: 0,
            mass: Sum::default(),
            kinetic: Sum::default(),
            rotational: Sum::default(),
            gravitational: Sum::default(),
            speed: Sum::default(),
            rise: Sum::default(),
            momentum: Sum::default(),
            inertia: Sum::default(),
            distance: Sum::default(),
            height: Sum::default(),
            nearest: f64::NAN,
            highest: f64::NAN,
            elastic_energy: 0.0,
            ledger: None,
            flow: None,
        }
    }
}

impl Totals {
    /// Adds a block of spheres.
    pub(super) fn add(&mut self, block: &FrameView<'_>) {
        let (z, vz) = (block.position[2], block.velocity[2]);
        self.count += block.count();
        self.rise.add([vz], |[vz]| vz);
        self.height.add([z], |[z]| z);
        let highest = largest(z);
        // Not a number before the first sphere.
        if highest > self.highest || self.highest.is_nan() {
            self.highest = highest;
        }
        if block.flow.is_some() {
            self.mass.add([block.mass], |[mass]| mass);
        }
        self.elastic_energy = block.elastic_energy;
        self.ledger = block.ledger;
        self.flow = block.flow;
    }

    /// Adds speeds.
    pub(super) fn add_speeds(&mut self, block: &FrameView<'_>) {
        let speed = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
        self.speed.add(block.velocity, speed);
    }

    /// Adds energies, under gravity of these components along x and z (m/s2).
    pub(super) fn add_energies(&mut self, block: &FrameView<'_>, [gx, gz]: [f64; 2]) {
        let ([x, _, z], [vx, vy, vz]) = (block.position, block.velocity);
        self.kinetic
            .add([block.mass, vx, vy, vz], |[mass, x, y, z]| {
                0.5 * mass * (x * x + y * y + z * z)
            });
        if let Some([wx, wy, wz]) = block.spin {
            self.rotational
                .add([block.inertia, wx, wy, wz], |[inertia, x, y, z]| {
                    0.5 * inertia * (x * x + y * y + z * z)
                });
        }
        self.gravitational.add([block.mass, x, z], |[mass, x, z]| {
            -(mass * gx * x) - mass * gz * z
        });
    }

    /// Adds sums that refer to the axis. `distance` holds the distances of a block's spheres from
    /// it (m).
    pub(super) fn add_about_axis(&mut self, block: &FrameView<'_>, distance: &[f64]) {
        let ([x, y, _], [vx, vy, _]) = (block.position, block.velocity);
        self.momentum
            .add([block.mass, x, y, vx, vy], |[mass, x, y, vx, vy]| {
                mass * (x * vy - y * vx)
            });
        self.inertia
            .add([block.mass, x, y], |[mass, x, y]| mass * (x * x + y * y));
        self.distance.add([distance], |[distance]| distance);
        let nearest = least(distance);
        // Not a number before the first sphere.
        if nearest < self.nearest || self.nearest.is_nan() {
            self.nearest = nearest;
        }
    }
}
