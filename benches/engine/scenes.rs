//! Whole scenes: what a step costs from a moment on. Items are sphere-steps.

use super::states;
use divan::Bencher;
use divan::counter::ItemsCount;
use phase::dem::Simulation;
use phase::scene::Scene;

/// Advances from a time (s) on; each sample is so many steps.
fn steps(bencher: Bencher<'_, '_>, scene: &Scene, from: f64, steps: u64) {
    let mut simulation: Simulation = states::at(scene, from);
    let particles = simulation.particles();
    let moving = (particles.len() - particles.fixed) as u64;
    bencher
        .counter(ItemsCount::new(moving * steps))
        .bench_local(|| simulation.advance(steps).unwrap());
}

/// Settled, pinned and spouting.
#[divan::bench(args = [0.0, 8.0, 24.0], sample_size = 1)]
fn theoretical_tank(bencher: Bencher<'_, '_>, omega: f64) {
    steps(bencher, &states::theoretical(omega), 1.0, 200);
}

#[divan::bench(sample_size = 1)]
fn realistic_tank(bencher: Bencher<'_, '_>) {
    let scene = states::scene("sweeps/scenes/realistic.toml");
    steps(bencher, &scene, 1.0, 200);
}

/// While it is filled: 400 of 1000 grains are in.
#[divan::bench(sample_size = 1)]
fn silo(bencher: Bencher<'_, '_>) {
    let scene = states::scene("sweeps/scenes/silo.toml");
    steps(bencher, &scene, 20.0, 20);
}

#[divan::bench(args = ["none", "coulomb", "mindlin"], sample_size = 1)]
fn bed_of_256(bencher: Bencher<'_, '_>, friction: &str) {
    steps(bencher, &states::bed(256, friction), 2.0, 200);
}

#[divan::bench(args = ["none", "coulomb", "mindlin"], sample_size = 1)]
fn bed_of_4096(bencher: Bencher<'_, '_>, friction: &str) {
    steps(bencher, &states::bed(4096, friction), 1.0, 20);
}

#[divan::bench(args = ["mindlin"], sample_size = 1, sample_count = 20)]
fn bed_of_55000(bencher: Bencher<'_, '_>, friction: &str) {
    steps(bencher, &states::bed(55_000, friction), 0.5, 5);
}
