//! The discrete element method as a model of the program.

use super::DemSimulation;
use super::columns::ContactColumns;
use super::profile;
use super::simplifications::simplifications;
use super::work::sphere_steps;
use crate::forces::simplification::Simplification;
use crate::scene::Scene;
use crate::simulation::{
    BuildError, Column, Counts, Frame, Instability, Milestone, Model, PartOfStep, Profile,
    Simulation, StateError,
};
use rayon::ThreadPoolBuildError;
use std::io;

/// The discrete element method.
#[derive(Clone, Copy, Debug)]
pub struct Dem;

impl Model for Dem {
    fn work_unit(&self) -> &'static str {
        "sphere-steps"
    }

    fn work_of(&self, scene: &Scene) -> u64 {
        sphere_steps(scene)
    }

    fn parts_of(&self, scene: &Scene) -> Vec<PartOfStep> {
        profile::parts_of(scene)
    }

    fn simplifications(&self, scene: &Scene) -> Vec<Simplification> {
        simplifications(scene)
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let simulation = DemSimulation::new(scene).map_err(BuildError::new)?;
        Ok(Box::new(simulation))
    }
}

impl Simulation for DemSimulation {
    fn advance_frame(&mut self) -> Result<(), Instability> {
        self.advance(self.steps_per_frame)
    }

    fn time(&self) -> f64 {
        self.time()
    }

    fn ended(&self) -> bool {
        self.ended()
    }

    fn work(&self) -> u64 {
        self.moves()
    }

    fn radius(&self) -> &[f64] {
        self.radius()
    }

    fn mass(&self) -> &[f64] {
        self.mass()
    }

    fn look(&mut self, look: &mut dyn FnMut(&dyn Frame)) {
        self.with_frame(look);
    }

    fn columns(&self) -> &[Column] {
        self.columns.as_ref().map_or(&[], ContactColumns::declared)
    }

    fn values(&mut self) -> Vec<f64> {
        let engine = self.engine.as_mut();
        let columns = self.columns.as_mut();
        columns.map_or_else(Vec::new, |columns| columns.values(engine))
    }

    fn save(&self, to: &mut dyn io::Write) -> io::Result<()> {
        let written = postcard::to_io(&self.state(), to);
        written.map(drop).map_err(io::Error::other)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        match postcard::take_from_bytes(state) {
            Ok((state, [])) => self.restore(state),
            _ => Err(StateError::OTHER_FORM),
        }
    }

    fn counts(&self) -> Option<Counts> {
        self.counts()
    }

    fn milestones(&self) -> &[Milestone] {
        self.milestones()
    }

    fn use_threads(&mut self, threads: usize) -> Result<(), ThreadPoolBuildError> {
        self.use_threads(threads)
    }

    fn seconds_of_threads(&self) -> f64 {
        self.seconds_of_threads()
    }

    fn release_memory(&mut self) {
        self.engine.forget_contacts();
    }

    fn keep_profile(&mut self) {
        self.engine.keep_profile(profile::new_profile());
    }

    fn profile(&self) -> Option<&Profile> {
        self.engine.profile()
    }
}
