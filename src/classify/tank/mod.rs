//! Tanks: spheres that stay, in the vortex of the air (Rice, 2012, section 3).
//!
//! A run first has to settle. Each further sieve then looks for its state in the rest of the run;
//! the last one in the list that finds its state decides.

pub(super) mod fluid;
mod order;
pub(super) mod pinned;
pub(super) mod run;
pub(super) mod settle;
pub(super) mod spout;
#[cfg(test)]
mod synthetic;

pub use fluid::FluidSieve;
pub use pinned::{PinnedSieve, pinned_shares};
pub use settle::SettleSieve;
pub use spout::SpoutSieve;

pub(super) use run::TankRun;

use super::sieve::values;
use super::sieves::TANK_SIEVES;
use super::{ClassifyError, Family, Label, Sieves, window};
use crate::record::RunRecord;
use crate::scene::Scene;
use order::OrderParameters;

/// Scenes with a cylindrical tank and without an outlet.
pub static TANK: Family = Family {
    name: "tank",
    rules: &[],
    sieves: TANK_SIEVES,
    without_sieve: &[Label::UNSTABLE, Label::UNSETTLED],
    order: OrderParameters::MEASURES,
    default_figures: &["phase", "settle-time"],
    takes: |scene| {
        scene
            .tank
            .as_ref()
            .is_some_and(|tank| tank.radius.is_some())
            && scene.dem.walls.is_empty()
            && scene.dem.periodic.is_none()
    },
    check: |sieves, scene| {
        check_steady(sieves, scene)?;
        run::energy_scale(scene).map(|_| ())
    },
    judge,
    measured: &[],
    base: None,
};

/// The shortest steady part of a run must hold the window of every sieve.
fn check_steady(sieves: &Sieves, scene: &Scene) -> Result<(), ClassifyError> {
    let Some(steady) = &scene.steady else {
        return Ok(());
    };
    let interval = scene.time.frame_interval;
    let room = window::frames(steady.window, interval);
    let mut windows = TANK.windows(sieves);
    let longer = windows.find(|(_, window)| window::frames(*window, interval) > room);
    longer.map_or(Ok(()), |(sieve, window)| {
        Err(ClassifyError::SteadyTooShort {
            sieve,
            window,
            steady: steady.window,
        })
    })
}

