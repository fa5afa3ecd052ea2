//! The threads of a simulation.

use super::crew::Crew;
use rayon::prelude::*;
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};

/// Several threads, or none with one thread.
#[derive(Debug, Default)]
pub(crate) struct Workers {
    crew: Option<Crew>,
}

impl Workers {
    pub(crate) fn new(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        if threads <= 1 {
            return Ok(Self::default());
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(Self {
            crew: Some(Crew::new(pool)),
        })
    }

    /// The threads, if there are several.
    pub(crate) fn crew(&mut self) -> Option<&mut Crew> {
        self.crew.as_mut()
    }

    pub(crate) fn are_several(&self) -> bool {
        self.crew.is_some()
    }

    /// Lets parallel loops inside use these threads.
    pub(crate) fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.crew {
            Some(crew) => crew.pool().install(work),
            None => work(),
        }
    }
}

/// Does the work of each item, on the threads of the present pool if there is one.
pub(crate) fn in_parallel<I: Send>(items: &mut [I], work: &(impl Fn(&mut I) + Sync)) {
    if rayon::current_thread_index().is_none() {
        items.iter_mut().for_each(work);
    } else {
        items.par_iter_mut().for_each(work);
    }
}
