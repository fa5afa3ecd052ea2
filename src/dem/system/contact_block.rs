//! Blocks of contacts: the laws for many pairs at once.
//!
//! The laws are computed for all pairs of a block, in a loop that the compiler turns into vector
//! instructions. A pair that does not touch gets a force of zero. Then the forces are added one by
//! one in the order of the list. Adding zero to a sum that began at +0 changes no bit of it.

mod gather;
mod scatter;
mod springs;
mod walls;

use super::contact_geometry::{ContactGeometry, Roots};
use super::contact_laws::{ContactForce, Laws, LoadedContact};
use super::contact_state::{ContactState, EarlierMotion, SphereProperties};
use super::contact_task::TooDeep;
use super::lanes::{PropertyColumns, WallContactColumns};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw, Turning};
use crate::particles::block::{BLOCK, BlockColumn, VectorColumns, VectorRow};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use std::marker::PhantomData;

/// Marks an overlap within the limit. No touching pair has a negative overlap.
const NOT_DEEP: f64 = -1.0;

/// Velocity and spin of a sphere before an evaluation of forces, in rows.
pub(super) type EarlierRows = [VectorRow; 2];

/// Everything about the pairs of a block.
pub(super) struct ContactBlock<H> {
    /// Offset of the first centre from the second, or from the origin at a wall (m).
    offset: VectorColumns,
    /// Velocity of the first relative to the second (m/s).
    velocity: VectorColumns,
    /// Spins of both (rad/s).
    spin: [VectorColumns; 2],
    /// Earlier velocities and spins, if they load springs.
    earlier_velocity: VectorColumns,
    earlier_spin: [VectorColumns; 2],
    /// Properties of both, which do not change from step to step.
    properties: [PropertyColumns; 2],
    /// Whether all spheres are alike, and whether the latest pairs of such spheres had fixed ones.
    alike: bool,
    has_fixed: bool,
    /// 1 / (r1 + r2) of a pair (1/m).
    inverse_sum: BlockColumn,
    /// [`Roots`] of every pair.
    inverse_distance: BlockColumn,
    contact_radius: BlockColumn,
    effective_mass: BlockColumn,
    /// Contacts with a wall, present and earlier.
    wall_contact: WallContactColumns,
    earlier_wall_contact: WallContactColumns,
    /// Forces of springs (N), and the contact radii (m) for which they hold, if the law has these.
    spring: VectorColumns,
    spring_radius: BlockColumn,
    /// [`Turning`] of every contact, if the law has it.
    turning_force: VectorColumns,
    turning_normal_force: BlockColumn,
    turning_peak: BlockColumn,
    /// For friction with a history: forces of dashpots (N), limits of friction (N), squared forces
    /// of spring and dashpot (N2), the inverse roots of these squares, and levers in radii.
    drag: VectorColumns,
    limit: BlockColumn,
    squared: BlockColumn,
    inverse_root: BlockColumn,
    lever: BlockColumn,
    force: VectorColumns,
    torque: [VectorColumns; 2],
    /// Overlap of a pair beyond the limit (m), else [`NOT_DEEP`].
    too_deep: BlockColumn,
    history: PhantomData<H>,
}

impl<H: History> ContactBlock<H> {
    /// Whether the law has a history.
    pub(super) const HAS_HISTORY: bool = size_of::<H>() > 0;

