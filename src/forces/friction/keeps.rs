//! What a tangential spring keeps while its stiffness changes.

use super::{History, Spring, Touch};
use crate::particles::block::VectorRow;
use crate::particles::vector::Vector;
use serde::{Deserialize, Serialize};

/// What a tangential spring keeps when the contact radius, to which its stiffness is proportional,
/// changes and the surfaces do not slide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// Its force. Releasing the contact creates energy, because the energy is f^2 / (2 k).
    Force,
    /// Its displacement. Pressing the contact harder creates energy, because the energy is k u^2
    /// / 2.
    Displacement,
    /// Its force while the contact is pressed harder, and its displacement while it is released: it
    /// never creates energy (Elata and Berryman, Mech. Mater. 24, 229 (1996); Thornton, Cummins and
    /// Cleary, Powder Technol. 233, 30 (2013)).
    Lesser,
}

impl Keeps {
    /// How the force of a spring changes with the contact radius (m). A new contact had a radius of
    /// zero and no force before.
    #[inline(always)]
    pub(crate) fn change(self, before: f64, now: f64) -> ForceChange {
        match self {
            Self::Force => ForceChange::NONE,
            Self::Displacement => ForceChange {
                from: before,
                to: now,
            },
            Self::Lesser => ForceChange {
                from: before,
                to: lesser(now, before),
            },
        }
    }

    /// The contact radius (m) at which sliding loads the spring: the mean radius since the last
    /// evaluation while it keeps its force, and the present radius while it keeps its displacement.
    /// The mean is the smaller of the two while the contact is pressed harder.
    #[inline(always)]
    pub(super) fn loading_radius(self, touch: &Touch) -> f64 {
        match self {
            Self::Force => touch.loading_radius,
            Self::Displacement => touch.contact_radius,
            Self::Lesser => lesser(touch.loading_radius, touch.contact_radius),
        }
    }
}

/// A change of a spring's force by the factor `to` / `from`; the force is zero if `from` is zero.
/// The quotient is part of the root by which a spring [turns](Spring::turned_to), and so costs no
/// time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ForceChange {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl ForceChange {
    /// No change.
    pub(crate) const NONE: Self = Self { from: 1.0, to: 1.0 };

    fn factor(self) -> f64 {
        match self.from > 0.0 {
            true => self.to / self.from,
            false => 0.0,
        }
    }
}

