//! The library: a run in parts has the bits of a whole one.

use super::bench::whole;
use crate::scenes::{frictions, integrators_at_walls, shaken, state, tank, walled, water};
use crate::support::{Workplace, silo_file};
use phase::dem::DemSimulation;
use phase::record::{MilestoneKind, Outcome, RunRecord};
use phase::resume::{Checkpoints, Ending};
use phase::run::Run;
use phase::scene::{
    Coulomb, CundallStrack, Friction, Integrator, Mindlin, Neighbours, Rolling, Scene,
};
use phase::store::{content_digest, read_checkpoint, write_checkpoint};
use std::ops::ControlFlow;
use std::time::Duration;

/// Runs a scene to its end, and stops at every `step`-th frame: each part goes on from the file
/// that the part before left. Returns the record and the number of parts.
fn in_parts(scene: &Scene, step: u64) -> (RunRecord, usize) {
    let place = Workplace::new();
    let checkpoints = Checkpoints::beside(&place.path("run.h5"), Duration::from_secs(1000));
    for part in 1.. {
        let mut run = Run::new(scene).unwrap();
        assert_eq!(checkpoints.restore(&mut run).unwrap(), part > 1);
        let first = run.progress().frame;
        let mut control = |now: phase::run::Progress| match now.frame - first < step {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        match checkpoints.run(run, &mut control, &mut |error| panic!("{error}")) {
            Ending::Finished(record) => return (*record, part),
            Ending::Interrupted => {}
            other => panic!("{other:?}"),
        }
    }
    unreachable!("a run comes to its end")
}

/// Asserts that a run in parts has the bits of a whole one, at every frame, and returns that.
#[track_caller]
fn assert_same_bits(mut scene: Scene, step: u64) -> RunRecord {
    scene.output.trajectory = true;
    scene.output.snapshot_interval = 3.0 * scene.time.frame_interval;
    let expected = whole(&scene);
    let (found, parts) = in_parts(&scene, step);
    assert!(parts > 2, "{parts} parts");
    assert_eq!(found.trajectory.len(), expected.trajectory.len());
    for (frame, (one, other)) in expected
        .trajectory
        .iter()
        .zip(&found.trajectory)
        .enumerate()
    {
        let bits = |state: &phase::observe::Snapshot| -> Vec<u64> {
            let arrays = [&state.position, &state.velocity, &state.spin];
            arrays
                .into_iter()
                .flatten()
                .map(|it| it.to_bits())
                .collect()
        };
        assert!(
            bits(one) == bits(other),
            "frame {frame}, {:?}, {:?}",
            scene.dem.friction,
            scene.time.integrator
        );
    }
    assert_eq!(found.outcome, expected.outcome);
    assert_eq!(found.milestones, expected.milestones);
    assert_eq!(
        content_digest(&found).unwrap(),
        content_digest(&expected).unwrap()
    );
    expected
}

/// The small silo with a friction law.
fn silo(friction: Option<Friction>, integrator: Integrator) -> Scene {
    let mut scene: Scene = toml::from_str(&silo_file()).unwrap();
    scene.dem.friction = friction;
    scene.time.integrator = integrator;
    scene
}

#[test]
fn a_tank_with_every_effect_goes_on_with_the_same_bits() {
    for friction in frictions() {
        for integrator in Integrator::ALL {
            let mut scene = tank(friction.clone(), integrator);
            scene.output.ledger = integrator == Integrator::VelocityVerlet;
            assert_same_bits(scene, 37);
        }
    }
    for integrator in Integrator::ALL {
        let mut scene = water(integrator);
        scene.time.duration = 0.12;
        scene.output.ledger = integrator == Integrator::SynchronisedVerlet;
        assert_same_bits(scene, 37);
    }
    // Without the ledger the acceleration of velocity Verlet is in the forces alone.
    for (integrator, ledger) in
        (Integrator::ALL.into_iter()).flat_map(|it| [(it, false), (it, true)])
    {
        let mut scene = shaken(integrator);
        scene.output.ledger = ledger;
        assert_same_bits(scene, 37);
    }
    for (integrator, ledger) in integrators_at_walls().flat_map(|it| [(it, false), (it, true)]) {
        for mut scene in walled(integrator) {
            scene.output.ledger = ledger;
            assert_same_bits(scene, 17);
        }
    }
}

#[test]
fn a_silo_goes_on_with_the_same_bits_while_it_is_filled_and_drained() {
    let laws = [
        None,
        Some(Friction::Coulomb(Coulomb {
            coefficient: 0.3,
            regularisation: 1e-2,
        })),
        Some(Friction::CundallStrack(CundallStrack {
            coefficient: 0.5,
            stiffness: 50.0,
            damping: 0.01,
        })),
    ];
    for friction in laws {
        for integrator in Integrator::ALL {
            // At every frame: between two grains, while they come to rest, at the door.
            let mut scene = silo(friction.clone(), integrator);
            scene.output.ledger = true;
            let record = assert_same_bits(scene, 1);
            let happened = |kind| record.milestones.iter().any(|it| it.kind == kind);
            assert!(happened(MilestoneKind::DoorOpened), "{friction:?}");
            assert_eq!(record.outcome, Outcome::Completed);
        }
    }
}

/// Spots have a time of their own between frames, lists of neighbours that hold for a while, and
/// random numbers that some draw and others do not.
#[test]
fn a_drainage_by_spots_goes_on_with_the_same_bits() {
    for (schedule, relaxation) in [
        ("events", "method = \"every-move\""),
        ("events", "method = \"counted\", ratio = 2"),
        ("steps-random", "method = \"at-random\", ratio = 2"),
        ("steps-newest-first", "method = \"global\", ratio = 2"),
    ] {
        let text = format!(
            "{}\nschedule = \"{schedule}\"\nrelaxation = {{ {relaxation} }}",
            crate::support::drainage_file()
        );
        let scene = Scene::from_toml(&text, std::path::Path::new("scene.toml")).unwrap();
        let record = assert_same_bits(scene, 1);
        let left = record.observations.discharged.last().copied().unwrap();
        assert!(left > 3.0, "{schedule}: {left}");
    }
}

/// The springs of rolling resistance are a part of the state, in a tank and where spheres come and
/// go.
#[test]
fn rolling_resistance_goes_on_with_the_same_bits() {
    let resistance = Rolling {
        coefficient: 0.2,
        damping: 0.3,
    };
    for integrator in Integrator::ALL {
        for friction in &frictions()[2..] {
            let mut scene = tank(friction.clone(), integrator);
            scene.dem.rolling = Some(resistance.clone());
            scene.output.ledger = integrator == Integrator::VelocityVerlet;
            assert_same_bits(scene, 37);
        }
        let friction = Friction::CundallStrack(CundallStrack {
            coefficient: 0.5,
            stiffness: 50.0,
            damping: 0.01,
        });
        let mut scene = silo(Some(friction), integrator);
        scene.dem.rolling = Some(resistance.clone());
        scene.output.ledger = true;
        let record = assert_same_bits(scene, 1);
        let opened = MilestoneKind::DoorOpened;
        assert!(record.milestones.iter().any(|it| it.kind == opened));
    }
}

/// Walls are looked at every 10 ms: frames of 3 ms leave a grain on either side of a checkpoint.
#[test]
fn a_grain_that_passes_a_wall_is_seen_across_a_checkpoint() {
    let mut scene = silo(None, Integrator::VelocityVerlet);
    scene.time.frame_interval = 3e-3;
    scene.dem.guards.overlap = 10.0;
    let Some(phase::scene::Contact::Linear(phase::scene::Linear { stiffness, .. })) =
        &mut scene.dem.contact
    else {
        panic!("the silo's contact is linear");
    };
    *stiffness = 0.5;
    let record = assert_same_bits(scene, 1);
    let Outcome::Unstable(broken) = &record.outcome else {
        panic!("{:?}", record.outcome);
    };
    assert_eq!(broken.guard, phase::record::Guard::WallPassed);
}

#[test]
fn spheres_that_pass_through_each_other_go_on() {
    let mut scene = tank(None, Integrator::VelocityVerlet);
    (scene.dem.contact, scene.dem.effects.updraught) = (None, None);
    scene.dem.guards.vertical = Some(100.0);
    scene.dem.guards.horizontal = Some(100.0);
    assert_same_bits(scene, 50);
}

#[test]
fn any_way_to_find_neighbours_goes_on() {
    let length = 0.01;
    for neighbours in [
        Neighbours::AllPairs,
        Neighbours::Cells { length },
        Neighbours::HashedCells { length },
    ] {
        let mut scene = tank(frictions()[3].clone(), Integrator::VelocityVerlet);
        scene.dem.effects.updraught = None;
        scene.dem.neighbours = neighbours;
        assert_same_bits(scene, 50);
    }
}

/// What the springs of contacts remember is a part of the state: without it a pile goes another
/// way.
#[test]
fn a_pile_needs_its_histories() {
    let mut scene = tank(
        Some(Friction::Mindlin(Mindlin {
            coefficient: 0.3,
            rescale: false,
        })),
        Integrator::SymplecticEuler,
    );
    (scene.dem.effects.updraught, scene.dem.effects.swirl) = (None, None);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(3000).unwrap();
    let saved = simulation.state().into_owned();

    // All that symplectic Euler goes on from but for the histories.
    let mut bare = scene.clone();
    bare.start = state(&simulation).start(simulation.radius());
    let mut forgetful = DemSimulation::new(&bare).unwrap();
    let mut restored = DemSimulation::new(&scene).unwrap();
    restored.restore(saved).unwrap();
    for _ in 0..5 {
        simulation.advance(40).unwrap();
        restored.advance(40).unwrap();
        forgetful.advance(40).unwrap();
        assert!(state(&restored).bits() == state(&simulation).bits());
        assert!(state(&forgetful).bits() != state(&simulation).bits());
    }
}

/// A state of another scene is refused, and the run stays as it was.
#[test]
fn a_state_that_does_not_fit_is_refused() {
    let [plain, mindlin] =
        [0, 3].map(|law| tank(frictions()[law].clone(), Integrator::SymplecticEuler));
    let fresh = || DemSimulation::new(&mindlin).unwrap();
    let mut other_walls = mindlin.clone();
    other_walls.tank.as_mut().unwrap().floor = None;
    for saved in [
        DemSimulation::new(&silo(None, Integrator::SymplecticEuler)).unwrap(),
        DemSimulation::new(&other_walls).unwrap(),
        DemSimulation::new(&plain).unwrap(),
    ] {
        let mut simulation = fresh();
        assert!(simulation.restore(saved.state()).is_err());
        simulation.advance(100).unwrap();
        let mut undisturbed = fresh();
        undisturbed.advance(100).unwrap();
        assert!(state(&simulation).bits() == state(&undisturbed).bits());
    }
}

/// The spheres of a list are known again, though the file does not hold them.
#[test]
fn a_list_of_other_spheres_is_refused() {
    let mut scene = tank(None, Integrator::SymplecticEuler);
    let simulation = DemSimulation::new(&scene).unwrap();
    scene.start = state(&simulation).start(simulation.radius());
    let place = Workplace::new();
    let path = place.path("run.checkpoint");
    let run = Run::new(&scene).unwrap();
    write_checkpoint(&path, &run).unwrap();
    assert!(read_checkpoint(&path, &scene).unwrap().is_some());
    scene.start.list_mut().unwrap()[3].velocity[1] += 1e-12;
    let differ = |scene: &Scene| {
        let error = read_checkpoint(&path, scene).unwrap_err().to_string();
        error.split("they differ in ").nth(1).unwrap().to_owned()
    };
    assert_eq!(differ(&scene), "start.spheres");
    scene.seed = 7;
    assert_eq!(differ(&scene), "seed, start.spheres");
}

/// Symptom: a checkpoint of another run, differing in no key. Cause: to JSON's numbers 0 and -0 are
/// equal, to the motion they need not be.
#[test]
fn zeros_of_another_sign_are_told() {
    let mut scene = tank(None, Integrator::SymplecticEuler);
    scene.dem.effects.gravity.as_mut().unwrap().acceleration = 0.0;
    let place = Workplace::new();
    let path = place.path("run.checkpoint");
    let run = Run::new(&scene).unwrap();
    write_checkpoint(&path, &run).unwrap();
    scene.dem.effects.gravity.as_mut().unwrap().acceleration = -0.0;
    let error = read_checkpoint(&path, &scene).unwrap_err().to_string();
    assert!(
        error.ends_with("they differ in gravity.acceleration"),
        "{error}"
    );
}

/// A disk that is full for a while must not end a run of hours; who stops it then is told.
#[test]
fn a_checkpoint_that_cannot_be_written_does_not_end_the_run() {
    let place = Workplace::new();
    let mut scene = tank(None, Integrator::SymplecticEuler);
    scene.time.duration = 0.02;
    // A file where a folder should be.
    place.write("no-folder", "");
    let checkpoints = Checkpoints::beside(&place.path("no-folder/run.h5"), Duration::ZERO);
    let run = || Run::new(&scene).unwrap();
    let mut warnings = Vec::new();
    let mut warn = |error: phase::store::StoreError| warnings.push(error.to_string());
    let Ending::Finished(record) =
        checkpoints.run(run(), &mut |_| ControlFlow::Continue(()), &mut warn)
    else {
        panic!("it did not end");
    };
    assert_eq!(
        content_digest(&record).unwrap(),
        content_digest(&whole(&scene)).unwrap()
    );
    assert_eq!(warnings.len(), 19);
    assert!(
        warnings[0].contains("no-folder/run.checkpoint"),
        "{warnings:?}"
    );

    let ending = checkpoints.run(run(), &mut |_| ControlFlow::Break(()), &mut |_| {});
    assert!(matches!(ending, Ending::Lost(_)), "{ending:?}");
}

/// Symptom: a run whose folder was removed while it went on left no checkpoint when it was stopped.
/// Cause: only the record made its folder again.
#[test]
fn a_folder_that_was_removed_is_made_again_for_the_checkpoint() {
    let place = Workplace::new();
    let mut scene = tank(None, Integrator::SymplecticEuler);
    scene.time.duration = 0.02;
    let checkpoints = Checkpoints::beside(&place.path("removed/run.h5"), Duration::ZERO);
    let run = Run::new(&scene).unwrap();
    let ending = checkpoints.run(run, &mut |_| ControlFlow::Break(()), &mut |_| {});
    assert!(matches!(ending, Ending::Interrupted), "{ending:?}");
    assert!(place.path("removed/run.checkpoint").is_file());
}
