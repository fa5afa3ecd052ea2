//! Three-dimensional vectors.

use fearless_simd::{Simd, SimdFrom, f64x4};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector in space. In memory it is a row of four numbers, which a processor loads and adds at
/// once.
#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[repr(C, align(32))]
pub struct Vector {
    /// Component along x.
    pub x: f64,
    /// Component along y.
    pub y: f64,
    /// Component along z.
    pub z: f64,
    /// Padding without meaning.
    #[serde(skip)]
    rest: f64,
}

impl Vector {
    /// The null vector.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);

    /// The vector with these components.
    #[inline(always)]
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self { x, y, z, rest: 0.0 }
    }

    /// Its row of numbers. The last has no meaning.
    #[inline(always)]
    pub(crate) const fn row(&self) -> [f64; 4] {
        [self.x, self.y, self.z, self.rest]
    }

    /// The vector of a row, whose last number has no meaning.
    #[inline(always)]
    pub(crate) const fn of_row([x, y, z, rest]: [f64; 4]) -> Self {
        Self { x, y, z, rest }
    }

    /// Its row in a register.
    #[inline(always)]
    pub(crate) fn simd<S: Simd>(&self, simd: S) -> f64x4<S> {
        f64x4::simd_from(simd, self.row())
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// Square of the length.
    #[inline(always)]
    pub fn norm_squared(self) -> f64 {
        self.dot(self)
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> f64 {
        self.norm_squared().sqrt()
    }

    /// The vector of length 1 in this direction.
    pub fn unit(self) -> Self {
        self * (1.0 / self.norm())
    }

    /// The vector turned by an angle (rad) about the direction of `axis`: Rodrigues' formula.
    /// Exact without an angle.
    pub(crate) fn turned_about(self, axis: Self, angle: f64) -> Self {
        if angle == 0.0 {
            return self;
        }
        let (axis, (sine, cosine)) = (axis.unit(), libm::sincos(angle));
        self * cosine + axis.cross(self) * sine + axis * (axis.dot(self) * (1.0 - cosine))
    }

    /// The part perpendicular to the unit vector `normal`.
    #[inline(always)]
    pub fn perpendicular_to(self, normal: Self) -> Self {
        self - normal * self.dot(normal)
    }
}

impl PartialEq for Vector {
    fn eq(&self, other: &Self) -> bool {
        (self.x, self.y, self.z) == (other.x, other.y, other.z)
    }
}

impl fmt::Debug for Vector {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { x, y, z, .. } = self;
        write!(out, "({x:?}, {y:?}, {z:?})")
    }
}

impl From<[f64; 3]> for Vector {
    #[inline(always)]
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl Add for Vector {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
            rest: self.rest + other.rest,
        }
    }
}

impl Sub for Vector {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
            rest: self.rest - other.rest,
        }
    }
}

impl Neg for Vector {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
            rest: -self.rest,
        }
    }
}

impl Mul<f64> for Vector {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
            z: self.z * factor,
            rest: self.rest * factor,
        }
    }
}

impl AddAssign for Vector {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Vector {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
