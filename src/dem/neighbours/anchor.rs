//! Positions of the spheres when a list was built, and how far they may have moved since.
//!
//! A common rotation of all spheres about the axis does not count, because it changes no distance
//! of a pair.

use crate::particles::block::ROWS;
use crate::particles::domain::{OpenSpace, Space};
use crate::particles::vector::Vector;
use crate::particles::{Domain, Particles, retain};

/// The position of a sphere when a list was built, in single precision to halve the memory. The
/// margin is reduced by the rounding error.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Reference([f32; 4]);

impl Reference {
    fn of(place: Vector) -> Self {
        Self([place.x as f32, place.y as f32, place.z as f32, 0.0])
    }

    /// The position (m).
    #[inline(always)]
    pub(super) fn place(self) -> Vector {
        let [x, y, z, _] = self.0;
        Vector::new(f64::from(x), f64::from(y), f64::from(z))
    }
}

/// The spheres at the moment when a list was built.
#[derive(Clone, Debug, Default)]
pub struct Anchor {
    domain: Domain,
    position: Vec<Reference>,
    /// The largest distance of a rounded position from its sphere (m).
    rounding: f64,
    /// Rotation rate about the z axis (rad/s).
    rotation: f64,
    /// The angle (rad) by which the spheres are turned before boxes are tested, as boxes do not
    /// turn with the spheres. It is half the angle that is expected during the life of the list.
    middle: f64,
}

impl Anchor {
    /// Stores the present positions of the spheres.
    pub(super) fn renew(&mut self, particles: &Particles) {
        self.domain = particles.domain;
        self.position.clear();
        self.position.reserve_exact(particles.len());
        // One root is taken for all spheres.
        let mut farthest_squared = 0.0_f64;
        for &place in &particles.position {
            let reference = Reference::of(self.domain.wrapped(place));
            let rounding = self.domain.offset(place, reference.place());
            farthest_squared = farthest_squared.max(rounding.norm_squared());
            self.position.push(reference);
        }
        self.rounding = farthest_squared.sqrt();
        self.rotation = mean_rotation(particles);
        self.middle = 0.0;
    }

    /// Sets the angle to half the turn during a life (s), but to no more than `most` (rad). Returns
    /// its sine and cosine.
    pub(super) fn turn(&mut self, life: f64, most: f64) -> (f64, f64) {
        self.middle = (0.5 * self.rotation * life).clamp(-most, most);
        libm::sincos(self.middle)
    }

    /// Adds a sphere that came in at this position.
    pub(super) fn add_sphere(&mut self, position: Vector) {
        let reference = self.rounded(position);
        self.position.push(reference);
    }

    /// Adds a sphere that came in and has no reference yet, so that the list does not hold.
    pub(super) fn add_stray(&mut self) {
        self.position.push(Reference([f32::NAN; 4]));
    }

    /// Replaces the reference of a sphere. The common rotation during the `time` (s) since the list
    /// was built takes the new reference to `place`.
    pub(super) fn replace(&mut self, sphere: usize, place: Vector, time: f64) {
        let (sine, cosine) = libm::sincos(self.rotation * time);
        let Vector { x, y, z, .. } = place;
        let place = Vector::new(cosine * x + sine * y, cosine * y - sine * x, z);
        self.position[sphere] = self.rounded(place);
    }

    /// A reference. Notes its rounding error.
    fn rounded(&mut self, place: Vector) -> Reference {
        let reference = Reference::of(self.domain.wrapped(place));
        let rounding = self.domain.offset(place, reference.place()).norm();
        self.rounding = self.rounding.max(rounding);
        reference
    }

    /// The largest distance of a reference from its sphere by rounding (m).
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Removes the spheres that are not to be kept.
    pub(super) fn remove_spheres(&mut self, keep: &[bool]) {
        retain(&mut self.position, keep);
    }

