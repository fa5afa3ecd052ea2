//! All ways to find neighbours give the same motion, bit for bit.

use super::hopper;
use crate::support::Workplace;
use phase::dem::DemSimulation;
use phase::scene::{DemScene, Neighbours, Scene};

/// Bits of all positions, velocities and spins after every part of a run.
fn bits(scene: &Scene, parts: usize) -> Vec<u64> {
    let mut simulation = DemSimulation::new(scene).unwrap();
    let mut bits = Vec::new();
    for _ in 0..parts {
        simulation.advance(1000).unwrap();
        let particles = simulation.particles();
        let vectors = [&particles.position, &particles.velocity, &particles.spin];
        for vector in vectors.into_iter().flatten() {
            bits.extend([vector.x, vector.y, vector.z].map(f64::to_bits));
        }
    }
    bits
}

/// The least cell, one as wide as the document's, and one that holds everything.
fn searches(scene: &Scene) -> Vec<Neighbours> {
    let least = scene.least_cell_length();
    let mut searches = vec![Neighbours::AllPairs];
    for length in [least, 0.25, 30.0] {
        searches.push(Neighbours::Cells { length });
        searches.push(Neighbours::HashedCells { length });
    }
    searches
}

#[test]
#[ignore = "takes seven seconds"]
fn bits_do_not_depend_on_the_search() {
    let frictions = [
        r#"friction = { law = "cundall-strack", coefficient = 0.2, stiffness = 70.0, damping = 0.02 }"#,
        r#"friction = { law = "coulomb", coefficient = 0.2, regularisation = 0.1 }"#,
        "",
    ];
    for friction in frictions {
        // Filled at 3 s, opened, and half empty at 6 s: insertion, removal, and histories of
        // contacts.
        let scene = hopper(&[
            (frictions[0], friction),
            ("door = {}", "door = { opens = 4.0 }"),
        ]);
        let expected = bits(&scene, 12);
        for neighbours in searches(&scene) {
            let found = bits(
                &Scene {
                    dem: DemScene {
                        neighbours,
                        ..scene.dem.clone()
                    },
                    ..scene.clone()
                },
                12,
            );
            assert!(found == expected, "{neighbours:?} with {friction}");
        }
    }
}

#[test]
fn the_search_is_no_part_of_a_run() {
    let scene = hopper(&[]);
    let other = Scene {
        dem: DemScene {
            neighbours: Neighbours::AllPairs,
            ..scene.dem.clone()
        },
        ..scene.clone()
    };
    assert_eq!(other.identity(), scene.identity());
}

#[test]
fn a_hash_table_finds_grains_that_are_far_apart() {
    // Two pairs that meet, 1e7 m from each other: a box of cells about all of them would be too
    // wide to tell anything, or too large to be stored.
    let far = hopper(&[
        ("count = 60", "count = 4"),
        (
            "[{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]",
            "0.03",
        ),
        (
            r#"kind = "feed", position = [0.0, 0.0, 1.4], velocity = [0.0, 0.0, -2.0], interval = 0.05, spread = 0.1"#,
            r#"kind = "list", spheres = [
                { position = [0.0, 0.0, 1.0], velocity = [1.0, 0.0, 0.0] }, { position = [0.1, 0.0, 1.0] },
                { position = [1e7, 0.0, -2e6], velocity = [1.0, 0.0, 0.0] }, { position = [1.00000001e7, 0.0, -2e6] }]"#,
        ),
        ("outlet = { height = -0.5 }", ""),
        ("rest = { kinetic_energy = 1e-4 }", ""),
        ("door = {}", ""),
        ("gravity = { acceleration = 9.81 }", ""),
    ]);
    let run = |neighbours| {
        bits(
            &Scene {
                dem: DemScene {
                    neighbours,
                    ..far.dem.clone()
                },
                ..far.clone()
            },
            1,
        )
    };
    let expected = run(Neighbours::AllPairs);
    assert!(run(Neighbours::HashedCells { length: 0.06 }) == expected);
    assert!(run(Neighbours::Cells { length: 0.06 }) == expected);
    let mut simulation = DemSimulation::new(&Scene {
        dem: DemScene {
            neighbours: Neighbours::HashedCells { length: 0.06 },
            ..far.dem
        },
        ..far
    })
    .unwrap();
    simulation.advance(300).unwrap();
    // Both pairs met, and no wall since.
    let particles = simulation.particles();
    let struck = particles.velocity[particles.fixed..].iter();
    assert_eq!(struck.filter(|velocity| velocity.x > 0.5).count(), 2);
    assert!(particles.velocity[particles.fixed + 3].x > 0.5);
}

#[test]
fn cells_that_are_too_small_are_refused_with_the_reason() {
    let place = Workplace::new();
    for search in ["cells", "hashed-cells"] {
        let text = format!(
            "neighbours = {{ search = \"{search}\", length = 0.0799 }}\n{}",
            super::HOPPER
        );
        place.write("small.toml", &text);
        place
            .phase(&["run", "small.toml"])
            .code(2)
            .complains("cells of 0.0799 m miss contacts")
            .complains("use `length = 0.08` or more");
        place.write("least.toml", &text.replace("0.0799", "0.08"));
        place.phase(&["check", "least.toml", "--no-trial"]).code(0);
    }
}
