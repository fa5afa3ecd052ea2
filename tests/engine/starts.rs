//! Whatever sort of start stands in whatever sort of wall, the check says so.
//!
//! Symptom: a feed two thirds of a radius inside the cylinder and the floor passed the check, and
//! its spheres were shot out at 2.85 m/s. Cause: the check knew feeds in fixed spheres, random
//! starts in the floor and listed centres beyond walls, and nothing else.

use phase::dem::{DemSimulation, OverlapPartner, Release};
use phase::document::Problem;
use phase::scene::{Scene, Start, StartSphere};
use proptest::prelude::*;

/// Radius of all spheres (m).
const R: f64 = 0.03;

const ROUND: &str = "tank = { radius = 0.15, floor = 0.0 }";
const BOX: &str = "tank = { width = 0.3, depth = 0.3, floor = 0.0 }";
const ORIFICE: &str = "tank = { radius = 0.3, floor = 0.0, orifice_radius = 0.1 }";
const SLIT: &str = "tank = { width = 0.6, depth = 0.4, floor = 0.0, slit_width = 0.2 }";
const FIXED: &str =
    "geometry = { kind = 'list', walls = [{ position = [0.5, 0, 0.5], radius = 0.03 }] }";
const DOOR: &str = "geometry = { kind = 'list', walls = [], \
                    door = [{ position = [0.5, 0, 0.5], radius = 0.03 }] }";

