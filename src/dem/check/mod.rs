//! Problems of a scene that only the engine can find: the time step and the start.

mod bounds;
mod feed;
mod start;
mod step;

pub(crate) use step::SAFETY_FACTOR;

use crate::document::Problem;
use crate::scene::Scene;

impl Scene {
    /// All problems of this scene. A scene without problems can be run.
    ///
    /// Radii and starts that are still file names are not checked.
    pub fn problems(&self) -> Vec<Problem> {
        match self.problems_of_values() {
            problems if problems.is_empty() => self.problems_in_range(),
            problems => problems,
        }
    }

    /// The same for a scene whose numbers are known to be within their ranges.
    pub(crate) fn problems_in_range(&self) -> Vec<Problem> {
        if self.is_external() {
            return self.problems_of_program();
        }
        let mut problems = Vec::new();
        self.check_all_but_step(&mut problems);
        self.check_whole_steps(&mut problems);
        if problems.is_empty() {
            self.check_time_step(&mut problems);
        }
        problems
    }

    /// All problems of this scene except a time step above its limit. A scene without these
    /// problems can be run, stable or not.
    pub(crate) fn problems_but_of_limit(&self) -> Vec<Problem> {
        let mut problems = self.problems_of_values();
        if problems.is_empty() && self.is_external() {
            return self.problems_of_program();
        }
        if problems.is_empty() {
            self.check_all_but_step(&mut problems);
            self.check_whole_steps(&mut problems);
        }
        problems
    }

    fn check_all_but_step(&self, problems: &mut Vec<Problem>) {
        self.check_relations(problems);
        self.check_room(problems);
        self.check_feed_place(problems);
        self.check_bounds(problems);
        self.check_packing_beside_fixed(problems);
        if problems.is_empty() {
            self.check_overlaps(problems);
        }
    }

    /// The scene to run, checked. If `time.safety_factor` is set, the time step is chosen: the
    /// largest step that is at most this factor times every limit in
    /// [`timestep::limits`](crate::dem::timestep::limits) and that divides the intervals of frames
    /// and of the feed. The returned scene has a number as its step and no safety factor. Times
    /// that the scene gives in periods of its shaking become numbers too.
    ///
    /// # Errors
    /// [`Scene::problems`] of the returned scene; also if a step must be chosen but nothing limits
    /// it, or no step divides both intervals.
    pub fn with_chosen_step(self) -> Result<Self, Vec<Problem>> {
        accept(self.problems_of_values())?;
        self.with_chosen_step_in_range()
    }

    /// The same for a scene whose numbers are known to be within their ranges.
    pub(crate) fn with_chosen_step_in_range(mut self) -> Result<Self, Vec<Problem>> {
        if self.spot.is_some() {
            self.time.dt = self.time.frame_interval;
        }
        self.set_times_of_shaking();
        if let Some(safety_factor) = self.time.safety_factor {
            let mut problems = Vec::new();
            self.check_all_but_step(&mut problems);
            accept(problems)?;
            let step = self.chosen_step(safety_factor);
            self.time.dt = step.map_err(|problem| vec![problem])?;
            self.time.safety_factor = None;
        }
        accept(self.problems_in_range())?;
        self.forget_periods();
        Ok(self)
    }
}

/// Nothing if there are no problems, else the problems.
fn accept(problems: Vec<Problem>) -> Result<(), Vec<Problem>> {
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems)
    }
}
