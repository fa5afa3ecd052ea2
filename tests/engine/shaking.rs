//! A shaken box, against closed forms in its frame: its position is A sin(w t + p).

use crate::ledger::{largest, last, with_ledger};
use phase::dem::DemSimulation;
use phase::particles::vector::Vector;
use phase::run;
use phase::scene::{Integrator, Scene};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;

const GRAVITY: f64 = 9.81;

fn scene(text: &str, integrator: Integrator) -> Scene {
    let text = format!("{text}\ntime.integrator = '{}'", integrator.name());
    Scene::from_toml(&text, Path::new("shaken.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// In the frame of the box a free sphere falls, and swings against the box.
#[test]
fn free_flight_has_the_order_of_the_integrator() {
    let (amplitude, frequency, phase) = (2e-3, 30.0, 0.7);
    let direction = Vector::new(1.0, 2.0, 2.0) * (1.0 / 3.0);
    let error = |integrator: Integrator, dt: f64| {
        let text = format!(
            "spheres = {{ count = 1, radius = 0.004, density = 2500.0 }}
            gravity.acceleration = {GRAVITY}
            shaking = {{ amplitude = {amplitude}, frequency = {frequency}, phase = {phase}, \
             direction = [1, 2, 2] }}
            start = {{ kind = 'list', spheres = [{{ position = [0, 0, 1], velocity = [0.1, 0, 0.2] \
             }}] }}
            time.dt = {dt}
            time.duration = 0.1
            time.frame_interval = 0.1"
        );
        let mut simulation = DemSimulation::new(&scene(&text, integrator)).unwrap();
        let steps = libm::round(0.1 / dt) as u64;
        simulation.advance(steps / 3).unwrap();
        simulation.advance(steps - steps / 3).unwrap();
        let time = simulation.time();
        let omega = TAU * frequency;
        let swing = libm::sin(omega * time + phase) - libm::sin(phase);
        let with_box = amplitude * (omega * libm::cos(phase) * time - swing);
        let expected = Vector::new(0.1, 0.0, 0.2) * time
            + Vector::new(0.0, 0.0, 1.0 - 0.5 * GRAVITY * time * time)
            + direction * with_box;
        (simulation.particles().position[0] - expected).norm()
    };
    for integrator in Integrator::ALL {
        let errors = [2e-4, 1e-4].map(|dt| error(integrator, dt));
        let order = libm::log2(errors[0] / errors[1]);
        let expected = match integrator {
            Integrator::SymplecticEuler => 1.0,
            _ => 2.0,
        };
        assert!((order - expected).abs() < 0.1, "{integrator:?}: {order}");
        let most = if expected == 1.0 { 3e-4 } else { 2e-6 };
        assert!(errors[1] < most, "{integrator:?}: {errors:?}");
    }
}

/// A hard floor: its oscillation is a thousand times faster than the shaking.
const RADIUS: f64 = 0.004;
const FREQUENCY: f64 = 10.0;
const MASS: f64 = 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS * 2500.0;
const STIFFNESS: f64 = MASS * (1e3 * TAU * FREQUENCY) * (1e3 * TAU * FREQUENCY);

/// A ball that rests on the floor at the start.
fn resting(gamma: f64, integrator: Integrator) -> Scene {
    let omega = TAU * FREQUENCY;
    let amplitude = gamma * GRAVITY / (omega * omega);
    let damping = 0.2 * MASS * 1e3 * omega;
    let height = RADIUS - MASS * GRAVITY / STIFFNESS;
    let text = format!(
        "spheres = {{ count = 1, radius = {RADIUS}, density = 2500.0 }}
        gravity.acceleration = {GRAVITY}
        contact = {{ law = 'linear', stiffness = {STIFFNESS}, damping = {damping} }}
        tank.floor = 0.0
        shaking = {{ amplitude = {amplitude}, gamma = {gamma} }}
        start = {{ kind = 'list', spheres = [{{ position = [0, 0, {height:?}] }}] }}
        time.dt = 4e-6
        time.duration = 0.2
        time.frame_interval = 1e-3"
    );
    scene(&text, integrator)
}

/// The floor carries m (g - A w^2 sin(w t)), and the overlap follows.
#[test]
fn below_the_acceleration_of_gravity_a_ball_stays_on_the_floor() {
    for integrator in Integrator::ALL {
        let mut simulation = DemSimulation::new(&resting(0.8, integrator)).unwrap();
        let mut worst = 0.0_f64;
        for _ in 0..200 {
            simulation.advance(250).unwrap();
            let overlap = RADIUS - simulation.particles().position[0].z;
            let phase = TAU * FREQUENCY * simulation.time();
            let expected = MASS * GRAVITY / STIFFNESS * (1.0 - 0.8 * libm::sin(phase));
            worst = worst.max((overlap / expected - 1.0).abs());
        }
        assert!(worst < 5e-3, "{integrator:?}: {worst}");
    }
}

/// It leaves the floor where A w^2 reaches g, to 1 %.
#[test]
fn a_ball_lifts_off_at_the_acceleration_of_gravity() {
    for integrator in Integrator::ALL {
        let lifts = |gamma: f64| {
            let mut simulation = DemSimulation::new(&resting(gamma, integrator)).unwrap();
            (0..50_000).any(|_| {
                simulation.advance(1).unwrap();
                simulation.particles().position[0].z >= RADIUS
            })
        };
        assert!(!lifts(0.99), "{integrator:?}");
        assert!(lifts(1.01), "{integrator:?}");
    }
}

/// A ball of restitution e is thrown once per period if pi (1 - e) / (1 + e) <= A w^2 / g, and this
/// orbit is stable while (A w^2 / g)^2 < (pi (1 - e) / (1 + e))^2 + (2 (1 + e^2) / (1 + e)^2)^2
/// (Holmes, J. Sound Vib. 84, 173 (1982); Luck and Mehta, Phys. Rev. E 48, 3988 (1993)). It leaves
/// the floor at the phase whose cosine is the least value over A w^2 / g, with w v = pi g.
///
/// Contacts last 1/200 of a period, and are found up to a step late, which changes what they
/// return: heights deviate by up to 4 % of the flight, and by 2 % with half the step.
#[test]
fn a_ball_keeps_to_its_orbit_of_one_period() {
    let restitution = 0.5;
    let logarithm = -libm::log(restitution);
    let share = logarithm / (PI * PI + logarithm * logarithm).sqrt();
    let stiffness = 1e-2 * STIFFNESS;
    let damping = 2.0 * share * (stiffness * MASS).sqrt();
    let least = PI * (1.0 - restitution) / (1.0 + restitution);
    let width =
        2.0 * (1.0 + restitution * restitution) / ((1.0 + restitution) * (1.0 + restitution));
    let most = (least * least + width * width).sqrt();
    let omega = TAU * FREQUENCY;
    // How far the heights of the second half of the run are from the orbit, at most, over the
    // height of its flight.
    let deviation = |gamma: f64, integrator: Integrator, disturbance: f64| {
        let phase = libm::acos(least / gamma);
        let amplitude = gamma * GRAVITY / (omega * omega);
        let launch = PI * GRAVITY / omega;
        let speed = launch - amplitude * omega * libm::cos(phase);
        let text = format!(
            "spheres = {{ count = 1, radius = {RADIUS}, density = 2500.0 }}
            gravity.acceleration = {GRAVITY}
            contact = {{ law = 'linear', stiffness = {stiffness}, damping = {damping} }}
            tank.floor = 0.0
            shaking = {{ amplitude = {amplitude}, gamma = {gamma}, phase = {phase}, \
             frames_per_period = 2, periods = 30 }}
            start = {{ kind = 'list', spheres = [{{ position = [0, 0, {RADIUS}], \
             velocity = [0, 0, {}] }}] }}
            time.dt = 5e-6
            output.snapshot_interval = 0",
            speed * (1.0 + disturbance)
        );
        let record = run::run(
            &scene(&text, integrator),
            &mut |_| ControlFlow::Continue(()),
        );
        let heights = record.unwrap().observations.height_mean;
        assert_eq!(heights.len(), 61);
        let flight = launch * launch / (2.0 * GRAVITY);
        let expected = RADIUS + flight + 2.0 * amplitude * libm::sin(phase);
        let halves = heights.iter().skip(31).step_by(2);
        let worst = halves.map(|it| (f64::from(*it) - expected).abs() / flight);
        worst.fold(0.0, f64::max)
    };
    for integrator in Integrator::ALL {
        for gamma in [1.1 * least, 0.5 * (least + most), 0.9 * most] {
            let worst = deviation(gamma, integrator, 0.01);
            assert!(worst < 0.05, "{integrator:?}, {gamma}: {worst}");
        }
    }
    // Beyond, the flights become unequal.
    let unequal = deviation(1.1 * most, Integrator::VelocityVerlet, 0.01);
    assert!(unequal > 0.3, "{unequal}");
}

/// The work of the shaking has its own account. The residual shrinks as without it: with the step
/// for symplectic Euler, with its square for the others.
#[test]
fn the_books_close_where_spheres_are_shaken() {
    for integrator in Integrator::ALL {
        let books = |dt: f64, shaking: &str| {
            let text = format!(
                "spheres = {{ count = 1, radius = 0.004, density = 1e4 }}
                contact = {{ law = 'hertz', young_modulus = 2e5, poisson_ratio = 0.3, \
                 dissipation_time = 2e-4 }}
                friction = {{ law = 'mindlin', coefficient = 0.9 }}
                tank.floor = 0.0
                gravity.acceleration = 200.0
                {shaking}
                drag = {{ law = 'constant', linear = 2e-3, quadratic = 5e-2 }}
                swirl.omega = 30.0
                start = {{ kind = 'list', spheres = [{{ position = [0.1, 0, 0.0036], \
                 velocity = [0.03, -0.02, 0], spin = [2, 1, 3] }}] }}
                time.dt = {dt}
                time.duration = 0.01
                time.frame_interval = 1e-4
                output.snapshot_interval = 0"
            );
            with_ledger(&scene(&text, integrator))
        };
        let shaking = "shaking = { amplitude = 5e-4, frequency = 70.0, direction = [1, 0, 2] }";
        let [coarse, fine] = [2e-5, 1e-5].map(|dt| books(dt, shaking));
        let residuals = [&coarse, &fine].map(|it| largest(&it.residual));
        let order = libm::log2(residuals[0] / residuals[1]);
        let expected = match integrator {
            Integrator::SymplecticEuler => 1.0,
            _ => 2.0,
        };
        let still = books(1e-5, "");
        let without = largest(&still.residual);
        assert!((order - expected).abs() < 0.15, "{integrator:?}: {order}");
        assert!(residuals[1] < 3.0 * without, "{residuals:?} {without}");
        assert!(largest(&fine.work_of_shaking) > 10.0 * residuals[1]);
        assert!(still.work_of_shaking.is_empty());
    }
}

/// A box without gravity: what its spheres dissipate is what the shaking gives them.
#[test]
fn a_damper_without_gravity_dissipates_the_work_of_shaking() {
    for integrator in Integrator::ALL {
        let text = "spheres = { count = 3, radius = 0.004, density = 2500.0 }
            contact = { law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, \
             restitution = 0.6 }
            tank.width = 0.06
            start.kind = 'list'
            start.spheres = [{ position = [-0.02, 0, 0] }, { position = [0, 0, 0] }, \
             { position = [0.015, 0, 0] }]
            shaking = { amplitude = 0.01, frequency = 10.0, direction = [1, 0, 0], \
             frames_per_period = 10, periods = 20 }
            time.dt = 2e-5
            output.snapshot_interval = 0";
        let books = with_ledger(&scene(text, integrator));
        let work = last(&books.work_of_shaking);
        let damping = last(&books.dissipated_by_damping);
        let kinetic = last(&books.kinetic) + last(&books.elastic);
        let residual = largest(&books.residual);
        assert!(damping > 0.5 * work && work > 0.0, "{work} {damping}");
        assert!(((damping + kinetic) / work - 1.0).abs() < 0.02);
        assert!(residual < 1e-3 * work, "{residual} of {work}");
    }
}

/// A fluid is shaken with the box: a sphere of its density is carried along.
#[test]
fn a_sphere_as_heavy_as_its_fluid_is_not_shaken() {
    for integrator in Integrator::ALL {
        let falls = |density: f64| {
            let text = format!(
                "spheres = {{ count = 1, radius = 0.004, density = {density} }}
                gravity.acceleration = {GRAVITY}
                buoyancy.density = 1000.0
                added_mass.density = 1000.0
                shaking = {{ amplitude = 2e-3, frequency = 30.0 }}
                start = {{ kind = 'list', spheres = [{{ position = [0, 0, 0] }}] }}
                time.dt = 1e-4
                time.duration = 0.1
                time.frame_interval = 0.1
                output.snapshot_interval = 0"
            );
            let mut simulation = DemSimulation::new(&scene(&text, integrator)).unwrap();
            simulation.advance(1000).unwrap();
            simulation.particles().position[0].z
        };
        assert_eq!(falls(1000.0), 0.0);
        // Three whole periods: -g t^2 / 2 + A w t, times (1 - 1/2) / (1 + 1/4).
        let free = -0.5 * GRAVITY * 0.01 + 2e-3 * TAU * 30.0 * 0.1;
        assert!(
            (falls(2000.0) / (0.4 * free) - 1.0).abs() < 0.06,
            "{integrator:?}"
        );
    }
}

/// Frames have the phases asked for, whatever the frequency of a point.
#[test]
fn frames_follow_the_period() {
    let base = Scene::load_base(Path::new("tests/good/shaken.toml")).unwrap();
    let run = Scene::load(Path::new("tests/good/shaken.toml")).unwrap();
    for gamma in [1.5, 3.0] {
        let point = base.with_values([("shaking.gamma", gamma)]).unwrap();
        let point = point.with_chosen_step().unwrap();
        let period = TAU * (2e-3 / (gamma * GRAVITY)).sqrt();
        let time = &point.time;
        assert!((time.frame_interval * 20.0 / period - 1.0).abs() < 1e-12);
        assert_eq!((time.frames(), time.safety_factor), (800, None));
        let steps = time.frame_interval / time.dt;
        assert!((steps - steps.round()).abs() < 1e-9, "{steps}");
        let shaking = point.dem.effects.shaking.clone().unwrap();
        assert_eq!((shaking.frames_per_period, shaking.periods), (None, None));
        assert_eq!(point == run, gamma == 3.0);
    }
}
