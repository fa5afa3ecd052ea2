//! Continuous measures of a silo, filled and flowing.

use super::outflow::Outflow;
use crate::classify::measure::{measured, measures};
use crate::measure::packing_fraction;

/// Shares of the grains between which the discharge rate is measured: neither while the flow begins
/// nor while the last grains trickle out.
const RATE_SHARES: [f64; 2] = [0.2, 0.8];

/// Share of the grains without which a silo counts as empty, as in the rule of its label.
const EMPTIED_SHARE: f64 = 0.95;

measures! {
    /// Continuous measures of a silo, filled and flowing. Fields are empty where a measure is
    /// undefined: what is measured at rest if the door opened before, or not at all; what is
    /// measured of the flow if that stopped before.
    struct SiloOrder {
        /// Time at which all grains were at rest behind the closed door (s).
        rest_time: measured("time at rest", "s"),
        /// Height of the centre of the highest grain at rest, at the last frame before the door
        /// opened (m).
        heap_height: measured("height of the highest centre at rest", "m"),
        /// Packing fraction at rest (see [`packing_fraction`]), of the snapshot nearest to the time
        /// of rest in which all grains are in and the door is closed.
        packing_fraction: measured("packing fraction at rest", "").part(),
        /// Mean number of contacts of a grain at rest, with grains and with walls, at the last
        /// frame before the door opened.
        coordination: measured("contacts of a grain at rest", ""),
        /// Grains per second, from the frame by which a fifth of all had left to that by which four
        /// fifths had.
        discharge_rate: measured("discharge rate", "grains/s"),
        /// The same in kg/s.
        mass_rate: measured("discharge rate", "kg/s"),
        /// Share of all grains that left.
        discharged_share: measured("share of the grains that left", "").share(),
        /// Time from the opening of the door until 95 % of the grains had left (s).
        emptying_time: measured("time to empty", "s"),
    }
}

impl SiloOrder {
    pub(super) fn measure(run: &Outflow<'_>) -> Self {
        let rest = HeapAtRest::of(run);
        let at_rest = |values: &[f32]| Some(f64::from(values[rest.as_ref()?.frame?]));
        let (discharge_rate, mass_rate) = rates(run).unwrap_or_default();
        Self {
            rest_time: run.rest,
            heap_height: at_rest(&run.observations.height_max),
            packing_fraction: rest.as_ref().and_then(|rest| rest.packing_fraction(run)),
            coordination: at_rest(&run.observations.coordination),
            discharge_rate,
            mass_rate,
            discharged_share: run.opened.map(|_| run.discharged() / run.grains),
            emptying_time: emptying_time(run),
        }
    }
}

/// The filled silo at rest, from the time of rest until the door opened.
struct HeapAtRest {
    since: f64,
    until: f64,
    /// The last frame in between.
    frame: Option<usize>,
}

impl HeapAtRest {
    fn of(run: &Outflow<'_>) -> Option<Self> {
        let (since, until) = (run.rest?, run.opened?);
        let time = &run.observations.time;
        // At the very opening the door holds no grain any more.
        let before = time.partition_point(|&it| it < until - run.tolerance());
        let frame = before.checked_sub(1);
        Some(Self {
            since,
            until,
            frame: frame.filter(|&frame| time[frame] > since - run.tolerance()),
        })
    }

    fn packing_fraction(&self, run: &Outflow<'_>) -> Option<f64> {
        let record = run.record;
        let closed = record.snapshots.iter().filter(|snapshot| {
            let all_in = snapshot.position.iter().all(|value| !value.is_nan());
            all_in && snapshot.time < self.until + run.tolerance()
        });
        let away = |time: f64| (time - self.since).abs();
        let nearest = closed.min_by(|a, b| away(a.time).total_cmp(&away(b.time)))?;
        let fixed = record.scene.dem.geometry.as_ref().map(|it| it.spheres());
        packing_fraction(
            nearest.position.view(),
            &record.radius,
            &fixed.unwrap_or_default(),
        )
    }
}

