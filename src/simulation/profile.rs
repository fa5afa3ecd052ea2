//! Times of the parts of a step, measured on request.

use crate::cpu_time;

/// A part of a model's step that costs time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartOfStep {
    /// Its name in tables.
    pub name: &'static str,
    /// Whether the scene has it. An absent part costs nothing.
    pub is_present: bool,
    /// Whether it works between the steps, so that the time between them belongs to it.
    pub is_between_steps: bool,
}

/// A profile of a running engine.
///
/// The total is the processor time of the thread. Its division into parts is measured in some of
/// the steps, in which the clock is read between the parts; the other steps run as usual. The time
/// to read the clock is subtracted everywhere.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Time of one reading of the clock (s).
    reading: f64,
    /// Times of the parts in the steps that were measured (s).
    looked_at: Vec<f64>,
    /// Times of the parts that are measured each time (s).
    whole: Vec<f64>,
    /// When such a part began (s).
    begun: f64,
    /// The part to which all time belongs if no step was measured.
    rest: usize,
    /// The latest reading, while a step is measured (s).
    latest: Option<f64>,
    readings: u64,
    /// When the engine was entered (s).
    entered: f64,
    /// Time in the engine so far (s), readings included.
    inside: f64,
    work: u64,
}

/// Number of readings from which the time of one is found.
const TRIALS: u32 = 2000;

impl Profile {
    /// An empty profile with this number of parts. If no step is measured, all time belongs to the
    /// part `rest`.
    pub fn new(parts: usize, rest: usize) -> Self {
        let started = cpu_time::of_this_thread();
        for _ in 1..TRIALS {
            std::hint::black_box(cpu_time::of_this_thread());
        }
        let trials = cpu_time::of_this_thread() - started;
        Self {
            reading: trials / f64::from(TRIALS),
            looked_at: vec![0.0; parts],
            whole: vec![0.0; parts],
            begun: 0.0,
            rest,
            latest: None,
            readings: 0,
            entered: 0.0,
            inside: 0.0,
            work: 0,
        }
    }

    /// Time in the engine (s).
    pub fn seconds(&self) -> f64 {
        self.inside - self.readings as f64 * self.reading
    }

    /// Total time of reading the clock (s).
    pub fn readings(&self) -> f64 {
        self.readings as f64 * self.reading
    }

    /// Work done in the steps so far: each counts its spheres once.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// The time in the engine, divided into its parts.
    pub fn parts(&self) -> Vec<f64> {
        let all: f64 = self.looked_at.iter().sum();
        let others = (self.seconds() - self.whole.iter().sum::<f64>()).max(0.0);
        let mut parts = self.whole.clone();
        match all > 0.0 {
            true => {
                let looked_at = parts.iter_mut().zip(&self.looked_at);
                looked_at.for_each(|(part, seconds)| *part += seconds * others / all);
            }
            false => parts[self.rest] += others,
        }
        parts
    }

    /// Time of one reading of the clock (s).
    pub fn reading(&self) -> f64 {
        self.reading
    }

    /// Notes that the engine is entered.
    pub fn enter(&mut self) {
        self.entered = cpu_time::of_this_thread();
        self.readings += 1;
    }

    /// Notes that the engine is left.
    pub fn leave(&mut self) {
        self.latest = None;
        self.inside += cpu_time::of_this_thread() - self.entered;
    }

    /// Begins a step that moves this number of spheres, and decides whether to measure it.
    pub fn begin(&mut self, step: u64, spheres: usize) {
        self.count(spheres as u64);
        self.sample(step, spheres);
    }

    /// Counts work.
    pub fn count(&mut self, work: u64) {
        self.work += work;
    }

    /// Decides whether to measure a step of this number of spheres.
    #[inline(never)]
    pub fn sample(&mut self, step: u64, spheres: usize) {
        // The clock is read a dozen times for 128 spheres, half a microsecond each, in a step of
        // about 50 ns per sphere: with at most one step in 16 this adds a few percent.
        let period = (8192 / spheres.max(1) as u64).clamp(16, 256);
        // Multiples of the golden ratio are spread evenly over any rhythm of steps, such as the
        // rebuilds of the neighbour list.
        let spread = (step + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.latest = (spread < u64::MAX / period).then(|| {
            self.readings += 1;
            cpu_time::of_this_thread()
        });
    }

    /// Begins an operation that is measured each time, between the sampled steps.
    pub fn begin_whole(&mut self) {
        self.readings += 1;
        self.begun = cpu_time::of_this_thread();
    }

    /// Ends it; all of its time belongs to one part.
    pub fn end_whole(&mut self, part: usize) {
        self.readings += 1;
        let seconds = cpu_time::of_this_thread() - self.begun - self.reading;
        self.whole[part] += seconds.max(0.0);
    }

    /// Ends a part of a step.
    #[inline(never)]
    pub fn mark(&mut self, part: usize) {
        if let Some(latest) = self.latest {
            let now = cpu_time::of_this_thread();
            self.readings += 1;
            self.looked_at[part] += (now - latest - self.reading).max(0.0);
            self.latest = Some(now);
        }
    }
}
