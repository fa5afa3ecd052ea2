//! Forces and torques of spheres on walls, as columns: closed forms, and balances of momentum and
//! work. `verify/columns.toml` has those on the walls of a tank.

use crate::ledger::last;
use phase::dem::DemSimulation;
use phase::particles::vector::Vector;
use phase::run;
use phase::scene::Scene;
use phase::simulation::Simulation;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// Spheres of 4 mm and 1 kg/l that record the forces on walls.
fn scene(count: usize, text: &str) -> Scene {
    let text = format!(
        "spheres = {{ count = {count}, radius = 0.004, density = 1000 }}
        gravity = {{ acceleration = 9.8 }}
        time = {{ dt = 1e-5, duration = 1.0, frame_interval = 1e-3, \
                  integrator = 'velocity-verlet' }}
        output = {{ walls = true }}
        {text}"
    );
    let scene: Scene = toml::from_str(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(scene.problems(), [], "{text}");
    scene
}

fn at(position: [f64; 3]) -> String {
    format!("start = {{ kind = 'list', spheres = [{{ position = {position:?} }}] }}")
}

const DAMPED: &str = "contact = { law = 'linear', stiffness = 2000.0, damping = 0.2 }";
/// Weight of a sphere (N).
const WEIGHT: f64 = 4.0 / 3.0 * PI * 0.004 * 0.004 * 0.004 * 1000.0 * 9.8;

/// The force and the torque on each wall.
fn loads(simulation: &mut DemSimulation) -> BTreeMap<String, [Vector; 2]> {
    let values = simulation.values();
    let columns = Simulation::columns(simulation);
    assert_eq!(columns.len(), values.len());
    let mut loads = BTreeMap::new();
    for (columns, values) in columns.chunks(6).zip(values.chunks(6)) {
        let wall = columns[0].name.strip_suffix("_force_x").unwrap();
        assert_eq!(columns[5].name, format!("{wall}_torque_z"));
        assert_eq!([columns[0].unit, columns[5].unit], ["N", "N m"]);
        let [force, torque] = [0, 3].map(|i| Vector::new(values[i], values[i + 1], values[i + 2]));
        loads.insert(wall.to_owned(), [force, torque]);
    }
    loads
}

#[track_caller]
fn assert_near(one: Vector, other: Vector, tolerance: f64) {
    assert!((one - other).norm() <= tolerance, "{one:?} {other:?}");
}

/// A sphere in a V of two plates, 30 and 60 degrees steep.
fn in_a_groove(laws: &str) -> (BTreeMap<String, [Vector; 2]>, Vector) {
    let (sine, cosine) = libm::sincos(PI / 6.0);
    let walls = format!(
        "wall = [
            {{ name = 'gentle', plate = {{ corner = [0, -0.1, 0], \
               first_edge = [{}, 0, {}], second_edge = [0, 0.2, 0] }} }},
            {{ name = 'steep', plate = {{ corner = [0, -0.1, 0], \
               first_edge = [{}, 0, {}], second_edge = [0, 0.2, 0] }} }},
        ]",
        -0.1 * cosine,
        0.1 * sine,
        0.1 * sine,
        0.1 * cosine
    );
    // A right angle: the centre is a radius from each plate.
    let place = Vector::new(-cosine + sine, 0.0, sine + cosine) * 0.004;
    let start = at([place.x, place.y, place.z]);
    let mut simulation =
        DemSimulation::new(&scene(1, &format!("{walls}\n{laws}\n{start}"))).unwrap();
    simulation.advance(200_000).unwrap();
    let end = simulation.particles().position[0];
    (loads(&mut simulation), end)
}

#[test]
fn a_groove_carries_a_sphere_by_the_closed_form() {
    let (loads, _) = in_a_groove(DAMPED);
    let (sine, cosine) = libm::sincos(PI / 6.0);
    let gentle = Vector::new(-sine, 0.0, -cosine) * (WEIGHT * cosine);
    let steep = Vector::new(cosine, 0.0, -sine) * (WEIGHT * sine);
    for (wall, force) in [("gentle", gentle), ("steep", steep)] {
        let [found, torque] = loads[wall];
        assert_near(found, force, 1e-6 * WEIGHT);
        // It touches a radius, less the overlap, from the common edge, 0.1 m from the corners.
        assert!((torque.x / force.z - 0.1).abs() < 1e-6, "{wall} {torque:?}");
        let arm = torque.y.abs() / force.norm();
        assert!((arm - 0.004).abs() < 1e-5, "{wall} {arm}");
    }
}

#[test]
fn a_groove_with_friction_carries_the_weight() {
    let (loads, place) = in_a_groove(
        "contact = { law = 'hooke', stiffness = 2000.0, damping_rate = 300.0 }
        friction = { law = 'hooke', coefficient = 0.5, stiffness = 600.0, damping_rate = 150.0 }",
    );
    let sum = |which: usize| loads["gentle"][which] + loads["steep"][which];
    let weight = Vector::new(0.0, 0.0, -WEIGHT);
    assert_near(sum(0), weight, 1e-6 * WEIGHT);
    // Without the overlaps, both torques are about the same corner.
    let about_corner = (place - Vector::new(0.0, -0.1, 0.0)).cross(weight);
    assert_near(sum(1), about_corner, 1e-5 * WEIGHT);
}