/// The minimum as a select, which loops over contacts turn into vector instructions.
#[inline(always)]
fn lesser(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// A spring and the contact radius (m) at which it had its force, in one row of memory.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
#[repr(C, align(32))]
pub struct SpringAtRadius {
    row: VectorRow,
}

impl SpringAtRadius {
    /// Its energy (J), for a stiffness of `modulus` (Pa) times the contact radius (m).
    pub(super) fn energy(&self, keeps: Keeps, modulus: f64, contact_radius: f64) -> f64 {
        let factor = keeps.change(self.radius(), contact_radius).factor();
        self.spring().energy(modulus * contact_radius) * factor * factor
    }
}

impl History for SpringAtRadius {
    const HAS_RADIUS: bool = true;

    #[inline(always)]
    fn spring(self) -> Spring {
        let [x, y, z, _] = self.row;
        Spring {
            force: Vector::new(x, y, z),
        }
    }

    #[inline(always)]
    fn of_spring(spring: Spring) -> Self {
        let Vector { x, y, z, .. } = spring.force;
        Self {
            row: [x, y, z, 0.0],
        }
    }

    #[inline(always)]
    fn radius(self) -> f64 {
        self.row[3]
    }

    #[inline(always)]
    fn row(self) -> VectorRow {
        self.row
    }

    #[inline(always)]
    fn of_row(row: VectorRow) -> Self {
        Self { row }
    }

    fn turned_round(self) -> Self {
        let [x, y, z, radius] = self.row;
        Self {
            row: [-x, -y, -z, radius],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forces::friction::{MindlinLaw, SilbertFrictionLaw, TangentialLaw};
    use crate::particles::math::inverse_square_root;

    /// k_t (Pa).
    const MODULUS: f64 = 1e6;

    fn touch(contact_radius: f64, loading_radius: f64, way: f64) -> Touch {
        let velocity = Vector::new(way, 0.0, 0.0);
        Touch {
            normal: Vector::new(0.0, 0.0, 1.0),
            velocity,
            spin: [Vector::ZERO; 2],
            lever: [0.01, 0.0],
            inertia: [1e-6, 0.0],
            lesser_mass: 1e-3,
            effective_mass: 1e-3,
            normal_force: 1e3,
            force_along_normal: 1e3,
            loading_velocity: velocity,
            contact_radius,
            loading_radius,
            loading_time: 1.0,
        }
    }

    /// The work (J) of a contact's force along straight lines through these places and contact
    /// radii (m), in steps.
    fn given<T: TangentialLaw<History = SpringAtRadius>>(law: &T, path: &[[f64; 2]]) -> f64 {
        const STEPS: u32 = 1000;
        let mut history = SpringAtRadius::default();
        let (mut given, mut before) = (0.0, 0.0);
        for line in path.windows(2) {
            let way = (line[1][0] - line[0][0]) / f64::from(STEPS);
            let wider = (line[1][1] - line[0][1]) / f64::from(STEPS);
            for step in 0..STEPS {
                let radius = line[0][1] + wider * f64::from(step + 1);
                let touch = touch(radius, radius - 0.5 * wider, way);
                let change = law.keeps().change(history.radius(), radius);
                let spring = history.spring().turned_to(touch.normal, change);
                let loaded = law.load(&touch, spring);
                let squared = loaded.squared();
                let (force, left) = loaded.capped(squared, inverse_square_root(squared));
                let Vector { x, y, z, .. } = left.force;
                history = SpringAtRadius::of_row([x, y, z, radius]);
                given += 0.5 * (before + force.x) * way;
                before = force.x;
            }
        }
        given
    }

    /// Loads a contact at one radius and unloads it at another: at a constant radius k_t a u^2 / 2
    /// is taken or given.
    #[test]
    fn closed_paths_give_what_their_closed_forms_say() {
        let (wide, narrow, far) = (2e-4, 1e-4, 1e-5);
        let energy = 0.5 * MODULUS * (wide - narrow) * far * far;
        // Released while it is loaded, and pressed while it is loaded.
        let released = [[0.0, wide], [far, wide], [far, narrow], [0.0, narrow]];
        let pressed = [[0.0, narrow], [far, narrow], [far, wide], [0.0, wide]];
        let law = SilbertFrictionLaw::new(1.0, MODULUS, 0.0);
        for (keeps, expected) in [
            (Keeps::Force, [energy, -energy]),
            (Keeps::Displacement, [-energy, energy]),
            (Keeps::Lesser, [-energy, -energy]),
        ] {
            for (path, expected) in [released, pressed].iter().zip(expected) {
                let found = given(&law.keeping(keeps), path);
                assert!(
                    (found - expected).abs() < 1e-6 * energy,
                    "{keeps:?} {found:e} {expected:e}"
                );
            }
        }
    }

    /// Random paths from an unloaded contact.
    #[test]
    fn no_path_gives_energy_if_the_spring_rescales() {
        let mindlin = MindlinLaw::new(1.0, 1e6, 0.3).keeping(Keeps::Lesser);
        let silbert = SilbertFrictionLaw::new(1.0, MODULUS, 0.0).keeping(Keeps::Lesser);
        for turn in 1..=60 {
            let angle = |point: u32| f64::from(turn * (point + 3)) * f64::from(point) * 0.7;
            let path: Vec<[f64; 2]> = (0..20)
                .map(|point| {
                    let (sine, cosine) = libm::sincos(angle(point));
                    [1e-5 * sine, 1.5e-4 + 1e-4 * cosine]
                })
                .collect();
            let scale = MODULUS * 1e-4 * 1e-10;
            assert!(given(&mindlin, &path) < 1e-9 * scale);
            assert!(given(&silbert, &path) < 1e-9 * scale);
        }
    }

    #[test]
    fn a_history_keeps_its_radius_when_partners_change_places() {
        let history = SpringAtRadius::of_row([1.0, -2.0, 3.0, 4e-4]);
        let turned = history.turned_round();
        assert_eq!(turned.row, [-1.0, 2.0, -3.0, 4e-4]);
        assert!(!turned.is_new() && SpringAtRadius::default().is_new());
    }
}