    /// Positions at the moment when the list was built.
    #[inline]
    pub fn position(&self) -> &[Reference] {
        &self.position
    }

    /// The displacements that leave a list valid `time` (s) after it was built, if the offset of a
    /// pair may change by `margin` (m). `half_diagonal` (m) belongs to the largest box about a
    /// sphere in which partners are counted. It is zero if only distances matter.
    pub(super) fn allowance(&self, time: f64, margin: f64, half_diagonal: f64) -> Allowance {
        let angle = self.rotation * time;
        // The box does not turn with the pair. So a partner moves relative to it by at most the
        // angle times the half diagonal.
        let turned = (angle - self.middle).abs() * half_diagonal;
        // Slightly less than half, to allow for rounding.
        let displacement = (0.499_999_999 * (margin - turned) - self.rounding).max(0.0);
        let (sine, cosine) = libm::sincos(angle);
        Allowance {
            domain: self.domain,
            sine,
            cosine,
            displacement_squared: displacement * displacement,
        }
    }
}

/// How far spheres may have moved since a list was built.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
    domain: Domain,
    sine: f64,
    cosine: f64,
    displacement_squared: f64,
}

impl Allowance {
    /// How far a sphere may be from its reference (m).
    pub(super) fn displacement(&self) -> f64 {
        self.displacement_squared.sqrt()
    }

    /// Whether all spheres are still near enough to their references.
    #[inline(always)]
    pub fn hold(&self, positions: &[Vector], references: &[Reference]) -> bool {
        match self.domain.is_open() {
            true => self.hold_in::<OpenSpace>(positions, references),
            false => self.hold_in::<Domain>(positions, references),
        }
    }

    #[inline(always)]
    fn hold_in<D: Space>(&self, positions: &[Vector], references: &[Reference]) -> bool {
        let groups = positions.chunks(ROWS).zip(references.chunks(ROWS));
        for (positions, references) in groups {
            // All spheres of a group are tested without a branch, which compiles to vector
            // instructions.
            let mut hold = true;
            if let (Ok(positions), Ok(references)) = (
                <&[Vector; ROWS]>::try_from(positions),
                <&[Reference; ROWS]>::try_from(references),
            ) {
                for k in 0..ROWS {
                    hold &= self.holds_in::<D>(positions[k], references[k]);
                }
            } else {
                for (&position, &reference) in positions.iter().zip(references) {
                    hold &= self.holds_in::<D>(position, reference);
                }
            }
            if !hold {
                return false;
            }
        }
        true
    }

    /// Whether a sphere at `position` is still near enough to its `reference`. False if a
    /// coordinate is not a number.
    #[inline(always)]
    pub fn holds(&self, position: Vector, reference: Reference) -> bool {
        match self.domain.is_open() {
            true => self.holds_in::<OpenSpace>(position, reference),
            false => self.holds_in::<Domain>(position, reference),
        }
    }

    #[inline(always)]
    fn holds_in<D: Space>(&self, position: Vector, reference: Reference) -> bool {
        let reference = reference.place();
        let turned = Vector::new(
            self.cosine * reference.x - self.sine * reference.y,
            self.sine * reference.x + self.cosine * reference.y,
            reference.z,
        );
        D::of(self.domain).nearest(position - turned).norm_squared() <= self.displacement_squared
    }
}

/// Rotation rate of the centres about the z axis (rad/s); zero in a space that such a rotation does
/// not leave unchanged.
fn mean_rotation(particles: &Particles) -> f64 {
    if let [Some(_), _, _] | [_, Some(_), _] = particles.domain.periods() {
        return 0.0;
    }
    let (mut momentum, mut inertia) = (0.0, 0.0);
    for (x, v) in particles.position.iter().zip(&particles.velocity) {
        momentum += x.x * v.y - x.y * v.x;
        inertia += x.x * x.x + x.y * x.y;
    }
    if inertia > 0.0 {
        momentum / inertia
    } else {
        0.0
    }
}