/// Grains and mass (kg) per second that leave.
fn rates(run: &Outflow<'_>) -> Option<(Option<f64>, Option<f64>)> {
    let opened = run.opened?;
    let frames = RATE_SHARES.map(|share| run.frame_of(share * run.grains));
    let [Some(first), Some(last)] = frames else {
        return None;
    };
    let observations = run.observations;
    let time = observations.time[last] - observations.time[first];
    if time <= 0.0 || observations.time[first] < opened {
        return None;
    }
    let change = |values: &[f32]| {
        let at = |frame: usize| values.get(frame).map(|&value| f64::from(value));
        Some((at(last)? - at(first)?) / time)
    };
    // What left is what is no longer in, unless grains come in meanwhile.
    let mass = match change(&observations.released) {
        Some(0.0) => change(&observations.mass_inside).map(|mass| -mass),
        _ => None,
    };
    Some((change(&observations.discharged), mass))
}

fn emptying_time(run: &Outflow<'_>) -> Option<f64> {
    let opened = run.opened?;
    let frame = run.frame_of(EMPTIED_SHARE * run.grains)?;
    Some((run.observations.time[frame] - opened).max(0.0))
}

#[cfg(test)]
mod tests {
    use crate::classify::silo::synthetic::{
        DURATION, GRAINS, OPENED, REST, draining, judge, square_lattice,
    };
    use crate::classify::{Label, Sieves, Verdict, classify};
    use crate::observe::Snapshot;
    use crate::record::{MilestoneKind, RunRecord};
    use std::f64::consts::PI;

    fn measure(record: &RunRecord) -> Verdict {
        judge(record)
    }

    fn close(measured: Option<f64>, expected: f64, tolerance: f64) -> bool {
        (measured.unwrap() - expected).abs() < tolerance * expected.abs()
    }

    #[test]
    fn the_rate_is_that_between_a_fifth_and_four_fifths() {
        let mut record = draining(GRAINS, 1.0);
        let rate = GRAINS as f64 / (DURATION - 1.0 - OPENED);
        let order = measure(&record);
        assert!(
            close(order.value("discharge_rate"), rate, 0.02),
            "{order:?}"
        );
        assert!(close(order.value("mass_rate"), rate, 0.02));
        // Grains of half the mass, and what happens before and after does not matter.
        for mass in &mut record.observations.mass_inside {
            *mass *= 0.5;
        }
        for left in &mut record.observations.discharged {
            *left = match *left {
                early if early < 39.0 => 0.0,
                late if late > 161.0 => GRAINS as f32,
                between => between,
            };
        }
        let order = measure(&record);
        assert!(
            close(order.value("discharge_rate"), rate, 0.02),
            "{order:?}"
        );
        assert!(close(order.value("mass_rate"), 0.5 * rate, 0.02));
    }

    #[test]
    fn a_flow_that_stops_before_four_fifths_has_no_rate() {
        let order = measure(&draining(159, 1.0));
        assert_eq!(
            (order.value("discharge_rate"), order.value("mass_rate")),
            (None, None)
        );
        assert_eq!(order.value("discharged_share"), Some(159.0 / 200.0));
        assert!(
            measure(&draining(160, 1.0))
                .value("discharge_rate")
                .is_some()
        );
    }

    #[test]
    fn the_time_to_empty_is_that_of_the_share_of_the_rule() {
        let record = draining(190, 1.0);
        let order = measure(&record);
        assert!(
            close(order.value("emptying_time"), DURATION - 1.0 - OPENED, 1e-9),
            "{order:?}"
        );
        let later = measure(&draining(189, 1.0));
        assert_eq!(later.value("emptying_time"), None);
    }

