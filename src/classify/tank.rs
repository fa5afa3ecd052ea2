//! The state of a tank: what its sieves say together.

use super::run::Run;
use super::spout::Spout;
use super::{ClassifyError, Label, OrderParameters, Sieves};
use crate::record::RunRecord;
use serde::{Deserialize, Serialize};

/// What is measured of a run of a tank besides its label. Nothing is measured on an unstable run,
/// whose numbers mean nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TankMeasures {
    /// Time from which the run counts as steady (s): the middle of the first steady window.
    pub settle_time: Option<f64>,
    /// How clearly each sieve decided.
    pub evidence: Evidence,
    /// Continuous measures besides the label, averaged over the steady part (over the last
    /// quarter of a run that did not settle).
    pub order: OrderParameters,
}

/// How clearly each sieve decided, whichever of them gave the label.
///
/// A sieve says yes exactly when its margin is zero or more. Fields are empty where a sieve could
/// not act: on a run that did not settle, or too late in it for a yes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// Least mean energy change of any window in which all spheres are low enough, over the
    /// tolerance; yes up to 1. Empty if there is no such window.
    pub settle_change: Option<f64>,
    /// Largest share of passing frames of any fluid window; frames outside the steady part count
    /// as failing.
    pub fluid_share: Option<f64>,
    /// That share less the threshold.
    pub fluid_margin: Option<f64>,
    /// Largest share of frames with a hole of any pinned window; frames outside the steady part
    /// count as having none.
    pub pinned_share: Option<f64>,
    /// That share less the threshold.
    pub pinned_margin: Option<f64>,
    /// Largest share of frames that qualify as a spout of any spout window.
    pub spout_share: Option<f64>,
    /// Longest time without a frame that does not qualify as a spout, over the window, less 1.
    pub spout_margin: Option<f64>,
    /// Largest number of rising spheres in the window that decided for a spout, over all
    /// spheres: a small spout below the threshold `small`. Empty without a spout.
    pub spout_peak: Option<f64>,
}

/// Labels a run that no guard ended: the first of large spout, small spout, pinned, fluid, settled,
/// unsettled that applies.
pub(super) fn judge(
    record: &RunRecord,
    sieves: &Sieves,
) -> Result<(Label, TankMeasures), ClassifyError> {
    let run = Run::new(record, sieves.spout.column(&record.scene.output)?)?;
    let settling = sieves.settle.sift(&run);
    let mut evidence = Evidence {
        settle_change: settling.least_change,
        ..Evidence::default()
    };
    let Some(start) = settling.start else {
        let last_quarter = run.frames() * 3 / 4;
        let measures = TankMeasures {
            settle_time: None,
            evidence,
            order: OrderParameters::measure(&run, last_quarter),
        };
        return Ok((Label::Unsettled, measures));
    };
    let fluid = sieves.fluid.sift(&run, start);
    let pinned = sieves.pinned.sift(&run, start);
    let spout = sieves.spout.sift(&run, start);
    evidence.fluid_share = fluid;
    evidence.fluid_margin = fluid.map(|share| share - sieves.fluid.share);
    evidence.pinned_share = pinned;
    evidence.pinned_margin = pinned.map(|share| share - sieves.pinned.share);
    evidence.spout_share = spout.share;
    evidence.spout_margin = spout.longest.map(|windows| windows - 1.0);
    evidence.spout_peak = spout.peak;

    let yes = |margin: Option<f64>| margin.is_some_and(|margin| margin >= 0.0);
    let label = match spout.kind {
        Some(Spout::Large) => Label::LargeSpout,
        Some(Spout::Small) => Label::SmallSpout,
        None if yes(evidence.pinned_margin) => Label::Pinned,
        None if yes(evidence.fluid_margin) => Label::Fluid,
        None => Label::Settled,
    };
    let measures = TankMeasures {
        settle_time: Some(run.time(start)),
        evidence,
        order: OrderParameters::measure(&run, start),
    };
    Ok((label, measures))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::classify;
    use crate::classify::synthetic::quiet;

    const FRAMES: usize = 5000;

    fn label(record: &RunRecord) -> Label {
        classify(record, &Sieves::default()).unwrap().label
    }

    #[test]
    fn sieves_decide_in_their_order() {
        let run = quiet(FRAMES);
        assert_eq!(label(&run), Label::Settled);
        let run = run.with_fluid(0..FRAMES);
        assert_eq!(label(&run), Label::Fluid);
        let run = run.with_hole(0.02, 0..FRAMES);
        assert_eq!(label(&run), Label::Pinned);
        let run = run.with_rising(10, 0..FRAMES);
        assert_eq!(label(&run), Label::SmallSpout);
        let run = run.with_rising(40, 0..FRAMES);
        assert_eq!(label(&run), Label::LargeSpout);
        let mut unsettled = run.clone();
        unsettled.observations.height_max.fill(1.0);
        assert_eq!(label(&unsettled), Label::Unsettled);
        assert_eq!(label(&run.unstable()), Label::Unstable);
    }

    #[test]
    fn all_sieves_give_evidence_whichever_decides() {
        let run = quiet(FRAMES)
            .with_fluid(0..FRAMES)
            .with_hole(0.02, 0..FRAMES)
            .with_rising(10, 0..FRAMES);
        let evidence = classify(&run, &Sieves::default())
            .unwrap()
            .of_tank()
            .evidence
            .clone();
        assert_eq!(evidence.fluid_margin, Some(1.0 - 0.9));
        assert_eq!(evidence.pinned_margin, Some(0.5));
        assert_eq!(evidence.spout_margin, Some(4748.0 / 2000.0 - 1.0));
    }

    #[test]
    fn an_unsettled_run_has_no_evidence_of_a_state() {
        let mut run = quiet(FRAMES).with_fluid(0..FRAMES);
        run.observations.height_max.fill(1.0);
        let verdict = classify(&run, &Sieves::default()).unwrap();
        assert_eq!(verdict.of_tank().settle_time, None);
        assert_eq!(verdict.of_tank().evidence, Evidence::default());
    }

    #[test]
    fn nothing_is_measured_on_an_unstable_run() {
        let verdict = classify(&quiet(FRAMES).unstable(), &Sieves::default()).unwrap();
        assert_eq!(verdict.of_tank().evidence, Evidence::default());
        assert_eq!(verdict.of_tank().order, OrderParameters::default());
        assert_eq!(verdict.of_tank().settle_time, None);
    }

    #[test]
    fn windows_are_durations() {
        // With frames of 5 ms, nine tenths of the fluid window of 1.5 s are 270 frames.
        let mut run = quiet(1000).with_fluid(500..770);
        run.scene.time.frame_interval = 5e-3;
        assert_eq!(label(&run), Label::Fluid);
        let mut run = quiet(1000).with_fluid(500..769);
        run.scene.time.frame_interval = 5e-3;
        assert_eq!(label(&run), Label::Settled);
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
}
