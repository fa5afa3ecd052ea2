//! What happens to the set of spheres while a simulation runs: a feed, a door, an outlet.
//!
//! These things happen between steps, at fixed moments: every [`INTERVAL`] s, and when a sphere is
//! due. So they do not depend on the frames of a run.

mod feed;
mod floor;
mod leak;
mod rest;
mod state;

pub(super) use feed::{Feed, ROUNDING};
pub(super) use leak::wall_pairs;
pub(super) use state::ProcessState;

use self::floor::FloorWatch;
use self::leak::LeakWatch;
use self::rest::RestWatch;
use super::system::Engine;
use crate::particles::Particles;
use crate::scene::Scene;
use crate::simulation::{Counts, Instability, Milestone, MilestoneKind};

/// Time between two checks of the spheres (s). In this time a grain falls a few of its diameters.
const INTERVAL: f64 = 0.01;

/// A feed, a door, an outlet, and the conditions for which they wait.
pub(super) struct Process {
    dt: f64,
    /// Steps between two checks.
    steps: u64,
    feed: Feed,
    /// The door, while it is closed and is to open.
    door: Option<ClosedDoor>,
    rest: Option<RestWatch>,
    outlet: Option<f64>,
    free: Free,
    leak: Option<LeakWatch>,
    floor: Option<FloorWatch>,
    milestones: Vec<Milestone>,
    /// Spheres that were in from the start.
    present: usize,
    discharged: usize,
    spilled: usize,
    ended: bool,
}

/// A closed door.
struct ClosedDoor {
    spheres: std::ops::Range<usize>,
    /// Step at which it opens, if that does not depend on the spheres.
    step: Option<u64>,
}

/// Which spheres move freely. Driven ones keep to their paths: they never leave the scene, may
/// pass walls, and are never at rest.
pub(super) struct Free {
    /// Numbers of the driven spheres, in order.
    driven: Vec<u32>,
    /// Number of free spheres of the scene.
    count: usize,
}

impl Free {
    fn of_scene(scene: &Scene) -> Self {
        let driven = scene.dem.driven.iter().map(|path| path.sphere as u32);
        let mut driven: Vec<u32> = driven.collect();
        driven.sort_unstable();
        Self {
            count: scene.spheres.count - driven.len(),
            driven,
        }
    }

    fn is_free(&self, particles: &Particles, i: usize) -> bool {
        let is_driven = self.driven.binary_search(&particles.number[i]).is_ok();
        i >= particles.fixed && !is_driven
    }

    /// Indices of the free spheres that are in.
    fn indices<'a>(&'a self, particles: &'a Particles) -> impl Iterator<Item = usize> + 'a {
        (particles.fixed..particles.len()).filter(|&i| self.is_free(particles, i))
    }
}

impl Process {
    /// The process of a scene, or `None` if all spheres stay from the start to the end. `present`
    /// moving spheres are in from the start.
    pub(super) fn of_scene(scene: &Scene, feed: Option<Feed>, present: usize) -> Option<Self> {
        let dt = scene.time.dt;
        let active = feed.is_some()
            || scene.dem.door.is_some()
            || scene.dem.rest.is_some()
            || scene.outlet_height().is_some();
        active.then(|| {
            let fixed = scene
                .dem
                .geometry
                .as_ref()
                .map(|geometry| geometry.spheres());
            let fixed = fixed.unwrap_or_default();
            let walls = fixed.walls.len();
            let free = Free::of_scene(scene);
            Self {
                dt,
                steps: ((INTERVAL / dt).round() as u64).max(1),
                feed: feed.unwrap_or_default(),
                door: scene.dem.door.as_ref().map(|door| ClosedDoor {
                    spheres: walls..walls + fixed.door.len(),
                    step: door.opens.map(|time| (time / dt).round() as u64),
                }),
                rest: scene
                    .dem
                    .rest
                    .as_ref()
                    .map(|rest| RestWatch::new(rest, free.count, dt)),
                outlet: scene.outlet_height(),
                free,
                leak: LeakWatch::of_scene(scene, &fixed),
                floor: FloorWatch::of_scene(scene),
                milestones: Vec::new(),
                present,
                discharged: 0,
                spilled: 0,
                ended: false,
            }
        })
    }

    /// The next step after which something may happen.
    fn next_step(&self, step: u64) -> u64 {
        let look = (step / self.steps + 1) * self.steps;
        self.feed.due_after(step).map_or(look, |due| look.min(due))
    }

