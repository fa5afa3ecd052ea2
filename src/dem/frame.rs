//! The present state, as observers see it.

use super::DemSimulation;
use super::order;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::simulation::{FRAME_BLOCK, Flow, Frame, FrameView, Ledger};

/// Spheres in a block of a sorted scene.
const SOME: usize = 1024;

const _: () = assert!(SOME.is_multiple_of(FRAME_BLOCK));

/// The values of a frame that do not belong to single spheres.
#[derive(Clone, Copy)]
struct FrameTotals {
    elastic_energy: f64,
    ledger: Option<Ledger>,
    flow: Option<Flow>,
}

impl DemSimulation {
    /// Everything an observer may see now.
    pub fn frame(&mut self) -> FrameView<'_> {
        let about = self.about();
        let mut components = std::mem::take(&mut self.components);
        components.iter_mut().flatten().for_each(Vec::clear);
        let particles = self.particles();
        if self.is_sorted() {
            self.sorted_frame(about).show(&mut |block| {
                let vectors = [
                    block.position,
                    block.velocity,
                    block.spin.unwrap_or_default(),
                ];
                let all = components.iter_mut().flatten();
                for (component, values) in all.zip(vectors.iter().flatten()) {
                    component.extend_from_slice(values);
                }
            });
        } else {
            for (components, vectors) in components.iter_mut().zip(vectors(particles)) {
                components[0].extend(vectors.iter().map(|vector| vector.x));
                components[1].extend(vectors.iter().map(|vector| vector.y));
                components[2].extend(vectors.iter().map(|vector| vector.z));
            }
        }
        self.components = components;
        let particles = self.engine.particles();
        let [radius, mass, inertia] = self.scalars();
        let [position, velocity, spin] = self
            .components
            .each_ref()
            .map(|c| c.each_ref().map(|c| &c[..]));
        FrameView {
            position,
            velocity,
            // Also when all spheres have left.
            spin: (particles.rotate() || !self.inertia.is_empty()).then_some(spin),
            radius,
            mass,
            inertia,
            elastic_energy: about.elastic_energy,
            ledger: about.ledger,
            number: (about.flow).map(|_| &particles.number[particles.fixed..]),
            flow: about.flow,
        }
    }

    /// Shows the same, but a sorted scene in blocks, because it may be too large to be in memory
    /// twice.
    pub(crate) fn with_frame<R>(&mut self, look: impl FnOnce(&dyn Frame) -> R) -> R {
        if self.is_sorted() {
            let about = self.about();
            look(&self.sorted_frame(about))
        } else {
            look(&self.frame())
        }
    }

    fn about(&mut self) -> FrameTotals {
        let contacts = self.engine.contacts();
        FrameTotals {
            elastic_energy: contacts.elastic_energy,
            ledger: self.engine.work().map(|work| Ledger {
                springs: contacts.spring_energy,
                damping: -work.damping,
                friction: -work.tangential - contacts.spring_energy,
                air: work.air,
                shaking: work.shaking,
                walls: work.walls,
                brought: work.brought,
            }),
            flow: self.counts().map(|counts| Flow {
                spheres: counts.all,
                released: counts.released,
                discharged: counts.discharged,
                spilled: counts.spilled,
                contacts: usize::try_from(contacts.of_moving_spheres).unwrap_or(0),
            }),
        }
    }

    /// Whether spheres have another order in memory than in the scene.
    fn is_sorted(&self) -> bool {
        self.process.is_none() && !self.particles().number.is_empty()
    }

    fn sorted_frame(&self, about: FrameTotals) -> SortedFrame<'_> {
        let particles = self.particles();
        SortedFrame {
            places: order::places(&particles.number[particles.fixed..]),
            particles,
            scalars: self.scalars(),
            about,
        }
    }

    /// Radii, masses and moments of inertia of the spheres that move, in the order of the scene.
    fn scalars(&self) -> [&[f64]; 3] {
        let particles = self.particles();
        match self.is_sorted() && !self.radius.is_empty() {
            true => [&self.radius, &self.mass, &self.inertia],
            false => [&particles.radius, &particles.mass, &particles.inertia]
                .map(|values| of_moving(values, particles)),
        }
    }
}

/// A frame of spheres that have another order in memory.
struct SortedFrame<'a> {
    particles: &'a Particles,
    /// Where the spheres are, in the order of the scene.
    places: Vec<u32>,
    /// In the order of the scene.
    scalars: [&'a [f64]; 3],
    about: FrameTotals,
}

impl Frame for SortedFrame<'_> {
    fn count(&self) -> usize {
        self.places.len()
    }

    fn show(&self, look: &mut dyn FnMut(&FrameView<'_>)) {
        let mut columns = vec![[0.0; SOME]; 9];
        let FrameTotals {
            elastic_energy,
            ledger,
            flow,
        } = self.about;
        for (places, first) in self.places.chunks(SOME).zip((0..).step_by(SOME)) {
            let all = 0..places.len();
            for (columns, vectors) in columns.chunks_exact_mut(3).zip(vectors(self.particles)) {
                // Without rotation there are no spins.
                let known = places
                    .iter()
                    .filter_map(|&place| vectors.get(place as usize));
                for (k, vector) in known.enumerate() {
                    (columns[0][k], columns[1][k], columns[2][k]) = (vector.x, vector.y, vector.z);
                }
            }
            let [position, velocity, spin] =
                [0, 3, 6].map(|from| [0, 1, 2].map(|axis| &columns[from + axis][all.clone()]));
            let here = first..first + places.len();
            let [radius, mass, inertia] =
                (self.scalars).map(|values| values.get(here.clone()).unwrap_or_default());
            look(&FrameView {
                position,
                velocity,
                spin: self.particles.rotate().then_some(spin),
                radius,
                mass,
                inertia,
                elastic_energy,
                ledger,
                number: None,
                flow,
            });
        }
    }
}

/// Positions, velocities and, with rotation, spins of the spheres that move.
fn vectors(particles: &Particles) -> [&[Vector]; 3] {
    let all = [&particles.position, &particles.velocity, &particles.spin];
    all.map(|vectors| vectors.get(particles.fixed..).unwrap_or_default())
}

/// Values of the spheres that move, where there are any.
pub(super) fn of_moving<'a>(values: &'a [f64], particles: &Particles) -> &'a [f64] {
    values.get(particles.fixed..).unwrap_or_default()
}
