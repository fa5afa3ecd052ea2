//! How many spheres came into a simulation and left it.

/// How many spheres came and went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Spheres of the scene.
    pub all: usize,
    /// Spheres that came in.
    pub released: usize,
    /// Spheres that left, as they should: not while a door was closed.
    pub discharged: usize,
    /// Spheres that left while the door was still closed: over the rim, or never in the silo.
    pub spilled: usize,
    /// Whether a door is still to open.
    pub is_closed: bool,
    /// Whether spheres can leave.
    pub can_leave: bool,
}

impl Counts {
    /// Spheres that left, one way or the other.
    pub fn gone(&self) -> usize {
        self.discharged + self.spilled
    }

    /// The share of all ways in and, where spheres can leave, out that spheres went.
    pub fn share(&self) -> f64 {
        let (done, ways) = match self.can_leave {
            true => (self.released + self.gone(), 2 * self.all),
            false => (self.released, self.all),
        };
        done as f64 / ways.max(1) as f64
    }
}
