//! Time steps over their limits, as commands print them.

use super::console::Console;
use phase::dem::timestep::{self, Limit, StepMargin};
use phase::grid::{Axis, describe};
use phase::scene::Scene;
use phase::sweep::{Job, Sweep};
use std::collections::BTreeSet;

/// A limit of the time step, and the job that comes closest to it.
pub(super) struct Tightest<'a> {
    pub(super) standing: StepMargin,
    pub(super) job: &'a Job,
}

/// Every limit of the time step with the job that comes closest to it: those that must not be
/// exceeded first, then the tightest.
pub(super) fn tightest_limits(jobs: &[Job]) -> Vec<Tightest<'_>> {
    let mut tightest: Vec<Tightest<'_>> = Vec::new();
    for job in jobs {
        for standing in StepMargin::all(&job.scene()) {
            let next = Tightest { standing, job };
            match tightest
                .iter_mut()
                .find(|tightest| tightest.standing.limit.name == standing.limit.name)
            {
                Some(tightest) if tightest.standing.ratio < standing.ratio => *tightest = next,
                Some(_) => {}
                None => tightest.push(next),
            }
        }
    }
    tightest.sort_by(|a, b| {
        let (a, b) = (&a.standing, &b.standing);
        let order = b.limit.decisive.cmp(&a.limit.decisive);
        order.then(b.ratio.total_cmp(&a.ratio))
    });
    tightest
}

/// Prints the step of a scene over the limit above which it is refused, and whether it is coarse.
/// `check` explains the consequences of a coarse step.
pub(super) fn tell_of_scene(scene: &Scene, console: &Console) {
    if has_no_step(scene) {
        return;
    }
    let standings = StepMargin::all(scene);
    let decisive = standings.first().filter(|it| it.limit.decisive);
    console.note(describe_step(scene, decisive, ""));
    note_coarse(standings.iter(), console);
}

/// Whether a scene has no steps that could be too long.
fn has_no_step(scene: &Scene) -> bool {
    scene.spot.is_some() || scene.is_external()
}

/// As [`tell_of_scene`], for the point of a sweep that is nearest its limit.
pub(super) fn tell_of_jobs(jobs: &[Job], axes: &[Axis], console: &Console) {
    let tightest = tightest_limits(jobs);
    match tightest.first().filter(|it| it.standing.limit.decisive) {
        Some(nearest) => {
            let at = format!(" at {}, the nearest to its limit", point(nearest, axes));
            let scene = &nearest.job.scene();
            console.note(describe_step(scene, Some(&nearest.standing), &at));
        }
        None if jobs.iter().all(|job| has_no_step(&job.scene())) => {}
        None => console
            .note("time step: nothing in these scenes sets a limit beyond which it is refused"),
    }
    note_coarse(tightest.iter().map(|it| &it.standing), console);
}

/// Prints in one line the limits to which the step is too close, if there are any.
fn note_coarse<'a>(standings: impl Iterator<Item = &'a StepMargin>, console: &Console) {
    let coarse = standings.filter(|standing| standing.consequence().is_some());
    let coarse = coarse.map(|StepMargin { limit, ratio }| {
        let kind = kind_of(limit);
        format!("{ratio:.2} of the {kind} ({})", limit.name)
    });
    let coarse: Vec<String> = coarse.collect();
    if !coarse.is_empty() {
        console.note(format_args!(
            "the time step is coarse: {}; `phase check` says what follows",
            coarse.join(", ")
        ));
    }
}

/// Warns of every limit that a point of a sweep comes too near.
pub(super) fn warn_of_jobs(tightest: &[Tightest<'_>], axes: &[Axis], console: &Console) {
    for tightest in tightest {
        let at = match axes {
            [] => String::new(),
            _ => format!(" at {}", point(tightest, axes)),
        };
        warn(&tightest.standing, &at, console);
    }
}

fn point(tightest: &Tightest<'_>, axes: &[Axis]) -> String {
    describe(axes, &tightest.job.values, tightest.job.seed)
}

fn describe_step(scene: &Scene, decisive: Option<&StepMargin>, at: &str) -> String {
    let dt = scene.time.dt;
    let mut text = format!("time step {dt:e} s{at}: ");
    match decisive {
        Some(StepMargin { limit, ratio }) => {
            text += &format!(
                "{ratio:.3} of the {} limit of {:.3e} s",
                limit.name, limit.seconds
            );
        }
        None => text += "nothing in the scene sets a limit beyond which it is refused",
    }
    let contact = timestep::shortest_contact(scene).filter(|time| time.is_finite());
    if let Some(contact) = contact {
        text += &format!(
            ", {:.3} of the shortest contact ({:.1} steps)",
            dt / contact,
            contact / dt
        );
    }
    text
}

fn warn(standing: &StepMargin, at: &str, console: &Console) {
    let Some(consequence) = standing.consequence() else {
        return;
    };
    let StepMargin { limit, ratio } = standing;
    let kind = kind_of(limit);
    console.warning(format_args!(
        "the time step is {ratio:.2} times the {kind} of {:.2e} s ({}){at}: {consequence}",
        limit.seconds, limit.name
    ));
}

fn kind_of(limit: &Limit) -> &'static str {
    match limit.decisive {
        true => "limit",
        false => "advised limit",
    }
}

/// The steps that were chosen where the scene, or that of a variant, says `dt = "auto"`, and from
/// which limits.
pub(super) fn describe_choice(sweep: &Sweep, jobs: &[Job]) -> Option<String> {
    let is_chosen = |job: &&Job| sweep.start_of(&job.values).time.safety_factor.is_some();
    let jobs: Vec<&Job> = jobs.iter().filter(is_chosen).collect();
    if jobs.is_empty() {
        return None;
    }
    let steps = jobs.iter().map(|job| job.scene().time.dt);
    let (low, high) = steps.fold((f64::INFINITY, 0.0_f64), |(low, high), dt| {
        (low.min(dt), high.max(dt))
    });
    let least = jobs.iter().filter_map(|job| timestep::least(&job.scene()));
    let names: BTreeSet<&str> = least.map(|limit| limit.name).collect();
    let names: Vec<&str> = names.into_iter().collect();
    let steps = if low == high {
        format!("{low:e} s")
    } else {
        format!("{low:e} to {high:e} s")
    };
    Some(format!(
        "{steps}, chosen (\"auto\") from the least limit: {}",
        names.join(", ")
    ))
}
