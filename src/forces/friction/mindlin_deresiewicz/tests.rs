//! Partial slip compared with closed forms and with springs that slide independently.

use super::*;

const YOUNG_MODULUS: f64 = 70e9;
const POISSON_RATIO: f64 = 0.3;
const COEFFICIENT: f64 = 0.3;
/// Effective radius of a sphere of 4 mm at a wall (m).
const RADIUS: f64 = 0.004;

fn law() -> MindlinDeresiewiczLaw {
    MindlinDeresiewiczLaw::new(COEFFICIENT, YOUNG_MODULUS, POISSON_RATIO)
}

/// E* (Pa) of like materials.
fn effective_modulus() -> f64 {
    YOUNG_MODULUS / (2.0 * (1.0 - POISSON_RATIO * POISSON_RATIO))
}

fn normal_force(overlap: f64) -> f64 {
    4.0 / 3.0 * effective_modulus() * RADIUS.sqrt() * overlap * overlap.sqrt()
}

fn overlap(normal_force: f64) -> f64 {
    two_thirds(normal_force / normal_force_of_one())
}

fn normal_force_of_one() -> f64 {
    normal_force(1.0)
}

/// A contact along z whose surface moves by `way` (m) along x in a second.
fn touch(overlap: f64, way: f64) -> Touch {
    let velocity = Vector::new(way, 0.0, 0.0);
    let radius = (RADIUS * overlap).sqrt();
    Touch {
        normal: Vector::new(0.0, 0.0, 1.0),
        velocity,
        spin: [Vector::ZERO; 2],
        lever: [RADIUS, 0.0],
        inertia: [1e-6, 0.0],
        lesser_mass: 1e-3,
        effective_mass: 1e-3,
        contact_radius: radius,
        normal_force: normal_force(overlap),
        force_along_normal: normal_force(overlap),
        loading_velocity: velocity,
        loading_radius: radius,
        loading_time: 1.0,
    }
}

/// A contact that is moved.
#[derive(Default)]
struct MovedContact {
    history: SlipHistory,
    place: f64,
}

impl MovedContact {
    /// Moves it to a place (m) at an overlap (m). Returns the force on the sphere (N).
    fn go_to(&mut self, place: f64, overlap: f64) -> f64 {
        let touch = touch(overlap, place - self.place);
        let mut turning = self.history.turning;
        let loaded = law().load_and_turn(&touch, self.history.spring, &mut turning);
        let squared = loaded.squared();
        let (force, spring) = loaded.capped(squared, 1.0 / squared.sqrt().max(1e-300));
        self.history = SlipHistory { spring, turning };
        self.place = place;
        force.x
    }
}

/// The closed form (Mindlin and Deresiewicz, 1953), with a = 4.272e-5 m for a sphere at a wall.
#[test]
fn a_cycle_loses_what_the_closed_form_says() {
    let (normal, share) = (1.0, 0.9);
    let depth = overlap(normal);
    let limit = COEFFICIENT * normal;
    let stiffness = law().stiffness(depth, RADIUS);
    let reach = 1.5 * limit / stiffness * (1.0 - two_thirds(1.0 - share));
    for steps in [4, 40, 4000] {
        let mut contact = MovedContact::default();
        let (mut lost, mut before, mut largest) = (0.0, 0.0, 0.0_f64);
        for step in 0..=5 * steps {
            let turn = f64::from(step) / f64::from(steps);
            // Up in a quarter of a cycle, then a whole one.
            let place = match turn {
                turn if turn <= 1.0 => turn,
                turn if turn <= 3.0 => 2.0 - turn,
                turn => turn - 4.0,
            } * reach;
            let way = place - contact.place;
            let force = contact.go_to(place, depth);
            if turn > 1.0 {
                lost -= 0.5 * (force + before) * way;
            }
            largest = largest.max(force.abs());
            before = force;
        }
        assert!((largest / (share * limit) - 1.0).abs() < 1e-9, "{largest}");
        // Only the sum of trapezia depends on the steps.
        let error = (lost / 1.601003e-8 - 1.0).abs();
        let allowed = if steps == 4000 { 1e-5 } else { 0.3 };
        assert!(error < allowed, "{steps} steps: {lost}");
    }
}

/// A contact as a row of springs that stick and slide independently, which is exact for any path
/// along one line (Popov and Hess, Method of Dimensionality Reduction, Springer (2015), chapter 5).
fn foundation(path: &[(f64, f64)]) -> Vec<f64> {
    const SPRINGS: usize = 20_000;
    let half_width = 1.2e-4;
    let width = half_width / SPRINGS as f64;
    let stiffness = 0.5 * law().modulus * 2.0 * width;
    let mut forces = vec![0.0; SPRINGS];
    let mut before = 0.0;
    let mut found = Vec::new();
    for &(place, overlap) in path {
        for (k, force) in forces.iter_mut().enumerate() {
            let x = (k as f64 + 0.5) * width;
            let depth = (overlap - x * x / RADIUS).max(0.0);
            let limit = COEFFICIENT * effective_modulus() * depth * 2.0 * width;
            *force = (*force - stiffness * (place - before)).clamp(-limit, limit);
        }
        before = place;
        found.push(forces.iter().sum());
    }
    found
}