/// Where two plates join, the weight passes from one to the other, and none of it is lost.
#[test]
fn walls_share_what_acts_where_they_join() {
    let walls = "wall = [
        { plate = { corner = [-0.1, -0.1, 0], first_edge = [0.1, 0, 0], second_edge = [0, 0.2, 0] } },
        { name = 'right', plate = { corner = [0, -0.1, 0], first_edge = [0.1, 0, 0], \
          second_edge = [0, 0.2, 0] } },
    ]";
    for (x, share) in [(-0.002, 1.0), (0.0, 0.5), (0.002, 0.0)] {
        let scene = scene(1, &format!("{walls}\n{DAMPED}\n{}", at([x, 0.0, 0.004])));
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(200_000).unwrap();
        let loads = loads(&mut simulation);
        let forces = [loads["wall_0"][0].z, loads["right"][0].z];
        for (force, share) in forces.into_iter().zip([share, 1.0 - share]) {
            assert!(
                (force + share * WEIGHT).abs() < 1e-6 * WEIGHT,
                "{x}: {forces:?}"
            );
        }
    }
}

/// A door has no force when it is gone; the wall that it joined keeps all of its own.
#[test]
fn a_door_that_is_gone_carries_nothing() {
    let scene = scene(
        2,
        &format!(
            "wall = [
            {{ name = 'gate', plate = {{ corner = [0, -0.1, 0.1], first_edge = [0.1, 0, 0], \
               second_edge = [0, 0.2, 0] }}, is_door = true }},
            {{ name = 'shelf', plate = {{ corner = [-0.1, -0.1, 0.1], first_edge = [0.1, 0, 0], \
               second_edge = [0, 0.2, 0] }} }},
        ]
        {DAMPED}
        door = {{ opens = 0.5 }}
        tank = {{ floor = 0.0 }}
        start = {{ kind = 'list', spheres = [
            {{ position = [0.05, 0, 0.104] }},
            {{ position = [-0.00005, 0, 0.104] }},
        ] }}",
        ),
    );
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(49_000).unwrap();
    let closed = loads(&mut simulation);
    let vertical = |wall: &str| closed[wall][0].z;
    assert!((vertical("gate") + vertical("shelf") + 2.0 * WEIGHT).abs() < 1e-5 * WEIGHT);
    assert!(vertical("shelf") < -0.5 * WEIGHT);
    assert_eq!(vertical("floor"), 0.0);
    simulation.advance(6_000).unwrap();
    let open = loads(&mut simulation);
    assert_eq!(open["gate"], [Vector::ZERO; 2]);
    simulation.advance(300_000).unwrap();
    let open = loads(&mut simulation);
    let carried = open["floor"][0].z + open["shelf"][0].z;
    assert!((carried + 2.0 * WEIGHT).abs() < 1e-4 * WEIGHT, "{open:?}");
}

/// Spheres that bounce over a roof between walls: in every step the momentum changes by their weight
/// and by what they do not give to walls.
#[test]
fn the_forces_on_all_walls_balance_the_momentum() {
    let scene = scene(
        60,
        "wall = [
            { name = 'west', plate = { corner = [0, -0.1, 0.02], first_edge = [-0.03, 0, -0.03], \
              second_edge = [0, 0.2, 0] } },
            { name = 'east', plate = { corner = [0, -0.1, 0.02], first_edge = [0.04, 0, -0.01], \
              second_edge = [0, 0.2, 0] } },
            { name = 'bottom', disc = { centre = [0, 0, -0.01], radius = 0.04 } },
            { name = 'tube', cylinder = { base = [0, 0, -0.01], axis = [0, 0, 1], radius = 0.04, \
              length = 0.08 } },
            { name = 'rim', cone = { base = [0, 0, 0.07], axis = [0, 0, 1], radius = 0.04, \
              end_radius = 0.08, length = 0.04 } },
        ]
        tank = { radius = 0.06, floor = -0.02 }
        contact = { law = 'linear', stiffness = 2000.0, damping = 0.0 }
        start = { kind = 'random', x = [-0.03, 0.03], y = [-0.03, 0.03], z_min = 0.03, z_max = 0.12 }",
    );
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let mass = simulation.particles().mass[0];
    let momentum = |simulation: &DemSimulation| {
        let velocities = simulation.particles().velocity.iter();
        velocities.fold(Vector::ZERO, |sum, &it| sum + it * mass)
    };
    let force = |simulation: &mut DemSimulation| {
        let loads = loads(simulation);
        loads.values().fold(Vector::ZERO, |sum, load| sum + load[0])
    };
    let weight = Vector::new(0.0, 0.0, -60.0 * WEIGHT);
    let (mut before, mut pushed) = (momentum(&simulation), force(&mut simulation));
    let (mut largest, mut touched) = (0.0_f64, BTreeMap::<String, usize>::new());
    for _ in 0..20_000 {
        simulation.advance(1).unwrap();
        let (now, push) = (momentum(&simulation), force(&mut simulation));
        let change = (weight * 2.0 - pushed - push) * (0.5 * 1e-5);
        assert_near(now - before, change, 1e-12 * 60.0 * mass);
        (before, pushed) = (now, push);
        largest = largest.max(push.norm());
        for (wall, load) in loads(&mut simulation) {
            *touched.entry(wall).or_default() += usize::from(load[0].norm() > 0.0);
        }
    }
    assert!(largest > 60.0 * WEIGHT, "{largest}");
    let some = ["west", "east", "tube"];
    assert!(some.iter().all(|wall| touched[*wall] > 100), "{touched:?}");
}

