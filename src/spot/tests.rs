//! Tests of whole simulations.

use super::parameters::{Influence, Parameters, Relaxation, Schedule, Walk};
use super::samples::{badness, packing, parameters, simulation};
use super::simulation::SpotSimulation;
use super::state::SpotError;
use super::{SpotGuard, packing};
use crate::measure::{Centres, solid_like};
use crate::particles::vector::Vector;

const SCHEDULES: [Schedule; 3] = [
    Schedule::Events,
    Schedule::StepsInRandomOrder,
    Schedule::StepsNewestFirst,
];

fn after(time: f64, change: impl FnOnce(&mut Parameters)) -> SpotSimulation {
    let mut simulation = simulation(change);
    simulation.advance_to(time).expect("no guard breaks");
    simulation
}

#[test]
fn spots_rise_at_mu_dz_and_their_density_is_lambda_over_mu_dz() {
    for schedule in SCHEDULES {
        let simulation = after(4.0, |it| {
            it.schedule = schedule;
            it.relaxation = Relaxation::Off;
        });
        let heights = || simulation.spots().iter().map(|it| it.position.z);
        let below = |limit: f64| heights().filter(|z| *z < limit).count() as f64;
        let per_height = (below(9.0) - below(1.0)) / 8.0;
        assert!(
            (per_height / (375.0 / 2.8) - 1.0).abs() < 0.1,
            "{per_height} per d"
        );
        let inserted = simulation.counts().inserted as f64;
        assert!((inserted / 1500.0 - 1.0).abs() < 0.1, "{inserted} spots");
        // The front is where the density is half the density below.
        let (near, far) = (below(2.8 * 4.0 - 1.0), below(2.8 * 4.0));
        let expected = inserted * (1.0 - 1.0 / 11.2);
        assert!(
            (near - expected).abs() < 0.12 * expected,
            "{near} of {expected}"
        );
        assert!(
            inserted - far < 0.12 * inserted,
            "{far} of {inserted} below the front"
        );
    }
}

#[test]
fn spheres_are_conserved_and_leave_through_the_orifice() {
    let simulation = after(3.0, |_| {});
    let (inside, left) = (simulation.spheres_inside(), simulation.spheres_left());
    assert_eq!(inside + left, packing().len());
    assert!(left > 50, "{left} have left");
    let positions = simulation.positions();
    assert_eq!(positions.iter().flatten().count(), inside);
    for (position, left) in positions.iter().zip(simulation.left()) {
        assert_ne!(position.is_some(), left.is_some());
        if let Some(place) = left {
            assert!(place.z < 0.0 && place.x * place.x + place.y * place.y < 9.0);
        }
        if let Some(place) = position {
            assert!(place.x.abs() <= 6.5 && place.y.abs() <= 3.5 && place.z >= 0.0);
        }
    }
    // Far from the orifice a sphere is hardly moved.
    let start = packing();
    let moved = positions
        .iter()
        .zip(start)
        .filter_map(|(now, start)| Some((*now)? - *start));
    let (mut inner, mut outer) = ([0.0, 0.0], [0.0, 0.0]);
    for (by, start) in moved.zip(
        positions
            .iter()
            .zip(start)
            .filter_map(|(n, s)| n.map(|_| s)),
    ) {
        let sums = if start.x.abs() < 3.0 {
            &mut inner
        } else {
            &mut outer
        };
        sums[0] -= by.z;
        sums[1] += 1.0;
    }
    assert!(
        inner[0] / inner[1] > 1.5 * outer[0] / outer[1],
        "{inner:?} {outer:?}"
    );
}

#[test]
fn the_mean_flow_of_mirrored_starts_is_mirrored() {
    let mirrored: Vec<Vector> = packing()
        .iter()
        .map(|it| Vector::new(-it.x, it.y, it.z))
        .collect();
    let mean_flow = |start: &[Vector], side: f64| {
        let mut simulation = SpotSimulation::new(parameters(), start, 1).expect("a start");
        simulation.advance_to(2.0).expect("no guard breaks");
        let (mut sum, mut count) = (0.0, 0.0);
        for (now, start) in simulation.positions().into_iter().zip(start) {
            if let Some(now) = now
                && start.x * side > 0.0
            {
                sum += start.z - now.z;
                count += 1.0;
            }
        }
        sum / count
    };
    let (left, right) = (mean_flow(packing(), -1.0), mean_flow(&mirrored, 1.0));
    assert!(left > 0.05, "{left}");
    assert!((left / right - 1.0).abs() < 0.12, "{left} and {right}");
}

