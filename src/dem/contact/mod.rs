//! Normal contact laws: one file each.

mod hertz;
pub mod restitution;

pub use hertz::Hertz;

/// A normal contact law. The engine is compiled for each law by itself.
pub trait NormalLaw: Copy + Send + 'static {
    /// Whether there are contacts at all.
    const ACTS: bool = true;

    /// Repulsive force (N) from the overlap (m), its rate (m/s) and the effective radius
    /// r1 r2 / (r1 + r2) (m; the sphere's own at a flat wall).
    fn force(&self, overlap: f64, overlap_rate: f64, effective_radius: f64) -> f64;

    /// Elastic energy (J) stored at that overlap.
    fn elastic_energy(&self, overlap: f64, effective_radius: f64) -> f64;
}

/// No contacts: spheres pass through each other and through walls.
#[derive(Clone, Copy, Debug)]
pub struct NoContact;

impl NormalLaw for NoContact {
    const ACTS: bool = false;

    #[inline]
    fn force(&self, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }

    #[inline]
    fn elastic_energy(&self, _: f64, _: f64) -> f64 {
        0.0
    }
}
