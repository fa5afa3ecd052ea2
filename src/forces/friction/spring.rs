//! The loaded spring of a contact that sticks.

use super::{ForceChange, Touch, Traction};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use serde::{Deserialize, Serialize};

/// The loaded spring of a contact that sticks.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Spring {
    /// Its force (N).
    pub(crate) force: Vector,
}

/// The least product of two squared forces (N4) that counts, for two forces of 1e-70 N.
const LEAST_PRODUCT: f64 = 1e-280;

impl Spring {
    /// The spring, of a stiffness k (N/m), loaded by the sliding since the last evaluation, df = -k
    /// du, with the force `drag` (N) of a parallel dashpot, before both are capped at `limit` (N).
    #[inline(always)]
    pub(super) fn loaded(
        &self,
        touch: &Touch,
        stiffness: f64,
        drag: Vector,
        limit: f64,
    ) -> LoadedSpring {
        let loading = touch.loading_velocity * (stiffness * touch.loading_time);
        LoadedSpring {
            elastic: self.force - loading,
            drag,
            limit,
        }
    }

    /// Its energy f^2 / (2 k) (J) at a stiffness k (N/m), which is zero where partners just touch.
    pub(super) fn energy(&self, stiffness: f64) -> f64 {
        match stiffness > 0.0 {
            true => 0.5 * self.force.norm_squared() / stiffness,
            false => 0.0,
        }
    }

    /// The spring turned into the plane across `normal`: it turns with the pair, and keeps its
    /// length.
    #[inline(always)]
    pub fn turned(&self, normal: Vector) -> Self {
        self.turned_to(normal, ForceChange::NONE)
    }

    /// The same with a change of its force.
    #[inline(always)]
    pub(crate) fn turned_to(&self, normal: Vector, change: ForceChange) -> Self {
        self.lengthened(self.force.perpendicular_to(normal), change)
    }

    /// The same, if the change of the normal since the spring was in its plane is known to first
    /// order.
    ///
    /// The smallest rotation from a normal n' to n takes a force f across n' to f - (f n) (n' + n)
    /// / (1 + n' n). A projection uses n instead of (n' + n) / 2: each step then has an angular
    /// error of second order, and the motion is of first order.
    #[inline(always)]
    pub(crate) fn turned_by(&self, normal: Vector, turn: Vector, change: ForceChange) -> Self {
        let half = turn.perpendicular_to(normal) * (0.5 * self.force.dot(normal));
        self.lengthened(self.force.perpendicular_to(normal) + half, change)
    }

    /// The spring in the direction of `turned`, with its length times the change.
    #[inline(always)]
    fn lengthened(&self, turned: Vector, change: ForceChange) -> Self {
        let (before, after) = (self.force.norm_squared(), turned.norm_squared());
        // One root for |before| / |after| and the change. Forces too small for it are set to zero.
        let product = before * after * (change.from * change.from);
        let scale = before * change.to * inverse_square_root(product);
        let force = select(product > LEAST_PRODUCT, turned * scale, Vector::ZERO);
        Self { force }
    }
}

/// A loaded spring before it is capped by the limit of friction. The cap needs a root, which is
/// computed in a separate loop over many contacts.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadedSpring {
    /// Its force (N).
    pub(crate) elastic: Vector,
    /// The force of the parallel dashpot (N).
    pub(crate) drag: Vector,
    /// The limit of friction on both (N).
    pub(crate) limit: f64,
}

impl LoadedSpring {
    /// The force of both (N), as long as friction carries it.
    #[inline(always)]
    pub(crate) fn force(&self) -> Vector {
        self.elastic - self.drag
    }

    /// Square of the force of both (N2).
    #[inline(always)]
    pub(crate) fn squared(&self) -> f64 {
        self.force().norm_squared()
    }

    /// The same spring for schemes of second order. `before` is it before it was loaded.
    ///
    /// While a contact slides, its force turns toward the direction of sliding. The
    /// [cap](Self::capped) shortens the sum of force and loading, which gives the angle to first
    /// order in the step. Here the force is mirrored at the sum of force and half the loading,
    /// which is of second order for a constant limit. If the limit changes, the loading is scaled
    /// by the mean of the old and new limit.
    #[inline(always)]
    pub(crate) fn turned_while_sliding(&self, before: Spring) -> Self {
        let (start, limit_squared) = (before.force - self.drag, self.limit * self.limit);
        let length_squared = start.norm_squared();
        let loading = self.elastic - before.force;
        // Twice the length over the sum of both lengths, to second order.
        let share = 0.75 + 0.25 * length_squared / limit_squared;
        let middle = start + loading * (0.5 * share);
        let middle_squared = middle.norm_squared();
        let mirrored = middle * (2.0 * start.dot(middle) / middle_squared) - start;
        // If it slid before, the mirrored force is about as long as the limit. It must be longer
        // to be capped.
        let slides = self.squared() > limit_squared;
        let slid = length_squared > 0.25 * limit_squared;
        let so = slides & slid & (middle_squared * limit_squared > LEAST_PRODUCT);
        Self {
            elastic: select(so, mirrored * 4.0 + self.drag, self.elastic),
            ..*self
        }
    }