/// What a drum's drive gives, its torque about the axis times its rate, is the work of the ledger,
/// with rolling resistance too. Regression: the ledger left out the work of rolling resistance, as
/// only damping and friction were booked at walls.
#[test]
fn the_torque_on_a_drum_is_the_work_of_its_walls() {
    check_work_of_drum("", 5e-3);
    // Springs of rolling that a frame sees are a step old.
    check_work_of_drum("rolling = { coefficient = 0.3, damping = 0.3 }", 1e-2);
}

fn check_work_of_drum(rolling: &str, tolerance: f64) {
    let text = "wall = [
            { name = 'drum', cylinder = { base = [0, -0.012, 0], axis = [0, 1, 0], radius = 0.04, \
              length = 0.024 }, angular_velocity = 6.0 },
            { name = 'front', disc = { centre = [0, -0.012, 0], axis = [0, 1, 0], radius = 0.04 }, \
              angular_velocity = 6.0 },
            { name = 'back', disc = { centre = [0, 0.012, 0], axis = [0, 1, 0], radius = 0.04 } },
        ]
        contact = { law = 'hertz', young_modulus = 5e5, poisson_ratio = 0.3, restitution = 0.5 }
        friction = { law = 'mindlin', coefficient = 0.5 }
        start = { kind = 'random', x = [-0.025, 0.025], y = [-0.012, 0.012], z_min = -0.025, \
                  z_max = 0.025 }";
    let mut scene = scene(24, &format!("{text}\n{rolling}"));
    scene.time.duration = 0.4;
    scene.time.frame_interval = 2e-5;
    scene.time.dt = 2e-5;
    scene.output.ledger = true;
    assert_eq!(scene.problems(), []);
    let record = run::run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
    let scalars = record.observations.scalars();
    let series = |name: &str| {
        let found = scalars.iter().find(|it| it.name == name);
        found.unwrap().values
    };
    let mut work = 0.0;
    for wall in ["drum_torque_y", "front_torque_y"] {
        let torques = series(wall).iter().map(|&it| f64::from(it));
        work -= torques.sum::<f64>() * 6.0 * 2e-5;
    }
    let expected = last(&record.observations.work_of_walls);
    assert!(expected > 0.01 * 24.0 * WEIGHT * 0.04, "{expected}");
    assert!(
        (work - expected).abs() < tolerance * expected,
        "{work} {expected} {rolling}"
    );
    // The end that rests is rubbed by spheres, but does no work.
    assert!(series("back_torque_y").iter().any(|it| *it > 0.0));
}

/// A sphere that rolling resistance holds on a slope: the slope carries its weight as it is, at its
/// centre.
#[test]
fn torques_hold_those_of_rolling_resistance() {
    let mut scene = scene(
        1,
        &format!(
            "wall = [{{ name = 'slope', plane = {{ point = [1, 2, 0], normal = [0, 0, 1] }} }}]
        contact = {{ law = 'hooke', stiffness = 2000.0, damping_rate = 300.0 }}
        friction = {{ law = 'hooke', coefficient = 0.9, stiffness = 600.0, damping_rate = 150.0 }}
        rolling = {{ coefficient = 0.5, damping = 0.5 }}
        {}",
            at([0.0, 0.0, 0.004])
        ),
    );
    scene.dem.effects.gravity.as_mut().unwrap().tilt = 0.2;
    let mut simulation = DemSimulation::new(&scene).unwrap();
    simulation.advance(200_000).unwrap();
    let place = simulation.particles().position[0];
    let [force, torque] = loads(&mut simulation)["slope"];
    let (sine, cosine) = libm::sincos(0.2);
    let weight = Vector::new(sine, 0.0, -cosine) * WEIGHT;
    assert_near(force, weight, 1e-6 * WEIGHT);
    let about_point = (place - Vector::new(1.0, 2.0, 0.0)).cross(weight);
    // Less than the overlap times the friction; the resistance itself is 0.2 of this product.
    assert_near(torque, about_point, 1e-3 * WEIGHT * 0.004);
}