#[test]
fn bits_do_not_depend_on_threads_resumes_or_output() {
    let kinds = [
        (Relaxation::EveryMove, [2, 3]),
        (Relaxation::Global { ratio: 2 }, [5, 1]),
    ];
    for schedule in SCHEDULES {
        for (relaxation, threads) in kinds {
            let change = |it: &mut Parameters| {
                it.schedule = schedule;
                it.relaxation = relaxation;
            };
            let whole = after(0.8, change);
            let mut pieces = simulation(change);
            pieces.use_threads(threads[0]).expect("threads");
            for part in 1..=5 {
                pieces
                    .advance_to(f64::from(part) * 0.08)
                    .expect("no guard breaks");
            }
            let saved = pieces.save().expect("saved");
            let parameters = pieces.parameters().clone();
            let mut resumed = SpotSimulation::restore(parameters, &saved).expect("restored");
            resumed.use_threads(threads[1]).expect("threads");
            resumed.advance_to(0.8).expect("no guard breaks");
            assert_same(&whole, &resumed);
            assert!(whole.counts().sorts > 0);
        }
    }
}

fn assert_same(one: &SpotSimulation, other: &SpotSimulation) {
    let about = (&one.parameters().schedule, &one.parameters().relaxation);
    assert_eq!(one.positions(), other.positions(), "{about:?}");
    assert_eq!(one.spots(), other.spots(), "{about:?}");
    assert_eq!(one.counts(), other.counts(), "{about:?}");
    let saved = [one, other].map(|it| it.save().expect("saved"));
    assert!(saved[0] == saved[1], "{about:?}");
}

/// Spots have then reached the top, and small spots give many strips.
#[test]
fn steps_have_the_same_bits_on_any_number_of_threads() {
    let kinds = [
        (Relaxation::EveryMove, Walk::Unbiased, [2, 5]),
        (Relaxation::Counted { ratio: 3 }, Walk::Unbiased, [2, 3]),
        (Relaxation::Off, Walk::Biased { exponent: 3.0 }, [3, 5]),
    ];
    for schedule in [Schedule::StepsInRandomOrder, Schedule::StepsNewestFirst] {
        for (relaxation, walk, several) in kinds {
            let change = |it: &mut Parameters| {
                it.schedule = schedule;
                it.relaxation = relaxation;
                it.walk = walk;
                it.spot_radius = 1.4;
                it.relaxation_radius = 1.2;
                it.insertion_rate = 150.0;
            };
            let one = after(6.5, change);
            assert!(one.counts().removed > 0);
            for threads in several {
                let mut other = simulation(change);
                other.use_threads(threads).expect("threads");
                other.advance_to(6.5).expect("no guard breaks");
                assert_same(&one, &other);
            }
        }
    }
}

#[test]
fn steps_that_must_be_sorted_in_between_have_the_same_bits_on_threads() {
    for schedule in [Schedule::StepsInRandomOrder, Schedule::StepsNewestFirst] {
        let change = |it: &mut Parameters| {
            it.schedule = schedule;
            it.relaxation = Relaxation::Off;
            it.displacement_ratio = 20.0;
        };
        let one = after(2.0, change);
        assert!(one.counts().sorts > 2 * 2 * 28, "{:?}", one.counts());
        let mut two = simulation(change);
        two.use_threads(2).expect("threads");
        two.advance_to(2.0).expect("no guard breaks");
        assert_same(&one, &two);
    }
}

#[test]
fn guards_break_at_the_same_move_on_threads() {
    let mut twice = packing().to_vec();
    twice.push(packing()[700]);
    for schedule in [Schedule::StepsInRandomOrder, Schedule::StepsNewestFirst] {
        let failures = [1, 2, 3].map(|threads| {
            let parameters = Parameters {
                schedule,
                ..parameters()
            };
            let mut simulation = SpotSimulation::new(parameters, &twice, 1).expect("a start");
            simulation.use_threads(threads).expect("threads");
            let failure = simulation.advance_to(4.0).expect_err("a guard breaks");
            (failure, simulation.positions())
        });
        assert_eq!(failures[0], failures[1]);
        assert_eq!(failures[0], failures[2]);
    }
}