/// The last sieve that says yes decides.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    let mut run = TankRun::new(record, sieves.spout.column(&record.scene.output)?)?;
    let sifted = sieves.sift_tank(&mut run);
    let label = sifted.iter().rev().find_map(|it| it.label);
    let order = OrderParameters::measure(&run);
    Ok((
        label.unwrap_or(Label::UNSETTLED),
        values(sifted, order.values()),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::classify;
    use crate::classify::tank::synthetic::quiet;
    use crate::record::{Milestone, MilestoneKind};
    use crate::scene::Steady;

    const FRAMES: usize = 5000;

    fn label(record: &RunRecord) -> Label {
        classify(record, &Sieves::default()).unwrap().label
    }

    #[test]
    fn sieves_decide_in_their_order() {
        let run = quiet(FRAMES);
        assert_eq!(label(&run), Label::SETTLED);
        let run = run.with_fluid(0..FRAMES);
        assert_eq!(label(&run), Label::FLUID);
        let run = run.with_hole(0.02, 0..FRAMES);
        assert_eq!(label(&run), Label::PINNED);
        let run = run.with_rising(10, 0..FRAMES);
        assert_eq!(label(&run), Label::SMALL_SPOUT);
        let run = run.with_rising(40, 0..FRAMES);
        assert_eq!(label(&run), Label::LARGE_SPOUT);
        let mut unsettled = run.clone();
        unsettled.observations.height_max.fill(1.0);
        assert_eq!(label(&unsettled), Label::UNSETTLED);
        assert_eq!(label(&run.unstable()), Label::UNSTABLE);
    }

    #[test]
    fn all_sieves_give_evidence_whichever_decides() {
        let run = quiet(FRAMES)
            .with_fluid(0..FRAMES)
            .with_hole(0.02, 0..FRAMES)
            .with_rising(10, 0..FRAMES);
        let evidence = classify(&run, &Sieves::default()).unwrap();
        assert_eq!(evidence.value("fluid_margin"), Some(1.0 - 0.9));
        assert_eq!(evidence.value("pinned_margin"), Some(0.5));
        assert_eq!(evidence.value("spout_margin"), Some(4748.0 / 2000.0 - 1.0));
    }

    #[test]
    fn an_unsettled_run_has_no_evidence_of_a_state() {
        let mut run = quiet(FRAMES).with_fluid(0..FRAMES);
        run.observations.height_max.fill(1.0);
        let verdict = classify(&run, &Sieves::default()).unwrap();
        assert_eq!(verdict.value("settle_time"), None);
        assert_eq!(verdict.value("fluid_share"), None);
        assert_eq!(verdict.value("settle_change"), None);
    }

    #[test]
    fn nothing_is_measured_on_an_unstable_run() {
        let verdict = classify(&quiet(FRAMES).unstable(), &Sieves::default()).unwrap();
        assert_eq!(verdict.values, [None; 17]);
    }

    #[test]
    fn windows_are_durations() {
        // With frames of 5 ms, nine tenths of the fluid window of 1.5 s are 270 frames.
        let mut run = quiet(1000).with_fluid(500..770);
        run.scene.time.frame_interval = 5e-3;
        assert_eq!(label(&run), Label::FLUID);
        let mut run = quiet(1000).with_fluid(500..769);
        run.scene.time.frame_interval = 5e-3;
        assert_eq!(label(&run), Label::SETTLED);
    }

    #[test]
    fn a_record_that_contradicts_itself_is_an_error() {
        let mut run = quiet(FRAMES);
        run.observations.rotation.pop();
        let error = classify(&run, &Sieves::default()).unwrap_err();
        assert!(
            error.to_string().contains("`rotation` holds 4999 of 5000"),
            "{error}"
        );

        let mut run = quiet(FRAMES);
        run.scene.output.rise_radii.push(0.9);
        assert!(classify(&run, &Sieves::default()).is_err());

        let mut run = quiet(FRAMES);
        run.mass.clear();
        assert!(classify(&run, &Sieves::default()).is_err());
    }

    /// The quiet run as one that is steady from this frame on, or never.
    fn steady_from(frame: Option<usize>) -> RunRecord {
        let mut record = quiet(FRAMES);
        record.scene.steady = Some(Steady::default());
        let times = &record.observations.time;
        let kind = MilestoneKind::Steady;
        let steady = frame.map(|frame| Milestone {
            kind,
            time: times[frame],
        });
        record.milestones.extend(steady);
        record
    }

    #[test]
    fn sieves_look_at_the_steady_part() {
        let sieves = Sieves::default();
        let from = FRAMES - 1 - 2000;
        let judge = |record: &RunRecord| classify(record, &sieves).unwrap();

        // A spout before it does not count; in all of it, which is just long enough, it does.
        let before = judge(&steady_from(Some(from)).with_rising(10, 0..FRAMES - 1));
        assert_eq!((before.label, before.steady), (Label::SETTLED, Some(true)));
        assert_eq!(before.value("settle_time"), Some(from as f64 * 1e-3));
        let all = judge(&steady_from(Some(from)).with_rising(10, from + 1..FRAMES));
        assert_eq!(all.label, Label::SMALL_SPOUT);

        // A run that was steady by its own test is settled, whatever the energy does, unless a
        // sphere flies.
        let mut restless = steady_from(Some(from));
        let energies = &mut restless.observations.kinetic;
        for energy in energies.iter_mut().step_by(2) {
            *energy = 1.0;
        }
        assert_eq!(judge(&restless).label, Label::SETTLED);
        restless.observations.height_max.fill(1.0);
        assert_eq!(judge(&restless).label, Label::UNSETTLED);
    }

    #[test]
    fn a_run_that_reached_its_time_is_judged_as_before_and_marked() {
        let sieves = Sieves::default();
        let capped = steady_from(None).with_rising(10, 0..FRAMES);
        let verdict = classify(&capped, &sieves).unwrap();
        assert_eq!(verdict.steady, Some(false));
        let without = classify(&quiet(FRAMES).with_rising(10, 0..FRAMES), &sieves).unwrap();
        assert_eq!((without.label, without.steady), (Label::SMALL_SPOUT, None));
        assert_eq!(
            (verdict.label, &verdict.values),
            (without.label, &without.values)
        );
        let unstable = classify(&capped.unstable(), &sieves).unwrap();
        assert_eq!(unstable.steady, None);
    }

    #[test]
    fn a_steady_part_shorter_than_a_window_is_refused() {
        let mut scene = quiet(0).scene;
        scene.steady = Some(Steady {
            window: 1.9,
            ..Steady::default()
        });
        let error = Sieves::default().check(&scene).unwrap_err();
        assert_eq!(
            error.to_string(),
            "`sieves.pinned.window` is 2 s, but runs end after 1.9 s without a trend; use \
             `steady.window = 2` in the scene, or a shorter window"
        );
    }
}