    pub(super) fn new() -> Self {
        let pair = || [VectorColumns::ZERO, VectorColumns::ZERO];
        Self {
            offset: VectorColumns::ZERO,
            velocity: VectorColumns::ZERO,
            spin: pair(),
            earlier_velocity: VectorColumns::ZERO,
            earlier_spin: pair(),
            properties: [
                PropertyColumns::all(SphereProperties::WALL),
                PropertyColumns::all(SphereProperties::WALL),
            ],
            alike: false,
            has_fixed: false,
            inverse_sum: [0.0; BLOCK],
            inverse_distance: [0.0; BLOCK],
            contact_radius: [0.0; BLOCK],
            effective_mass: [0.0; BLOCK],
            wall_contact: WallContactColumns::NONE,
            earlier_wall_contact: WallContactColumns::NONE,
            spring: VectorColumns::ZERO,
            spring_radius: [0.0; BLOCK],
            turning_force: VectorColumns::ZERO,
            turning_normal_force: [0.0; BLOCK],
            turning_peak: [0.0; BLOCK],
            drag: VectorColumns::ZERO,
            limit: [0.0; BLOCK],
            squared: [0.0; BLOCK],
            inverse_root: [0.0; BLOCK],
            lever: [0.0; BLOCK],
            history: PhantomData,
            force: VectorColumns::ZERO,
            torque: pair(),
            too_deep: [NOT_DEEP; BLOCK],
        }
    }

    /// Sets the properties of all spheres, if they are alike. These are then not gathered.
    pub(super) fn set_alike<N: NormalLaw, T: TangentialLaw>(
        &mut self,
        alike: Option<SphereProperties>,
    ) {
        self.alike = alike.is_some();
        self.has_fixed = false;
        if let Some(properties) = alike {
            self.properties = [
                PropertyColumns::all(properties),
                PropertyColumns::all(properties),
            ];
            self.spin[1] = VectorColumns::ZERO;
            self.inverse_sum = [1.0 / (properties.radius + properties.radius); BLOCK];
            self.effective_mass = [Laws::<N, T>::effective_mass([properties, properties]); BLOCK];
        }
    }