/// Places (m) and overlaps (m) along straight lines between corners.
fn path(corners: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let line = |two: &[(f64, f64)]| {
        let [(x, d), (x_end, d_end)] = [two[0], two[1]];
        (1..=400).map(move |step| {
            let part = f64::from(step) / 400.0;
            (x + part * (x_end - x), d + part * (d_end - d))
        })
    };
    corners.windows(2).flat_map(line).collect()
}

/// Name, largest error (mu F_n), corners of the path.
type PathCase<'a> = (&'a str, f64, &'a [(f64, f64)]);

#[test]
fn it_follows_independent_springs_where_the_normal_force_changes_too() {
    let depth = overlap(1.0);
    let full = 1.5 * COEFFICIENT * normal_force(depth) / law().stiffness(depth, RADIUS);
    // Unloaded in small steps to and fro.
    let teeth = (0..60).flat_map(|tooth| {
        let forth = 0.9 - 0.04 * f64::from(tooth);
        [(forth, 1.0), (forth - 0.05, 1.0)]
    });
    let teeth: Vec<_> = [(0.0, 1.0)].into_iter().chain(teeth).collect();
    let cases: [PathCase<'_>; 11] = [
        ("pressed, then loaded", 1e-6, &[(0.0, 1.0), (0.7, 1.0)]),
        (
            "loaded obliquely, sticking",
            2e-3,
            &[(0.5, 1.0), (0.9, 1.8)],
        ),
        ("loaded obliquely, sliding", 1e-6, &[(2.0, 1.0)]),
        (
            "loaded, then released",
            1e-6,
            &[(0.0, 1.0), (0.6, 1.0), (0.6, 0.3)],
        ),
        (
            "pressed and loaded",
            1e-6,
            &[(0.0, 1.0), (0.5, 1.0), (1.4, 1.5)],
        ),
        (
            "unloaded and released",
            1e-6,
            &[(0.0, 1.0), (0.7, 1.0), (0.1, 0.7)],
        ),
        (
            "unloaded and pressed",
            1e-6,
            &[(0.0, 1.0), (0.7, 1.0), (-0.2, 1.3)],
        ),
        (
            "a cycle",
            1e-4,
            &[(0.0, 1.0), (0.7, 1.0), (-0.7, 1.0), (0.9, 1.0), (2.0, 1.0)],
        ),
        // What the law forgets: that the rim of a contact pressed harder is not loaded, and the
        // outer of two turning points.
        (
            "pressed while held",
            0.15,
            &[(0.0, 1.0), (0.5, 1.0), (0.5, 1.5), (1.2, 1.5)],
        ),
        (
            "turned thrice",
            0.2,
            &[(0.0, 1.0), (0.8, 1.0), (0.0, 1.0), (0.3, 1.0), (-1.0, 1.0)],
        ),
        ("unloaded to and fro", 0.4, &teeth),
    ];
    for (name, most, corners) in cases {
        let start = [(0.0, 0.0)];
        let corners = start.iter().chain(corners);
        let scaled: Vec<_> = corners.map(|(x, d)| (x * full, d * depth)).collect();
        let path = path(&scaled);
        let exact = foundation(&path);
        let mut contact = MovedContact::default();
        let scale = COEFFICIENT * normal_force(depth);
        let mut worst = 0.0_f64;
        for (&(place, depth), exact) in path.iter().zip(exact) {
            worst = worst.max((contact.go_to(place, depth) - exact).abs() / scale);
        }
        assert!(worst < most, "{name}: {worst} of mu F_n");
    }
}

#[test]
fn its_energy_is_what_it_gives_back() {
    let depth = overlap(1.0);
    let stiffness = law().stiffness(depth, RADIUS);
    let full = 1.5 * COEFFICIENT / stiffness;
    let mut contact = MovedContact::default();
    contact.go_to(0.0, depth);
    contact.go_to(0.8 * full, depth);
    let stored = law().energy(&contact.history, depth, RADIUS);
    let (mut given, mut before) = (0.0, contact.history.spring.force.x);
    while before < 0.0 {
        let place = contact.place - 1e-4 * full;
        let way = place - contact.place;
        let force = contact.go_to(place, depth);
        given += 0.5 * (force.min(0.0) + before) * way;
        before = force;
    }
    assert!((given / stored - 1.0).abs() < 1e-3, "{given} {stored}");
}
