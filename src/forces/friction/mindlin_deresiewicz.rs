//! Partial slip: the friction of Mindlin and Deresiewicz.

use super::mindlin::{mindlin_limit, mindlin_modulus};
use super::{Coulomb, FrictionKeys, History, LoadedSpring, Spring, TangentialLaw};
use super::{Touch, Turning};
use crate::document::quantity;
use crate::forces::contact::{Collision, ElasticSolid, contact_radius};
use crate::forces::limit::{Limit, Regime};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Partial slip (Mindlin and Deresiewicz, 1953): a contact slips from its rim inward before it
/// slides as a whole, so that the stiffness falls under load, and reversed loads dissipate energy
/// below mu F_n; needs the hertz or tsuji contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MindlinDeresiewicz {
    /// Coefficient mu.
    #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
    pub coefficient: f64,
}

impl MindlinDeresiewicz {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "mindlin-deresiewicz";
}

impl<C: ElasticSolid> FrictionKeys<C> for MindlinDeresiewicz {
    type Law = MindlinDeresiewiczLaw;

    fn law(&self, contact: &C, _: f64) -> MindlinDeresiewiczLaw {
        MindlinDeresiewiczLaw::new(
            self.coefficient,
            contact.young_modulus(),
            contact.poisson_ratio(),
        )
    }

    /// The limit of a sticking contact, whose spring is stiffest.
    fn limit(&self, contact: &C, collisions: &[Collision], regime: &Regime<'_>) -> Option<Limit> {
        mindlin_limit(contact, collisions, regime)
    }

    fn simpler(&self, _: &C) -> Option<Coulomb> {
        Some(Coulomb::instead(self.coefficient))
    }
}

/// What a contact with partial slip remembers.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct SlipHistory {
    spring: Spring,
    turning: Turning,
}

impl History for SlipHistory {
    const TURNS: bool = true;

    #[inline(always)]
    fn spring(self) -> Spring {
        self.spring
    }

    #[inline(always)]
    fn of_spring(spring: Spring) -> Self {
        Self {
            spring,
            turning: Turning::default(),
        }
    }

    #[inline(always)]
    fn turning(self) -> Turning {
        self.turning
    }

    #[inline(always)]
    fn with_turning(self, turning: Turning) -> Self {
        Self { turning, ..self }
    }

    fn turned_round(self) -> Self {
        let turned = |force: Vector| -force;
        Self {
            spring: Spring {
                force: turned(self.spring.force),
            },
            turning: Turning {
                force: turned(self.turning.force),
                ..self.turning
            },
        }
    }

    fn is_new(self) -> bool {
        self.spring.is_new() && self.turning.normal_force.to_bits() == 0
    }
}

/// Tangential force with partial slip between like spheres, or a sphere and a wall of its material
/// (Mindlin and Deresiewicz, J. Appl. Mech. 20, 327 (1953); as increments: Vu-Quoc and Zhang, Mech.
/// Mater. 31, 235 (1999), and Thornton, Cummins and Cleary, Powder Technology 233, 30 (2013)).
///
/// The stiffness is k_t theta, with Mindlin's k_t = 8 G* sqrt(R_eff xi) of a sticking contact, and
/// theta^3 = 1 - |f - f_0| / (s mu F_n): s = 1 and f_0 = 0 when the contact is loaded first, s = 2
/// and f_0 the force at the latest turning point when it is unloaded or reloaded. Once the force
/// exceeds the force of first unloading, the first curve continues. If the normal force changes by
/// d, the turning point moves by mu d, and a displacement below mu d / k_t meets the full
/// stiffness. For a constant normal force steps of any length follow the curves exactly, because
/// theta^2 is linear in the displacement.
///
/// The law makes two simplifications: only the latest of nested turning points counts, as in the
/// third source, and the rim of a contact that is pressed harder at rest counts as loaded. The
/// first leads to errors up to 0.35 mu F_n if a contact is unloaded in many small steps back and
/// forth, and to smaller errors on the other paths in the tests. Otherwise the law agrees with a
/// row of springs that slide independently (a test compares them). The sources do not treat two
/// dimensions: here forces, turning points and displacements are vectors, and a contact turns back
/// if the displacement has a component against its branch.
#[derive(Clone, Copy, Debug)]
pub struct MindlinDeresiewiczLaw {
    coefficient: f64,
    /// 8 G* (Pa).
    modulus: f64,
}

impl MindlinDeresiewiczLaw {
    /// The law with coefficient mu, Young's modulus (Pa) and Poisson's ratio of both partners.
    pub fn new(coefficient: f64, young_modulus: f64, poisson_ratio: f64) -> Self {
        Self {
            coefficient,
            modulus: mindlin_modulus(young_modulus, poisson_ratio),
        }
    }
}

/// Where a contact is on one of its curves.
///
/// Displacements are in units of (3/2) mu F_n / k_t, at which a contact with the present normal
/// force begins to slide as a whole. In these the contact reaches 1 - theta^2 along its first
/// curve.
struct Branch {
    /// Force at its origin (N).
    origin: Vector,
    /// 1 of the first curve, 2 of others.
    scale: f64,
    /// Displacement since its origin, over the scale, along the force.
    progress: Vector,
    /// Largest possible progress at the previous normal force, in present units.
    extent: f64,
    /// Force at which the first curve was left (N).
    peak: f64,
}