    /// Applies the laws to every pair.
    #[inline(always)]
    pub(super) fn apply_laws<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        // Two loops, because a branch in a loop would prevent vector instructions.
        match Self::HAS_HISTORY && laws.loading.age > 0.0 {
            true => self.apply_laws_as::<N, T, true>(laws),
            false => self.apply_laws_as::<N, T, false>(laws),
        }
    }

    #[inline(always)]
    fn apply_laws_as<N: NormalLaw, T: TangentialLaw<History = H>, const EARLIER: bool>(
        &mut self,
        laws: &Laws<N, T>,
    ) {
        for k in 0..BLOCK {
            let offset = self.offset.vector(k);
            self.inverse_distance[k] = inverse_square_root(offset.norm_squared());
        }
        if N::USES_CONTACT_RADIUS || T::USES_CONTACT_RADIUS {
            for k in 0..BLOCK {
                let state = self.contact_state::<T, false>(k, self.properties[1].at(k));
                self.contact_radius[k] = laws.contact_radius(&state, self.inverse_distance[k]);
            }
        }
        self.bring_springs(
            laws.tangential.keeps(),
            #[inline(always)]
            |block, k| block.contact_radius[k],
            #[inline(always)]
            |block, k, spring, change| match EARLIER {
                true => {
                    let state = block.contact_state::<T, EARLIER>(k, block.properties[1].at(k));
                    let turn = laws.turn_of_pair(&state, block.inverse_distance[k]);
                    spring.turned_by(block.normal(k), turn, change)
                }
                false => spring.turned_to(block.normal(k), change),
            },
        );
        for k in 0..BLOCK {
            let state = self.contact_state::<T, EARLIER>(k, self.properties[1].at(k));
            let geometry = laws.geometry(&state, self.roots(k));
            self.apply_laws_to(k, laws, &state, &geometry);
        }
        match self.alike {
            true => self.add_friction_to_all::<T, true>(Self::normal),
            false => self.add_friction_to_all::<T, false>(Self::normal),
        }
    }

    /// The state of a contact whose second partner has the properties `other`. It includes the
    /// earlier motion if this loads springs.
    #[inline(always)]
    fn contact_state<T: TangentialLaw, const EARLIER: bool>(
        &self,
        k: usize,
        other: SphereProperties,
    ) -> ContactState {
        let mut state = ContactState {
            offset: self.offset.vector(k),
            velocity: self.velocity.vector(k),
            spin: [Vector::ZERO; 2],
            properties: [self.properties[0].at(k), other],
            inverse_sum: self.inverse_sum[k],
            earlier: None,
        };
        if T::ROTATES {
            state.spin = [0, 1].map(|side| self.spin[side].vector(k));
        }
        if EARLIER {
            state.earlier = Some(EarlierMotion {
                velocity: self.earlier_velocity.vector(k),
                spin: [0, 1].map(|side| self.earlier_spin[side].vector(k)),
            });
        }
        state
    }

    /// Unit normal of a pair.
    #[inline(always)]
    fn normal(&self, k: usize) -> Vector {
        self.offset.vector(k) * self.inverse_distance[k]
    }

    #[inline(always)]
    fn roots(&self, k: usize) -> Roots {
        Roots {
            inverse_distance: self.inverse_distance[k],
            contact_radius: self.contact_radius[k],
            effective_mass: self.effective_mass[k],
        }
    }

    /// Applies the laws to a contact; friction with a history is only loaded.
    #[inline(always)]
    fn apply_laws_to<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        k: usize,
        laws: &Laws<N, T>,
        state: &ContactState,
        geometry: &ContactGeometry,
    ) {
        let spring = self.spring(k);
        match Self::HAS_HISTORY {
            true => {
                let mut turning = self.turning(k);
                let loaded = laws.load(state, geometry, spring, &mut turning);
                self.store_loaded::<T>(k, &loaded);
                self.set_turning(k, if_loaded(&loaded, turning));
            }
            false => self.store_force::<T>(k, &laws.force(state, geometry, H::of_spring(spring))),
        }
    }

    /// Stores force and torques of a contact.
    #[inline(always)]
    fn store_force<T: TangentialLaw>(&mut self, k: usize, contact: &ContactForce) {
        let touches = contact.touches;
        self.too_deep[k] = if contact.too_deep {
            contact.overlap
        } else {
            NOT_DEEP
        };
        store(&mut self.force, k, touches, contact.force);
        if T::ROTATES {
            store(&mut self.torque[0], k, touches, contact.torque[0]);
            store(&mut self.torque[1], k, touches, contact.torque[1]);
        }
    }

    /// The first of these contacts that is beyond the overlap limit: its sphere and overlap.
    /// `sphere_of` returns the sphere of a lane, if forces move it.
    #[inline(always)]
    pub(super) fn first_too_deep(
        &self,
        contacts: usize,
        sphere_of: impl Fn(usize) -> Option<usize>,
    ) -> TooDeep {
        let any = |any, &overlap: &f64| any | (overlap != NOT_DEEP);
        if !self.too_deep.iter().fold(false, any) {
            return None;
        }
        let mut deep = (0..contacts).filter(|&k| self.too_deep[k] != NOT_DEEP);
        deep.find_map(|k| Some((sphere_of(k)?, self.too_deep[k])))
    }
}

/// What a contact remembers, or zero if the two do not touch.
#[inline(always)]
fn if_loaded(loaded: &LoadedContact, turning: Turning) -> Turning {
    match loaded.touches {
        true => turning,
        false => Turning::default(),
    }
}

/// Stores what acts on a touching pair.
#[inline(always)]
fn store(columns: &mut VectorColumns, k: usize, touches: bool, vector: Vector) {
    let [x, y, z] = &mut columns.0;
    x[k] = if_touching(touches, vector.x);
    y[k] = if_touching(touches, vector.y);
    z[k] = if_touching(touches, vector.z);
}

/// `value`, or zero. The compiler turns a plain `if` into masked stores, which take some 20 cycles
/// each without AVX-512.
#[inline(always)]
fn if_touching(touches: bool, value: f64) -> f64 {
    std::hint::select_unpredictable(touches, value, 0.0)
}
