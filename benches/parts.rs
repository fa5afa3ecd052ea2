//! Times of single parts: laws, lists, observers. `benches/README.md` says how to run them.

#![allow(clippy::unwrap_used, reason = "a benchmark may panic")]

use divan::Bencher;
use divan::counter::ItemsCount;
use phase::dem::DemSimulation;
use phase::dem::neighbours::{Reach, VerletList};
use phase::forces::contact::{HertzLaw, NormalLaw};
use phase::forces::friction::{CoulombLaw, Frictionless, MindlinLaw, Spring, TangentialLaw, Touch};
use phase::observe::Observer;
use phase::particles::vector::Vector;
use phase::scene::{Neighbours, Scene, Start};
use phase::start;
use std::hint::black_box;
use std::path::Path;

fn main() {
    divan::main();
}

/// A scene of this repository.
fn scene(path: &str) -> Scene {
    phase::scene::Scene::load(Path::new(path)).unwrap()
}

/// As many pairs as the engine takes at once.
const BLOCK: usize = 32;

/// Effective radius of the spheres (m).
const EFFECTIVE_RADIUS: f64 = 0.002;

/// Touching pairs of equal spheres that roll and slide along each other.
fn touches() -> Vec<Touch> {
    let touch = |k: usize| {
        let share = (k + 1) as f64 / BLOCK as f64;
        Touch {
            normal: Vector::new(0.6, 0.0, 0.8),
            velocity: Vector::new(0.1 * share, 0.02, -0.05),
            spin: [Vector::new(1.0, share, 0.0), Vector::new(0.0, -share, 2.0)],
            lever: [0.004; 2],
            inertia: [1e-8; 2],
            lesser_mass: 2.7e-3,
            effective_mass: 1.35e-3,
            normal_force: 0.0,
            force_along_normal: 0.0,
            loading_velocity: Vector::new(0.1 * share, 0.02, 0.0),
            contact_radius: (EFFECTIVE_RADIUS * 1e-4 * share).sqrt(),
            loading_radius: (EFFECTIVE_RADIUS * 1e-4 * share).sqrt(),
            loading_time: 1e-4,
        }
    };
    (0..BLOCK).map(touch).collect()
}

/// The laws alone of a block of pairs: what the engine puts around them is in the whole scenes.
fn laws<T: TangentialLaw>(bencher: Bencher<'_, '_>, tangential: T) {
    let normal = HertzLaw::new(2.83e5, 0.3, 1e-3, 1.0);
    let touches = touches();
    let mut springs = [Spring::default(); BLOCK];
    bencher.counter(ItemsCount::new(BLOCK)).bench_local(|| {
        let mut sum = Vector::ZERO;
        for (touch, spring) in black_box(&touches).iter().zip(&mut springs) {
            let rate = -touch.velocity.dot(touch.normal);
            let radius = touch.loading_radius;
            let overlap = radius * radius / EFFECTIVE_RADIUS;
            let force = normal.force(overlap, rate, radius, touch.effective_mass);
            let touch = Touch {
                normal_force: force,
                force_along_normal: force,
                ..*touch
            };
            *spring = spring.turned(touch.normal);
            sum += touch.normal * force + tangential.traction(&touch, spring).force;
        }
        sum
    });
}

#[divan::bench]
fn block_of_pairs_hertz(bencher: Bencher<'_, '_>) {
    laws(bencher, Frictionless);
}

#[divan::bench]
fn block_of_pairs_hertz_coulomb(bencher: Bencher<'_, '_>) {
    laws(bencher, CoulombLaw::new(0.3, 1e-3));
}

#[divan::bench]
fn block_of_pairs_hertz_mindlin(bencher: Bencher<'_, '_>) {
    laws(bencher, MindlinLaw::new(0.3, 2.83e5, 0.3));
}

/// Building the list of all pairs that may touch, of spheres strewn over a tank.
#[divan::bench(args = [256, 4096, 55_000])]
fn list_of_contacts(bencher: Bencher<'_, '_>, count: usize) {
    list(bencher, count, Reach::Contact, 0.5);
}

/// The same of whole columns, for an updraught's shield.
#[divan::bench(args = [256, 4096])]
fn list_of_columns(bencher: Bencher<'_, '_>, count: usize) {
    list(bencher, count, Reach::Column, 1.0);
}

fn list(bencher: Bencher<'_, '_>, count: usize, reach: Reach, skin: f64) {
    let mut scene = scene("benches/bed.toml");
    let scale = libm::cbrt(count as f64 / scene.spheres.count as f64);
    scene.spheres.count = count;
    *scene.tank.as_mut().unwrap().radius.as_mut().unwrap() *= scale;
    if let Start::Random { z_max, .. } = &mut scene.start {
        *z_max *= scale;
    }
    let particles = start::place(&scene).unwrap();
    let skin = skin * particles.largest_radius();
    let mut list = VerletList::new(reach, skin, Neighbours::VerletList);
    bencher
        .counter(ItemsCount::new(count))
        .bench_local(|| list.build(&particles, 1));
}

/// One frame: the elastic energy of contacts, and all observers.
#[divan::bench]
fn frame_of_observers(bencher: Bencher<'_, '_>) {
    let scene = scene("sweeps/scenes/theoretical.toml");
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let second = (1.0 / scene.time.dt).round() as u64;
    simulation.advance(second).unwrap();
    let mut observer = Observer::new(&scene, &simulation.particles().radius);
    let mut time = 0.0;
    bencher
        .counter(ItemsCount::new(scene.spheres.count))
        .bench_local(|| {
            time += scene.time.frame_interval;
            observer.observe(time, &simulation.frame());
        });
}