#[test]
fn packings_are_worse_the_rarer_the_relaxation() {
    let badness_of = |relaxation| badness(&after(2.5, |it| it.relaxation = relaxation));
    let orders = [
        vec![
            Relaxation::EveryMove,
            Relaxation::AtRandom { ratio: 10 },
            Relaxation::AtRandom { ratio: 100 },
            Relaxation::Off,
        ],
        vec![
            Relaxation::Counted { ratio: 10 },
            Relaxation::Global { ratio: 1 },
            Relaxation::Global { ratio: 10 },
            Relaxation::Off,
        ],
    ];
    for order in orders {
        let values: Vec<f64> = order.into_iter().map(badness_of).collect();
        assert!(
            values.is_sorted_by(|less, more| 1.3 * less < *more),
            "{values:?}"
        );
    }
}

#[test]
fn biased_spots_die_at_the_surface_and_weighted_ones_push_harder() {
    let biased = Walk::Biased { exponent: 3.0 };
    for influence in [Influence::Fixed, Parameters::weighting(0.1)] {
        let simulation = after(7.0, |it| {
            it.walk = biased;
            it.influence = influence;
            it.removal_height = 50.0;
            it.relaxation = Relaxation::AtRandom { ratio: 10 };
        });
        let top = simulation
            .positions()
            .iter()
            .flatten()
            .fold(0.0, |most: f64, it| most.max(it.z));
        let highest = simulation
            .spots()
            .iter()
            .fold(0.0, |most: f64, it| most.max(it.position.z));
        assert!(simulation.counts().removed > 0);
        assert!(highest < top + 2.7, "{highest} above {top}");
    }
}

#[test]
fn guards_name_what_broke() {
    let mut twice = packing().to_vec();
    twice.push(packing()[700]);
    let start = SpotSimulation::new(parameters(), &twice, 1);
    let failure = start
        .expect("a start")
        .advance_to(4.0)
        .expect_err("a guard breaks");
    assert_eq!(failure.guard, SpotGuard::NotANumber);
    assert!(failure.sphere.is_some() && failure.moves > 0);
    let near = packing()[700] + Vector::new(0.01, 0.0, 0.0);
    twice[2000] = near;
    twice.push(near + Vector::new(0.0, 0.01, 0.0));
    let start = SpotSimulation::new(parameters(), &twice, 1);
    let failure = start
        .expect("a start")
        .advance_to(4.0)
        .expect_err("a guard breaks");
    assert_eq!(failure.guard, SpotGuard::Displacement);
    let crowd = vec![Vector::new(0.0, 0.0, 2.0); 100];
    let Err(SpotError::Failure(failure)) = SpotSimulation::new(parameters(), &crowd, 1) else {
        panic!("a crowd is refused");
    };
    assert_eq!(failure.guard, SpotGuard::Crowded);
    let outside = [Vector::new(0.0, 3.6, 2.0)];
    let outside = SpotSimulation::new(parameters(), &outside, 1);
    assert!(matches!(outside, Err(SpotError::Outside { sphere: 0, .. })));
}

#[test]
fn checkpoints_of_other_runs_and_broken_ones_are_refused() {
    let saved = simulation(|_| {}).save().expect("saved");
    let other = Parameters::figure_2(1.0);
    let refused = SpotSimulation::restore(other, &saved).expect_err("other parameters");
    assert_eq!(refused, SpotError::OtherParameters);
    let broken = SpotSimulation::restore(parameters(), &saved[..saved.len() / 2]);
    assert!(matches!(broken, Err(SpotError::Checkpoint(_))));
}

/// Symptom: more than half of the spheres of a packing were part of crystals. Cause: they were
/// shaken for so long at every height of the lid that they crystallised.
#[test]
fn start_packings_are_disordered() {
    let centres = Centres {
        place: packing().to_vec(),
        number: (0..packing().len()).collect(),
    };
    let solid = solid_like(&centres, 1.3);
    let middle = |place: &Vector| place.x.abs() < 5.0 && place.y.abs() < 2.0 && place.z > 3.0;
    let places = solid.iter().zip(&centres.place);
    let inside = places.filter(|(_, place)| middle(place) && place.z < 13.0);
    let inside: Vec<bool> = inside.map(|(solid, _)| *solid).collect();
    let share = inside.iter().filter(|it| **it).count() as f64 / inside.len() as f64;
    assert!(share < 0.1, "{share} of {}", inside.len());
}

#[test]
fn start_packings_are_dense_and_without_overlap() {
    let packing = packing();
    let fraction = packing::packing_fraction(&parameters(), packing);
    assert!((0.62..0.66).contains(&fraction), "{fraction}");
    for (second, centre) in packing.iter().enumerate() {
        assert!(centre.x.abs() <= 6.5 && centre.y.abs() <= 3.5 && centre.z >= 0.5);
        for other in &packing[..second] {
            assert!((*centre - *other).norm() >= 1.0 - 1e-9);
        }
    }
}