    /// The traction of this spring, capped by the limit of friction.
    #[inline(always)]
    pub(crate) fn traction(&self, touch: &Touch) -> Traction {
        let squared = self.squared();
        touch.traction(self.capped(squared, inverse_square_root(squared)).0)
    }

    /// The tangential force (N), and the spring that remains: at a sliding contact it keeps the
    /// length from which sticking would continue (Luding, Granular Matter 10, 235 (2008), section
    /// 2.3). Takes the square of the force (N2) and 1 / its root.
    #[inline(always)]
    pub(crate) fn capped(&self, squared: f64, inverse_root: f64) -> (Vector, Spring) {
        let force = self.force();
        // Selects, not branches: so the loop over a block of contacts is turned into vector
        // instructions.
        let slides = squared > self.limit * self.limit;
        let capped = force * (self.limit * inverse_root);
        let left = select(slides, capped + self.drag, self.elastic);
        (select(slides, capped, force), Spring { force: left })
    }
}

/// The first if `so`, else the second.
#[inline(always)]
fn select(so: bool, first: Vector, second: Vector) -> Vector {
    Vector::new(
        if so { first.x } else { second.x },
        if so { first.y } else { second.y },
        if so { first.z } else { second.z },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force of a spring that slides for a second, in steps, while the sliding turns through
    /// half a circle and the limit doubles.
    fn slide(steps: u32, second_order: bool) -> Vector {
        let dt = 1.0 / f64::from(steps);
        let mut spring = Spring {
            force: Vector::new(1.0, 0.0, 0.0),
        };
        for step in 0..steps {
            let middle = (f64::from(step) + 0.5) * dt;
            let (sine, cosine) = libm::sincos(3.0 * middle);
            let loaded = LoadedSpring {
                elastic: spring.force + Vector::new(cosine, sine, 0.0) * (8.0 * dt),
                drag: Vector::ZERO,
                limit: 1.0 + f64::from(step + 1) * dt,
            };
            let loaded = match second_order {
                true => loaded.turned_while_sliding(spring),
                false => loaded,
            };
            let squared = loaded.squared();
            spring = loaded.capped(squared, inverse_square_root(squared)).1;
        }
        spring.force
    }

    #[test]
    fn a_sliding_spring_turns_with_second_order() {
        for (second_order, expected) in [(true, 2.0), (false, 1.0)] {
            let [coarse, middle, fine] = [100, 200, 400].map(|steps| slide(steps, second_order));
            let order = libm::log2((coarse - middle).norm() / (middle - fine).norm());
            assert!((order - expected).abs() < 0.1, "{order}");
        }
    }

    #[test]
    fn a_spring_turns_by_the_smallest_rotation_with_second_order() {
        // The normal goes along a circle about z at 60 degrees from it, on which the plane turns.
        let end = |steps: u32, second_order: bool| {
            let normal = |step: u32| {
                let (sine, cosine) = libm::sincos(2.0 * f64::from(step) / f64::from(steps));
                let height = 0.5;
                let across = (1.0_f64 - height * height).sqrt();
                Vector::new(across * cosine, across * sine, height)
            };
            let mut spring = Spring {
                force: Vector::new(0.3, 0.7, 0.2).perpendicular_to(normal(0)),
            };
            for step in 1..=steps {
                let now = normal(step);
                spring = match second_order {
                    true => spring.turned_by(now, now - normal(step - 1), ForceChange::NONE),
                    false => spring.turned(now),
                };
            }
            spring.force
        };
        for (second_order, expected) in [(true, 2.0), (false, 1.0)] {
            let [coarse, middle, fine] = [100, 200, 400].map(|steps| end(steps, second_order));
            let order = libm::log2((coarse - middle).norm() / (middle - fine).norm());
            assert!(order > expected - 0.1, "{order} in place of {expected}");
            assert!(second_order || order < 1.1, "{order}");
        }
    }
}