/// A sort of wall: its name, its tables, and the place of a sphere that is a number of radii deep
/// in it.
type Wall = (&'static str, String, fn(f64) -> [f64; 3]);

/// Every sort of wall.
fn walls() -> Vec<Wall> {
    let with_door = |tank: &str| format!("{tank}\ndoor = {{ opens = 0.1 }}");
    vec![
        ("floor", ROUND.into(), |deep| [0.0, 0.0, R - deep * R]),
        ("cylinder", ROUND.into(), |deep| {
            [0.0, -0.12 - deep * R, 0.2]
        }),
        ("side", BOX.into(), |deep| [0.12 + deep * R, 0.0, 0.2]),
        ("back", BOX.into(), |deep| [0.0, 0.12 + deep * R, 0.2]),
        ("orifice", ORIFICE.into(), beside_edge),
        ("slit", SLIT.into(), beside_edge),
        ("closed orifice", with_door(ORIFICE), |deep| {
            [0.0, 0.0, R - deep * R]
        }),
        ("closed slit", with_door(SLIT), |deep| {
            [0.0, 0.0, R - deep * R]
        }),
        ("fixed", FIXED.into(), |deep| {
            [0.5 + 2.0 * R - deep * R, 0.0, 0.5]
        }),
        ("door", DOOR.into(), |deep| {
            [0.5, 0.0, 0.5 - 2.0 * R + deep * R]
        }),
    ]
}

/// A place over the edge of an opening, at 45 degrees.
fn beside_edge(deep: f64) -> [f64; 3] {
    let along = (1.0 - deep) * R * std::f64::consts::FRAC_1_SQRT_2;
    [0.1 - along, 0.0, along]
}

fn scene(tables: &str, start: Start) -> Scene {
    let text = format!(
        "{tables}
        spheres = {{ count = 1, radius = {R}, density = 2500.0 }}
        contact = {{ law = 'hertz', young_modulus = 1e6, poisson_ratio = 0.3, restitution = 0.3 }}
        gravity = {{ acceleration = 0.05 }}
        time = {{ dt = 1e-6, duration = 1.0, frame_interval = 1e-2 }}
        output = {{ snapshot_interval = 0.0 }}
        start = {{ kind = 'list', spheres = [] }}"
    );
    let mut scene: Scene = toml::from_str(&text).unwrap();
    if let Start::List { spheres } = &start {
        scene.spheres.count = spheres.len();
    }
    scene.start = start;
    scene
}

fn list(places: &[[f64; 3]]) -> Start {
    Start::list(places.iter().map(|&place| StartSphere::at(place)).collect())
}

fn feed(position: [f64; 3], spread: f64) -> Start {
    Start::Feed {
        position,
        velocity: [0.0; 3],
        interval: 0.5,
        spread,
    }
}

fn messages(problems: &[Problem]) -> Vec<String> {
    problems.iter().map(ToString::to_string).collect()
}

#[test]
fn a_sphere_that_touches_no_wall_is_accepted() {
    for (name, tables, place) in walls() {
        for start in [list(&[place(-1e-4)]), feed(place(-1e-4), 0.0)] {
            let scene = scene(&tables, start);
            assert_eq!(messages(&scene.problems()), [""; 0], "{name}");
            assert_eq!(Release::of_scene(&scene), None, "{name}");
        }
    }
}

#[test]
fn a_feed_in_a_wall_is_refused_however_deep_it_is() {
    for (name, tables, place) in walls() {
        for deep in [1e-3, 0.3, 0.67, 0.99, 1.2, 1.9] {
            let problems = scene(&tables, feed(place(deep), 0.0)).problems();
            assert_eq!(
                problems.len(),
                1,
                "{name} {deep}: {:?}",
                messages(&problems)
            );
            assert_eq!(problems[0].path, "start.position", "{name}");
        }
    }
}

/// A list may go on from a former state, in which contacts are deep. A warning
/// names what that state cannot have come to by itself.
#[test]
fn a_list_in_a_wall_is_refused_beyond_it_and_told_of_before() {
    for (name, tables, place) in walls() {
        for deep in [0.3, 0.67, 0.9] {
            let scene = scene(&tables, list(&[[0.0, 0.0, 0.1], place(deep)]));
            assert_eq!(messages(&scene.problems()), [""; 0], "{name} {deep}");
            let release = Release::of_scene(&scene).unwrap_or_else(|| panic!("{name} {deep}"));
            assert_eq!(release.fastest.sphere, 1, "{name}");
            assert!((release.fastest.depth - deep * R).abs() < 1e-12, "{name}");
            assert_eq!(release.others, 0);
        }
        let problems = scene(&tables, list(&[place(1.2)])).problems();
        assert_eq!(problems.len(), 1, "{name}: {:?}", messages(&problems));
        assert_eq!(problems[0].path, "start.spheres[0].position", "{name}");
    }
}

/// The warning names the speed of the run: without losses the sphere reaches it.
#[test]
fn the_speed_that_is_told_is_reached() {
    for (name, tables, place) in walls() {
        let mut scene = scene(&tables, list(&[place(0.3)]));
        scene.dem.contact = toml::from_str(
            "law = 'hertz'\nyoung_modulus = 1e6\npoisson_ratio = 0.3\ndissipation_time = 0.0",
        )
        .unwrap();
        scene.dem.effects.gravity = None;
        let told = Release::of_scene(&scene).unwrap().fastest.speed;
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(40_000).unwrap();
        let particles = simulation.particles();
        let speed = particles.velocity[particles.fixed].norm();
        assert!(
            (speed / told - 1.0).abs() < 1e-3,
            "{name}: {speed} instead of {told}"
        );
    }
}

#[test]
fn listed_spheres_in_each_other_are_told_of_and_refused_where_the_run_would_end() {
    let pair = |deep: f64| scene("", list(&[[0.0; 3], [2.0 * R - deep * R, 0.0, 0.0]]));
    for deep in [0.3, 1.0, 1.4] {
        assert_eq!(messages(&pair(deep).problems()), [""; 0]);
        let release = Release::of_scene(&pair(deep)).unwrap();
        assert_eq!(release.fastest.partner, OverlapPartner::Sphere(0));
        DemSimulation::new(&pair(deep))
            .unwrap()
            .advance(10)
            .unwrap();
    }
    let problems = pair(1.6).problems();
    assert_eq!(problems.len(), 1);
    assert!(
        problems[0].message.contains("guards.overlap"),
        "{}",
        problems[0]
    );
    assert!(DemSimulation::new(&pair(1.6)).unwrap().advance(1).is_err());
    let mut wide = pair(1.6);
    wide.dem.guards.overlap = 1.7;
    assert_eq!(messages(&wide.problems()), [""; 0]);
}

/// In a scene of fast impacts a speed tells nothing; overlaps beyond half a radius are named.
#[test]
fn deep_overlaps_are_told_of_in_fast_scenes_too() {
    for (name, tables, place) in walls() {
        for (deep, expected) in [(0.3, false), (0.49, false), (0.51, true), (0.9, true)] {
            let flying = StartSphere {
                velocity: [0.0, 0.0, 100.0],
                ..StartSphere::at([0.0, 0.05, 0.9])
            };
            let start = Start::list(vec![flying, StartSphere::at(place(deep))]);
            let scene = scene(&tables, start);
            let release = Release::of_scene(&scene);
            assert_eq!(release.is_some(), expected, "{name} {deep}");
            if let Some(Release {
                fastest, impact, ..
            }) = release
            {
                assert!(fastest.sphere == 1 && fastest.speed < impact, "{name}");
            }
        }
    }
}

/// Two driven spheres, and one in a wall, keep to their paths whatever they overlap.
#[test]
fn a_driven_sphere_in_a_wall_releases_nothing() {
    let mut scene = scene(ROUND, list(&[[0.0, 0.0, 0.6 * R], [1.2 * R, 0.0, 1.8 * R]]));
    let driven: Vec<phase::scene::Driven> = [0, 1]
        .map(|sphere| toml::from_str(&format!("sphere = {sphere}")).unwrap())
        .into();
    assert!(Release::of_scene(&scene).is_some());
    scene.dem.driven = driven;
    assert_eq!(Release::of_scene(&scene), None);
    // A free one beside them is pushed by the other alone.
    scene.dem.driven.pop();
    assert_eq!(Release::of_scene(&scene).unwrap().fastest.sphere, 1);
}

/// No warning names contacts of a bed that came to rest.
#[test]
fn a_bed_goes_on_from_its_own_state_without_a_word() {
    let mut scene = scene(ROUND, feed([0.0, 0.0, 0.4], 0.05));
    scene.spheres.count = 12;
    scene.time.dt = 2e-4;
    if let Start::Feed { interval, .. } = &mut scene.start {
        *interval = 0.2;
    }
    scene.dem.effects.gravity.as_mut().unwrap().acceleration = 9.81;
    let mut simulation = DemSimulation::new(&scene).unwrap();
    for steps in [9000, 11_000, 20_000] {
        simulation.advance(steps).unwrap();
        let particles = simulation.particles();
        let states = particles.position.iter().zip(&particles.velocity);
        let spheres = states.map(|(at, by)| StartSphere {
            velocity: [by.x, by.y, by.z],
            ..StartSphere::at([at.x, at.y, at.z])
        });
        let mut later = scene.clone();
        later.start = Start::list(spheres.collect());
        later.spheres.count = particles.len();
        assert_eq!(Release::of_scene(&later), None);
    }
}

/// How deep a sphere is in the walls of a scene (m), from the nearest point of each.
fn depth(scene: &Scene, [x, y, z]: [f64; 3]) -> f64 {
    let tank = scene.tank.as_ref().unwrap();
    let across = libm::hypot(x, y);
    let mut gaps = vec![];
    gaps.extend(tank.radius.map(|radius| radius - across));
    gaps.extend(tank.width.map(|width| 0.5 * width - x.abs()));
    gaps.extend(tank.depth.map(|depth| 0.5 * depth - y.abs()));
    let opening = (tank.orifice_radius.map(|it| it - across))
        .or(tank.slit_width.map(|it| 0.5 * it - x.abs()))
        .filter(|_| scene.dem.door.is_none());
    gaps.push(match opening {
        // Beside its edge, a sphere below the floor is in no room at all.
        Some(inside) if z > 0.0 || inside > -z.abs() => libm::hypot(inside.max(0.0), z),
        _ => z,
    });
    let fixed = scene
        .dem
        .geometry
        .as_ref()
        .map(phase::scene::Geometry::spheres);
    for sphere in fixed
        .iter()
        .flat_map(|fixed| fixed.walls.iter().chain(&fixed.door))
    {
        let [dx, dy, dz] = std::array::from_fn(|k| sphere.position[k] - [x, y, z][k]);
        gaps.push((dx * dx + dy * dy + dz * dz).sqrt() - sphere.radius);
    }
    R - gaps.into_iter().fold(f64::INFINITY, f64::min)
}

/// The scene with what the help of a problem says.
fn mended(scene: &Scene, problem: &Problem) -> Scene {
    let help = problem.help.as_deref().unwrap();
    let value = help.split(" = ").nth(1).unwrap().split('`').next().unwrap();
    let mut scene = scene.clone();
    let Start::Feed {
        position, spread, ..
    } = &mut scene.start
    else {
        panic!("{help}")
    };
    match problem.path.as_str() {
        "start.spread" => *spread = value.parse().unwrap(),
        _ => {
            let numbers = value.trim_matches(['[', ']']).split(", ");
            *position = numbers
                .map(|it| it.parse().unwrap())
                .collect::<Vec<_>>()
                .try_into()
                .unwrap();
        }
    }
    scene
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// A feed is refused exactly where the nearest point of a wall is within the sphere, and what
    /// the help says is accepted.
    #[test]
    fn a_feed_is_refused_exactly_where_a_wall_is_near(
        kind in 0..6_usize,
        x in -0.4..0.4_f64, y in -0.25..0.25_f64, z in -0.1..0.3_f64,
        spread in prop_oneof![Just(0.0), 0.0..0.2_f64],
    ) {
        let fixed = "geometry = { kind = 'list', walls = [\
            { position = [0.1, 0.02, 0.1], radius = 0.05 }], door = [\
            { position = [-0.05, 0.0, 0.12], radius = 0.02 }] }";
        let tables = [ROUND, BOX, ORIFICE, SLIT, &format!("{SLIT}\ndoor = {{ opens = 0.1 }}"),
            &format!("{BOX}\n{fixed}")][kind].to_owned();
        let scene = scene(&tables, feed([x, y, z], spread));
        let shifts = (-500..=500).map(|k| spread * f64::from(k) / 500.0);
        let deepest = shifts.map(|shift| depth(&scene, [x + shift, y, z])).fold(-1.0, f64::max);
        prop_assume!(deepest.abs() > 1e-5);
        let problems = scene.problems();
        prop_assert_eq!(deepest > 0.0, !problems.is_empty(), "{} {:?}", deepest, messages(&problems));
        if kind < 5 && !problems.is_empty() {
            let all = problems.iter().fold(scene, |scene, problem| mended(&scene, problem));
            prop_assert_eq!(messages(&all.problems()), [""; 0], "{:?}", messages(&problems));
        } else {
            // A place clear of walls may be in a fixed sphere.
            let mut scene = scene;
            for _ in 0..4 {
                let problems = scene.problems();
                let has_number = |it: &&Problem| it.help.as_deref().unwrap().contains(" = ");
                match problems.iter().find(has_number) {
                    Some(problem) => scene = mended(&scene, problem),
                    None => break,
                }
            }
            prop_assert_eq!(messages(&scene.problems()), [""; 0], "{:?}", messages(&problems));
        }
    }

    /// The warning of a list names the overlap at the nearest point.
    #[test]
    fn a_list_is_told_of_the_nearest_point(
        kind in 0..5_usize,
        x in -0.3..0.3_f64, y in -0.2..0.2_f64, z in -0.05..0.3_f64,
    ) {
        let tables = [ROUND, BOX, ORIFICE, SLIT, &format!("{SLIT}\ndoor = {{ opens = 0.1 }}")]
            [kind].to_owned();
        let mut scene = scene(&tables, list(&[[x, y, z]]));
        scene.dem.effects.gravity = None;
        let deepest = depth(&scene, [x, y, z]);
        prop_assume!(deepest.abs() > 1e-6 && (deepest - R).abs() > 1e-9);
        let problems = scene.problems();
        prop_assert_eq!(deepest > R, !problems.is_empty(), "{} {:?}", deepest, messages(&problems));
        if problems.is_empty() {
            let told = Release::of_scene(&scene).map_or(0.0, |it| it.fastest.depth);
            prop_assert!((told - deepest.max(0.0)).abs() < 1e-9, "{} {}", told, deepest);
        }
    }
}

/// Symptom: a random start put spheres into the fixed ones of [geometry].
#[test]
fn a_random_start_keeps_clear_of_fixed_spheres() {
    let walls = "geometry = { kind = 'list', walls = [\
        { position = [0.0, 0.0, 0.2], radius = 0.1 },\
        { position = [0.17, 0.0, 0.3], radius = 0.05 }], \
        door = [{ position = [0.0, -0.1, 0.4], radius = 0.03 }] }";
    let random = Start::Random {
        x: None,
        y: None,
        z_min: 0.04,
        z_max: 0.5,
        speed: 0.0,
        spin: 0.0,
    };
    let mut scene = scene(&format!("{ROUND}\n{walls}"), random);
    scene.spheres.count = 20;
    assert_eq!(messages(&scene.problems()), [""; 0]);
    let simulation = DemSimulation::new(&scene).unwrap();
    for at in &simulation.particles().position[3..] {
        assert!(depth(&scene, [at.x, at.y, at.z]) <= 1e-12, "{at:?}");
    }
    // And says so if there is none.
    let full = walls.replace("radius = 0.1 }", "radius = 3.0 }");
    let mut full = self::scene(&format!("{ROUND}\n{full}"), scene.start.clone());
    full.spheres.count = 20;
    let problems = full.problems();
    assert_eq!(problems[0].path, "start.z_max", "{:?}", messages(&problems));
}