/// Cube root of the square.
#[inline(always)]
fn two_thirds(value: f64) -> f64 {
    let root = libm::cbrt(value);
    root * root
}

#[inline(always)]
fn to_three_halves(value: f64) -> f64 {
    value * value.sqrt()
}

/// The unit vector along `vector`, or zero.
#[inline(always)]
fn direction(vector: Vector) -> Vector {
    let length = vector.norm();
    match length > 0.0 {
        true => vector * (1.0 / length),
        false => Vector::ZERO,
    }
}

impl Branch {
    /// The curve that a contact is on, whose latest force is `force` (N), at a limit of friction
    /// (N) that was `limit_before`.
    #[inline(always)]
    fn of(force: Vector, turning: &Turning, limit: f64, limit_before: f64) -> Self {
        let first = turning.force.norm_squared() == 0.0;
        let scale = if first { 1.0 } else { 2.0 };
        let part = (force - turning.force) * (1.0 / scale);
        let carried = part.norm();
        let extent = two_thirds(limit_before / limit);
        let sticking = two_thirds((limit_before - carried).max(0.0) / limit);
        Self {
            origin: turning.force,
            scale,
            progress: direction(part) * (extent - sticking),
            extent,
            peak: match first {
                true => carried,
                false => turning.peak,
            },
        }
    }

    /// Moves on by a displacement. Returns the force (N), the origin of its curve and the peak.
    #[inline(always)]
    fn moved(
        mut self,
        displacement: Vector,
        force: Vector,
        limit: f64,
        limit_before: f64,
    ) -> (Vector, Vector, f64) {
        if self.progress.dot(displacement) < 0.0 {
            self.origin = force;
            self.scale = 2.0;
            self.progress = Vector::ZERO;
        }
        let way = displacement.norm();
        // A growing contact sticks up to a displacement; a shrinking one slides at its rim.
        let rim = way.min(1.0 - self.extent);
        let extent = (self.extent + rim).min(1.0);
        let along = direction(match self.progress.norm_squared() > 0.0 {
            true => self.progress,
            false => displacement,
        });
        let rest = 1.0 - 1.0 / self.scale;
        let progress = self.progress + displacement * (1.0 / self.scale) + along * (rim * rest);
        let length = progress.norm();
        let sticking = (extent - length).max(0.0);
        // While it sticks it is as wide as in the middle of the step.
        let gain = match rim < 1.0 - self.extent {
            true => {
                let [at_start, at_end] = [
                    to_three_halves(extent) - to_three_halves(self.extent),
                    1.0 - to_three_halves(1.0 - rim),
                ];
                0.5 * limit * (at_start + at_end)
            }
            false => limit - limit_before,
        };
        let carried = limit_before + gain - limit * to_three_halves(sticking);
        let is_first = self.scale == 1.0;
        let origin = match is_first {
            true => Vector::ZERO,
            false => self.origin - along * gain,
        };
        let force = origin + direction(progress) * (self.scale * carried);
        let peak = self.peak + gain;
        // The first curve continues where it was left.
        let rejoins = !is_first && force.norm() >= peak;
        let origin = if rejoins { Vector::ZERO } else { origin };
        (force, origin, peak)
    }
}

impl TangentialLaw for MindlinDeresiewiczLaw {
    const USES_CONTACT_RADIUS: bool = true;
    const BY_INCREMENTS: bool = false;
    type History = SlipHistory;

    fn with_coefficient(self, coefficient: f64) -> Self {
        Self {
            coefficient,
            ..self
        }
    }

    #[inline(always)]
    fn load_and_turn(&self, touch: &Touch, spring: Spring, turning: &mut Turning) -> LoadedSpring {
        let limit = self.coefficient * touch.normal_force;
        if !(limit > 0.0) {
            *turning = Turning::default();
            return LoadedSpring::default();
        }
        let stiffness = self.modulus * touch.contact_radius;
        let way = touch.loading_velocity * -touch.loading_time;
        let displacement = way * (stiffness / (1.5 * limit));
        let before = self.coefficient * turning.normal_force;
        let branch = Branch::of(spring.force, turning, limit, before);
        let (force, origin, peak) = branch.moved(displacement, spring.force, limit, before);
        *turning = Turning {
            force: origin,
            normal_force: touch.normal_force,
            peak,
        };
        LoadedSpring {
            elastic: force,
            drag: Vector::ZERO,
            limit,
        }
    }

    #[inline(always)]
    fn stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        self.modulus * contact_radius(overlap, effective_radius)
    }

    /// The work that the contact does when it is unloaded to zero at its normal force.
    fn energy(&self, history: &SlipHistory, overlap: f64, effective_radius: f64) -> f64 {
        let limit = self.coefficient * history.turning.normal_force;
        let stiffness = self.stiffness(overlap, effective_radius);
        let force = history.spring.force.norm();
        if !(limit > 0.0 && stiffness > 0.0) {
            return 0.0;
        }
        let left = (1.0 - 0.5 * force / limit).max(0.0);
        let square = two_thirds(left);
        let first = 1.5 * (force - 2.0 * limit) * (1.0 - square);
        let second = 1.2 * limit * (1.0 - left * square);
        2.0 * limit / stiffness * (first + second)
    }
}

#[cfg(test)]
mod tests;
