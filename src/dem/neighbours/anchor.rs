//! Where spheres stood when a list was made, and how far they may have moved since.
//!
//! A rotation of all spheres about the axis is not counted: it leaves the distances of all pairs as
//! they are.

use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use crate::particles::{Particles, retain};

/// Where a sphere stood, in half the memory: single precision is more than a margin needs, and what
/// it rounds is taken from the margin.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Reference([f32; 4]);

impl Reference {
    fn of(place: Vector) -> Self {
        Self([place.x as f32, place.y as f32, place.z as f32, 0.0])
    }

    /// Where it is (m).
    #[inline(always)]
    pub(super) fn place(self) -> Vector {
        let [x, y, z, _] = self.0;
        Vector::new(f64::from(x), f64::from(y), f64::from(z))
    }
}

/// The spheres at the moment when a list was made.
#[derive(Clone, Debug, Default)]
pub struct Anchor {
    position: Vec<Reference>,
    /// The farthest that rounding put one of them from its sphere (m).
    rounding: f64,
    /// Rotation rate about the z axis (rad/s).
    rotation: f64,
    /// The angle (rad) by which the spheres are turned for a list of boxes, which do not turn: as
    /// far as they will have come half-way through the life of the list, so that they are never far
    /// from it.
    middle: f64,
}

impl Anchor {
    /// Takes the spheres as they are now.
    pub(super) fn drop(&mut self, particles: &Particles) {
        self.position.clear();
        self.position.reserve_exact(particles.len());
        // One root for all.
        let mut farthest_squared = 0.0_f64;
        for &place in &particles.position {
            let reference = Reference::of(place);
            let rounding = place - reference.place();
            farthest_squared = farthest_squared.max(rounding.norm_squared());
            self.position.push(reference);
        }
        self.rounding = farthest_squared.sqrt();
        self.rotation = mean_rotation(particles);
        self.middle = 0.0;
    }

    /// Turns the spheres to where they will be half-way through a life (s), but by no more than an
    /// angle (rad). Returns sine and cosine.
    pub(super) fn turn(&mut self, life: f64, most: f64) -> (f64, f64) {
        self.middle = (0.5 * self.rotation * life).clamp(-most, most);
        libm::sincos(self.middle)
    }

    /// Adds a sphere that came in where it is now.
    pub(super) fn add_sphere(&mut self, position: Vector) {
        let reference = self.rounded(position);
        self.position.push(reference);
    }

    /// Adds a sphere that came in and has no place yet: nothing holds for it.
    pub(super) fn add_stray(&mut self) {
        self.position.push(Reference([f32::NAN; 4]));
    }

    /// Takes a sphere as if it had been turned with all others, in the `time` (s) since that
    /// moment, to this place.
    pub(super) fn replace(&mut self, sphere: usize, place: Vector, time: f64) {
        let (sine, cosine) = libm::sincos(self.rotation * time);
        let Vector { x, y, z, .. } = place;
        let place = Vector::new(cosine * x + sine * y, cosine * y - sine * x, z);
        self.position[sphere] = self.rounded(place);
    }

    /// A reference, whose rounding is noted.
    fn rounded(&mut self, place: Vector) -> Reference {
        let reference = Reference::of(place);
        let rounding = (place - reference.place()).norm();
        self.rounding = self.rounding.max(rounding);
        reference
    }

    /// The farthest that rounding put a reference from its sphere (m).
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Forgets the spheres that are not to be kept.
    pub(super) fn remove_spheres(&mut self, keep: &[bool]) {
        retain(&mut self.position, keep);
    }

    /// Positions at that moment.
    #[inline]
    pub fn position(&self) -> &[Reference] {
        &self.position
    }

    /// The displacements that leave a list valid for a `time` (s) since that moment, if the offset
    /// of a pair may change by `margin` (m). `half_diagonal` is that of the largest box about a
    /// sphere in which partners count (m), zero if only distances count.
    pub(super) fn allowance(&self, time: f64, margin: f64, half_diagonal: f64) -> Allowance {
        let angle = self.rotation * time;
        // The box does not turn with the pair: that moves a partner relative to it by at most the
        // angle times the half diagonal.
        let turned = (angle - self.middle).abs() * half_diagonal;
        // A hair less than half, for what rounding adds.
        let displacement = (0.499_999_999 * (margin - turned) - self.rounding).max(0.0);
        let (sine, cosine) = libm::sincos(angle);
        Allowance {
            sine,
            cosine,
            displacement_squared: displacement * displacement,
        }
    }
}

/// How far spheres may have moved since an anchor was dropped.
#[derive(Clone, Copy, Debug)]
pub struct Allowance {
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
        let groups = positions.chunks(ROWS).zip(references.chunks(ROWS));
        for (positions, references) in groups {
            // Of a group all are looked at, which the compiler then does at once.
            let mut hold = true;
            if let (Ok(positions), Ok(references)) = (
                <&[Vector; ROWS]>::try_from(positions),
                <&[Reference; ROWS]>::try_from(references),
            ) {
                for k in 0..ROWS {
                    hold &= self.holds(positions[k], references[k]);
                }
            } else {
                for (&position, &reference) in positions.iter().zip(references) {
                    hold &= self.holds(position, reference);
                }
            }
            if !hold {
                return false;
            }
        }
        true
    }

    /// Whether a sphere at `position` is still near enough to its `reference`. Not so if a
    /// coordinate is not a number.
    #[inline(always)]
    pub fn holds(&self, position: Vector, reference: Reference) -> bool {
        let reference = reference.place();
        let turned = Vector::new(
            self.cosine * reference.x - self.sine * reference.y,
            self.sine * reference.x + self.cosine * reference.y,
            reference.z,
        );
        (position - turned).norm_squared() <= self.displacement_squared
    }
}

/// Rotation rate of the centres about the z axis (rad/s).
fn mean_rotation(particles: &Particles) -> f64 {
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
