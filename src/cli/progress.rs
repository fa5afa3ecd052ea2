//! Progress of the work: a bar on a terminal, otherwise a line from time to time.

use super::console::Console;
use super::format;
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Display;
use std::io::IsTerminal;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Shows how far the work is.
pub(crate) struct Progress<'a> {
    console: &'a Console,
    bar: Option<ProgressBar>,
    state: Mutex<State>,
    started: Instant,
}

/// Work is counted in the unit of the model.
pub(crate) struct Work {
    /// Jobs in all.
    pub(crate) jobs: usize,
    /// Jobs done before.
    pub(crate) jobs_done: usize,
    /// Work in all.
    pub(crate) steps: u64,
    /// Work done before.
    pub(crate) steps_done: u64,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// What the work is part of, such as a round; may be empty.
    pub(crate) head: String,
}

struct State {
    work: Work,
    /// Work done before.
    done_before: u64,
    /// Work that was done now.
    run: u64,
    /// The present activity, if known.
    phase: String,
    /// When the last line was printed, in seconds since the start.
    last_line: f64,
}

impl<'a> Progress<'a> {
    pub(crate) fn new(console: &'a Console, work: Work) -> Self {
        let bar = (!console.is_quiet() && std::io::stderr().is_terminal()).then(|| {
            let style = ProgressStyle::with_template("{bar:20} {msg}");
            let bar = ProgressBar::new(work.steps);
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        let state = Mutex::new(State {
            done_before: work.steps_done,
            work,
            run: 0,
            phase: String::new(),
            last_line: 0.0,
        });
        Self {
            console,
            bar,
            state,
            started: Instant::now(),
        }
    }

    /// Adds work that was done.
    pub(crate) fn advance(&self, steps: u64) {
        self.advance_to(steps, steps, String::new());
    }

    /// Adds `done` steps of the planned work, `run` of them made now, and shows the run's `phase`.
    pub(crate) fn advance_to(&self, run: u64, done: u64, phase: String) {
        let mut state = self.state();
        state.run += run;
        state.work.steps_done += done;
        state.phase = phase;
        self.show(state);
    }

    /// The amount of work that was done before.
    pub(crate) fn skip(&self, steps: u64) {
        let mut state = self.state();
        state.work.steps_done += steps;
        state.done_before += steps;
        self.show(state);
    }

    /// A job is over; this much of its work need not be done any more.
    pub(crate) fn job_done(&self, skipped: u64) {
        let mut state = self.state();
        state.work.jobs_done += 1;
        state.work.steps_done += skipped;
        self.show(state);
    }

    /// Says something above the bar that only few want to know.
    pub(crate) fn detail(&self, text: impl Display) {
        match &self.bar {
            Some(bar) => bar.suspend(|| self.console.detail(text)),
            None => self.console.detail(text),
        }
    }

    /// Says something above the bar.
    pub(crate) fn note(&self, text: impl Display) {
        match &self.bar {
            Some(bar) => bar.suspend(|| self.console.note(text)),
            None => self.console.note(text),
        }
    }

    /// Removes the bar and returns the time since the start (s).
    pub(crate) fn finish(&self) -> f64 {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        self.started.elapsed().as_secs_f64()
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn show(&self, mut state: MutexGuard<'_, State>) {
        let elapsed = self.started.elapsed().as_secs_f64();
        if let Some(bar) = &self.bar {
            bar.set_position(state.work.steps_done.min(state.work.steps));
            bar.set_message(state.text(elapsed));
        } else if elapsed - state.last_line >= 5.0_f64.max(elapsed / 20.0) {
            // Rarer with time, or a log of a long sweep would hold little else.
            state.last_line = elapsed;
            self.console.note(state.text(elapsed));
        }
    }
}

/// The remaining time is shown once this fraction of the work (one in so many) is done.
const EARLY: f64 = 1000.0;

impl State {
    fn text(&self, elapsed: f64) -> String {
        let Work {
            jobs,
            jobs_done,
            steps,
            steps_done,
            unit,
            ref head,
        } = self.work;
        let rate = self.run as f64 / elapsed.max(1e-3);
        let done = steps_done.saturating_sub(self.done_before) as f64;
        let left = steps.saturating_sub(steps_done) as f64 * elapsed / done;
        // Spheres may be placed first, which is no part of the work: the rate is not known yet.
        let left = if left.is_finite() && done * EARLY >= steps as f64 {
            format!(", {} left", format::duration(left))
        } else {
            String::new()
        };
        let what = match self.phase.as_str() {
            "" => format!("{jobs_done}/{jobs} jobs"),
            phase => phase.to_owned(),
        };
        let percent = 100.0 * steps_done as f64 / steps.max(1) as f64;
        let head = match head.as_str() {
            "" => String::new(),
            head => format!("{head}: "),
        };
        format!(
            "{head}{what}, {:.0} %, {}{left}",
            percent.min(100.0),
            format::rate(rate, unit)
        )
    }
}
