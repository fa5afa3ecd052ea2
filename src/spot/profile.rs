//! Times of the parts of a drainage by spots, measured on request.
//!
//! Moves are many and short: one in 256 is measured, divided into the motion of the spot and the
//! relaxation around it. Rare and long operations, relaxing or sorting all spheres, are measured
//! each time.

use crate::simulation::{PartOfStep, Profile};

/// A part of a drainage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DrainagePart {
    /// Spots choose their steps and move spheres in the opposite direction.
    Spots,
    /// Overlaps are removed.
    Relaxation,
    /// Spheres are sorted by cells.
    Order,
}

impl DrainagePart {
    const ALL: [Self; 3] = [Self::Spots, Self::Relaxation, Self::Order];

    fn name(self) -> &'static str {
        match self {
            Self::Spots => "spots",
            Self::Relaxation => "relaxation",
            Self::Order => "order of spheres",
        }
    }
}

/// The parts of a drainage, with or without relaxation.
pub(super) fn parts(relaxes: bool) -> Vec<PartOfStep> {
    let part = |part: DrainagePart| PartOfStep {
        name: part.name(),
        is_present: part != DrainagePart::Relaxation || relaxes,
        // Work done once per frame counts as theirs.
        is_between_steps: part == DrainagePart::Spots,
    };
    DrainagePart::ALL.map(part).to_vec()
}

/// A profile, if there is one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clock(Option<Box<MeasuredMoves>>);

#[derive(Clone, Debug)]
struct MeasuredMoves {
    profile: Profile,
    /// Moves begun so far.
    begun: u64,
}

impl Clock {
    /// One that measures from now on.
    pub(super) fn started() -> Self {
        Self(Some(Box::new(MeasuredMoves {
            profile: Profile::new(DrainagePart::ALL.len(), DrainagePart::Spots as usize),
            begun: 0,
        })))
    }

    pub(super) fn profile(&self) -> Option<&Profile> {
        self.0.as_ref().map(|it| &it.profile)
    }

    pub(super) fn enter(&mut self) {
        self.each(|it| it.profile.enter());
    }

    pub(super) fn leave(&mut self) {
        self.each(|it| it.profile.leave());
    }

    /// Begins a move, which may be measured.
    #[inline(always)]
    pub(super) fn begin_move(&mut self) {
        self.each(|it| {
            it.begun += 1;
            it.profile.sample(it.begun, 1);
        });
    }

    /// Ends a part of a move.
    #[inline(always)]
    pub(super) fn mark(&mut self, part: DrainagePart) {
        self.each(|it| it.profile.mark(part as usize));
    }

    /// Counts a move that was made.
    #[inline(always)]
    pub(super) fn count_move(&mut self) {
        self.each(|it| it.profile.count(1));
    }

    /// Begins an operation that is measured each time.
    pub(super) fn begin_whole(&mut self) {
        self.each(|it| it.profile.begin_whole());
    }

    /// Ends it; all of its time belongs to one part.
    pub(super) fn end_whole(&mut self, part: DrainagePart) {
        self.each(|it| it.profile.end_whole(part as usize));
    }

    #[inline(always)]
    fn each(&mut self, then: impl FnOnce(&mut MeasuredMoves)) {
        if let Some(measured) = &mut self.0 {
            then(measured);
        }
    }
}