    /// Whether nothing more will happen: all spheres are in, and all have left or are at rest for
    /// good.
    pub(super) fn ended(&self) -> bool {
        self.ended
    }

    /// How many of `all` spheres of the scene came in and left so far.
    pub(super) fn counts(&self, all: usize) -> Counts {
        Counts {
            all,
            placed: self.present,
            released: self.present + self.feed.released(),
            discharged: self.discharged,
            spilled: self.spilled,
            is_closed: self.door.is_some(),
            can_leave: self.outlet.is_some(),
        }
    }

    /// Events that happened so far.
    pub(super) fn milestones(&self) -> &[Milestone] {
        &self.milestones
    }

    /// Advances an engine to a step and does what is due on the way.
    pub(super) fn advance(&mut self, engine: &mut dyn Engine, end: u64) -> Result<(), Instability> {
        while engine.step() < end {
            let step = engine.step();
            if step == 0 {
                self.act(engine)?;
            }
            engine.advance(self.next_step(step).min(end) - step)?;
            self.act(engine)?;
        }
        Ok(())
    }

    /// Does what is due at the engine's present step.
    fn act(&mut self, engine: &mut dyn Engine) -> Result<(), Instability> {
        let step = engine.step();
        let fed = self.feed.is_empty();
        self.feed.act(engine);
        if !fed && self.feed.is_empty() {
            self.note(step, MilestoneKind::Filled);
        }
        if !step.is_multiple_of(self.steps) {
            return Ok(());
        }
        if let Some(leak) = &mut self.leak {
            leak.check(engine.particles(), &self.free, step, self.dt)?;
        }
        if let (Some(floor), None) = (&mut self.floor, &self.door) {
            floor.check(engine.particles(), &self.free, step, self.dt)?;
        }
        self.discharge(engine);
        let at_rest = match &mut self.rest {
            Some(rest) if self.feed.is_empty() => rest.since(engine.particles(), &self.free, step),
            // Nothing is at rest before all spheres are in.
            Some(rest) => {
                rest.reset();
                None
            }
            None => None,
        };
        if !self.open_door(engine, step, at_rest) {
            self.end(engine.particles(), step, at_rest);
        }
        Ok(())
    }

    fn note(&mut self, step: u64, kind: MilestoneKind) {
        self.milestones.push(Milestone {
            kind,
            time: step as f64 * self.dt,
        });
    }

    /// Removes the spheres that are below the outlet.
    fn discharge(&mut self, engine: &mut dyn Engine) {
        let Some(height) = self.outlet else { return };
        let particles = engine.particles();
        let is_in =
            |i: usize| particles.position[i].z >= height || !self.free.is_free(particles, i);
        let keep: Vec<bool> = (0..particles.len()).map(is_in).collect();
        let gone = keep.iter().filter(|keep| !**keep).count();
        if gone > 0 {
            match self.door {
                Some(_) => self.spilled += gone,
                None => self.discharged += gone,
            }
            engine.retain(&keep);
        }
    }

    /// Opens the door if it is time. Returns whether it did.
    fn open_door(&mut self, engine: &mut dyn Engine, step: u64, at_rest: Option<u64>) -> bool {
        let Some(door) = &self.door else { return false };
        let opens = match door.step {
            Some(time) => step >= time,
            None => at_rest.is_some(),
        };
        if !opens {
            return false;
        }
        let keep: Vec<bool> = (0..engine.particles().len())
            .map(|i| !door.spheres.contains(&i))
            .collect();
        engine.retain(&keep);
        engine.open_doors();
        if let Some(since) = at_rest {
            self.note(since, MilestoneKind::AtRest);
        }
        self.note(step, MilestoneKind::DoorOpened);
        self.door = None;
        if let Some(rest) = &mut self.rest {
            rest.reset();
        }
        if let Some(leak) = &mut self.leak {
            leak.open_door();
        }
        true
    }

    fn end(&mut self, particles: &Particles, step: u64, at_rest: Option<u64>) {
        // If all spheres are driven, nothing can end early.
        if !self.feed.is_empty() || self.ended || self.free.count == 0 {
            return;
        }
        if self.free.indices(particles).next().is_none() {
            // A silo never held grains if all of them fell outside.
            if self.door.is_none() {
                self.note(step, MilestoneKind::Emptied);
            }
            self.ended = true;
        } else if let (Some(since), None) = (at_rest, &self.door) {
            self.note(since, MilestoneKind::AtRest);
            self.ended = true;
        }
    }
}
