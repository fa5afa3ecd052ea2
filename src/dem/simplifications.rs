//! What a scene may do without, or replace by something simpler.

use crate::forces::effects::SceneFacts;
use crate::forces::simplification::MeanSphere;
pub use crate::forces::simplification::Simplification;
use crate::scene::{Contact, Scene, SceneWall};
use serde_json::json;

/// The simplifications of a scene's effects and laws, one part at a time, whose
/// [`Scene::simplified`] can be run.
pub fn simplifications(scene: &Scene) -> Vec<Simplification> {
    let (spheres, effects) = (&scene.spheres, &scene.dem.effects);
    let radius = scene.mean_radius();
    let mean = MeanSphere {
        radius,
        mass: spheres.shape.mass(spheres.density, radius),
        density: spheres.density,
    };
    let facts = scene.facts();
    let mut all = effects.simplifications(&facts, &mean);
    if let (Some(contact), Some(friction)) = (&scene.dem.contact, &scene.dem.friction) {
        let rolling = scene.dem.rolling.iter().map(|_| "rolling");
        all.extend(rolling.clone().map(|table| Simplification {
            name: "rolling resistance off".to_owned(),
            set: Vec::new(),
            remove: vec![table],
        }));
        let mut removed = vec!["friction"];
        removed.extend(rolling);
        let walls = scene.tank.iter();
        let of_walls = walls.filter_map(|tank| tank.friction_coefficient);
        removed.extend(of_walls.map(|_| "tank.friction_coefficient"));
        // Without friction there are no spins, nor effects that need them.
        let without_spins = SceneFacts {
            rotates: false,
            ..facts
        };
        removed.extend(effects.removed_with(None, &without_spins));
        let walls = scene.dem.walls.iter();
        let walls: Vec<SceneWall> = walls.map(SceneWall::without_friction).collect();
        for mut simpler in friction.simplifications(contact, removed) {
            if simpler.remove.contains(&"friction") && walls != scene.dem.walls {
                simpler.set.push(("wall", json!(walls)));
            }
            all.push(simpler);
        }
    }
    let contact = scene.dem.contact.iter();
    all.extend(contact.flat_map(Contact::simplifications));
    let mut several: Vec<Simplification> = Vec::new();
    for one in all {
        let is_new = |it: &Simplification| (&it.set, &it.remove) != (&one.set, &one.remove);
        if several.iter().all(is_new) && can_be_run(scene, &one) {
            several.push(one);
        }
    }
    several
}

fn can_be_run(scene: &Scene, change: &Simplification) -> bool {
    let simplified = scene.simplified(change);
    simplified.is_ok_and(|scene| scene.with_chosen_step().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn names(scene: &Scene) -> Vec<String> {
        let all = simplifications(scene).into_iter();
        all.map(|it| it.name).collect()
    }

    #[test]
    fn every_simplification_of_a_shipped_scene_can_be_run() {
        let mut seen = 0;
        for entry in std::fs::read_dir("sweeps/scenes").unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
            let all = simplifications(&scene);
            for one in &all {
                let simplified = scene.simplified(one).unwrap();
                let problems = simplified.problems();
                assert!(problems.is_empty(), "{path:?}: {}: {problems:?}", one.name);
                assert_ne!(simplified, scene, "{path:?}: {}", one.name);
                assert_ne!(simplified.identity(), scene.identity());
                seen += 1;
            }
            for (at, one) in all.iter().enumerate() {
                let is_other = |it: &Simplification| it.name != one.name;
                assert!(all[at + 1..].iter().all(is_other), "{}", one.name);
            }
        }
        assert!(seen > 40, "{seen}");
    }

    #[test]
    fn the_vortex_tank_has_these() {
        let scene = Scene::load(Path::new("tests/good/everything.toml")).unwrap();
        let expected = [
            "gravity off",
            "buoyancy off",
            "shaking off",
            "added mass off",
            "quadratic drag to linear",
            "vector drag to component",
            "drag off",
            "swirl off",
            "counting shield to none",
            "updraught off",
            "magnus off",
            "spin damping off",
            "rolling resistance off",
            "coulomb friction to none",
            "restitution to elastic",
        ];
        assert_eq!(names(&scene), expected);
    }

    /// What cannot do without another goes with it.
    #[test]
    fn nothing_is_left_dangling() {
        let scene = Scene::load(Path::new("tests/good/everything.toml")).unwrap();
        let all = simplifications(&scene);
        let removed = |name: &str| {
            let one = all.iter().find(|it| it.name == name).unwrap();
            one.remove.clone()
        };
        assert_eq!(removed("gravity off"), ["buoyancy", "gravity"]);
        assert_eq!(removed("drag off"), ["drag", "swirl", "updraught"]);
        let friction = removed("coulomb friction to none");
        assert_eq!(friction, ["friction", "rolling", "magnus", "spin_damping"]);
        assert_eq!(removed("swirl off"), ["swirl", "updraught.reference_omega"]);
        let swirl_off = all.iter().find(|it| it.name == "swirl off").unwrap();
        let still = scene.simplified(swirl_off).unwrap();
        let strength = |scene: &Scene| {
            let effects = &scene.dem.effects;
            let updraught = effects.updraught.as_ref().unwrap();
            updraught.strength_in(effects.swirl.as_ref())
        };
        assert_eq!(strength(&still), strength(&scene));
    }

    #[test]
    fn simpler_drags_pull_as_those_they_stand_for() {
        let text = |drag: &str| {
            format!(
                "spheres = {{ count = 1, radius = 0.001, density = 2500.0 }}
                gravity = {{ acceleration = 9.81 }}
                buoyancy = {{ density = 1000.0 }}
                drag = {{ {drag} }}
                swirl = {{ omega = 0.0 }}
                start = {{ kind = 'list', spheres = [{{ position = [0, 0, 0] }}] }}
                time = {{ dt = 1e-5, duration = 1.0, frame_interval = 1e-2 }}"
            )
        };
        let scene = |drag: &str| {
            let read = Scene::from_toml(&text(drag), Path::new("scene.toml"));
            read.unwrap_or_else(|error| panic!("{error}"))
        };
        let coefficient = |scene: &Scene, speed: f64| {
            let drag = scene.dem.effects.drag.as_ref().unwrap();
            drag.coefficient(0.001, speed)
        };
        let simplified = |scene: &Scene, name: &str| {
            let all = simplifications(scene);
            let one = all.iter().find(|it| it.name.starts_with(name));
            let one = one.unwrap_or_else(|| panic!("{name}: {:?}", names(scene)));
            scene.simplified(one).unwrap()
        };
        let weight = 1500.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9 * 9.81;
        for law in ["cross-section", "diameter"] {
            let quadratic = scene(&format!("law = '{law}', linear = 1e-3, quadratic = 300.0"));
            let linear = simplified(&quadratic, "quadratic drag to linear");
            let terminal = weight / coefficient(&linear, 0.0);
            let force = coefficient(&quadratic, terminal) * terminal;
            assert!((force / weight - 1.0).abs() < 1e-9, "{law}: {force}");
        }
        let naumann = scene("law = 'schiller-naumann', viscosity = 1e-3, density = 1000.0");
        let stokes = simplified(&naumann, "Schiller-Naumann drag to linear");
        let slow = coefficient(&naumann, 1e-12);
        assert!((coefficient(&stokes, 1.0) / slow - 1.0).abs() < 1e-6);
        let newton = simplified(&naumann, "Schiller-Naumann drag to quadratic");
        let fast = coefficient(&naumann, 5.0);
        assert!((coefficient(&newton, 5.0) / fast - 1.0).abs() < 1e-12);
    }
}