    #[test]
    fn the_heap_is_measured_just_before_the_door_opens() {
        let mut record = draining(GRAINS, 1.0);
        let opening = (OPENED / 0.05_f64).round() as usize;
        record.observations.height_max[opening - 1] = 2.5;
        record.observations.coordination[opening - 1] = 3.5;
        let order = measure(&record);
        assert_eq!(order.value("rest_time"), Some(REST));
        assert_eq!(
            (order.value("heap_height"), order.value("coordination")),
            (Some(2.5), Some(3.5))
        );
        assert!(
            close(order.value("packing_fraction"), PI / 4.0, 0.01),
            "{order:?}"
        );
    }

    #[test]
    fn the_snapshot_nearest_to_rest_counts_if_all_grains_are_in() {
        let stretched = |time: f64| {
            let mut snapshot = square_lattice(time);
            snapshot.position *= 2.0;
            snapshot
        };
        let without = |mut snapshot: Snapshot| {
            snapshot.position.row_mut(3).fill(f64::NAN);
            snapshot
        };
        let mut record = draining(GRAINS, 1.0);
        record.snapshots = vec![
            stretched(9.0),
            without(square_lattice(9.9)),
            square_lattice(10.2),
            stretched(OPENED + 1.0),
        ];
        assert!(close(
            measure(&record).value("packing_fraction"),
            PI / 4.0,
            0.01
        ));
        record.snapshots = vec![stretched(OPENED + 0.5)];
        assert_eq!(measure(&record).value("packing_fraction"), None);
    }

    #[test]
    fn a_door_that_stays_closed_leaves_the_run_unsettled_and_unmeasured() {
        let verdict = judge(&draining(0, 0.0).before(MilestoneKind::DoorOpened));
        assert_eq!(verdict.label, Label::UNSETTLED);
        assert_eq!(verdict.value("arching_margin"), None);
        assert_eq!(verdict.value("discharged_share"), None);
        let restless = judge(&draining(0, 0.0).before(MilestoneKind::AtRest));
        assert_eq!(restless.label, Label::UNSETTLED);
        // Only the number in the rule of *emptied* is known.
        let known = restless.values.iter().flatten();
        assert_eq!(known.collect::<Vec<_>>(), [&0.95]);
        assert_eq!(restless.value("emptied_threshold"), Some(0.95));
    }

    #[test]
    fn a_silo_without_a_door_is_open_once_it_is_filled() {
        let mut record = draining(100, 0.5).before(MilestoneKind::AtRest);
        record.scene.dem.door = None;
        let verdict = judge(&record);
        assert_eq!(verdict.label, Label::FLOWING);
        assert_eq!(verdict.value("heap_height"), None);
    }

    #[test]
    fn a_silo_without_an_outlet_cannot_be_judged() {
        let mut record = draining(100, 0.5);
        record.scene.dem.outlet = None;
        let error = classify(&record, &Sieves::default()).unwrap_err();
        assert!(error.to_string().contains("`outlet.height`"), "{error}");
    }

    #[test]
    fn nothing_is_measured_on_an_unstable_run_and_contradictions_are_errors() {
        let mut record = draining(100, 0.5);
        record.observations.discharged.pop();
        assert!(classify(&record, &Sieves::default()).is_err());
        let verdict = judge(&record.unstable());
        assert_eq!(verdict.label, Label::UNSTABLE);
        assert_eq!(verdict.values, [None; 16]);
    }

    /// Symptom: a door that opened while grains came in gave a mass per second far too small.
    /// Cause: the mass that is in was taken to fall by what leaves alone.
    #[test]
    fn the_mass_rate_is_not_known_while_grains_come_in() {
        let mut record = draining(GRAINS, 1.0);
        assert!(judge(&record).value("mass_rate").is_some());
        let last = record.observations.released.len() - 1;
        for (frame, released) in record.observations.released.iter_mut().enumerate() {
            *released *= frame as f32 / last as f32;
        }
        let order = judge(&record);
        assert!(order.value("discharge_rate").is_some());
        assert_eq!(order.value("mass_rate"), None);
    }
}
