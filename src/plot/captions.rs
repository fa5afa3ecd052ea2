//! What names runs that are no points of a sweep: the keys in which their scenes differ.

use super::numbers;
use crate::document::differing_keys;
use crate::scene::{Scene, leaf};
use serde_json::Value;

/// Keys and tables that name no run: what is kept of it, and for how long it went on.
const UNNAMED: [&str; 3] = ["output", "title", "time.duration"];

/// A whole number that may have more digits than a real number holds.
const SEED: &str = "seed";

/// Most letters of a list that is written as it is.
const LONGEST: usize = 40;

/// What names each run, with markup: its values of the keys in which the scenes differ, or the
/// titles where all scenes have different ones. Nothing where they do not differ.
pub(super) fn of(scenes: &[&Scene]) -> Vec<Vec<String>> {
    let mut titles: Vec<&str> = scenes.iter().filter_map(|it| it.title.as_deref()).collect();
    titles.sort_unstable();
    titles.dedup();
    if scenes.len() > 1 && titles.len() == scenes.len() {
        let title = |scene: &&Scene| vec![scene.title.clone().unwrap_or_default()];
        return scenes.iter().map(title).collect();
    }
    differences(scenes, &[])
}

/// The values of each run of the keys in which the scenes differ, with markup, but for those keys
/// that are `told` otherwise.
pub(super) fn differences(scenes: &[&Scene], told: &[&str]) -> Vec<Vec<String>> {
    let mut keys: Vec<String> = Vec::new();
    for other in scenes.iter().skip(1) {
        keys.extend(differing_keys(scenes[0], other));
    }
    let is_unnamed = |key: &String| {
        let in_table = |table: &&str| key == table || key.starts_with(&format!("{table}."));
        UNNAMED.iter().any(in_table) || told.contains(&key.as_str())
    };
    keys.retain(|key| !is_unnamed(key));
    keys.sort();
    keys.dedup();
    // A table that one scene lacks is one key, whatever else differs in it.
    let tables = keys.clone();
    let is_outermost = |key: &String| {
        let is_in = |table: &String| {
            key.strip_prefix(table.as_str())
                .is_some_and(|it| it.starts_with('.'))
        };
        !tables.iter().any(is_in)
    };
    keys.retain(is_outermost);
    let trees = scenes.iter().map(serde_json::to_value);
    let trees: Vec<Value> = trees.map(Result::unwrap_or_default).collect();
    let name = |(scene, tree): (&&Scene, &Value)| {
        let parts = keys.iter().map(|key| part(scene, tree, &trees, key));
        parts.collect()
    };
    scenes.iter().zip(&trees).map(name).collect()
}

/// The value of a key in a tree.
fn at<'a>(tree: &'a Value, key: &str) -> Option<&'a Value> {
    let mut names = key.split('.');
    names.try_fold(tree, |table, name| table.get(name))
}

/// The value of a key of a scene, in words, `trees` being all scenes.
fn part(scene: &Scene, tree: &Value, trees: &[Value], key: &str) -> String {
    match at(tree, key) {
        None | Some(Value::Null) => format!("{} not set", words(key)),
        Some(Value::Object(table)) if table.is_empty() => words(key),
        Some(Value::Object(table)) => {
            let parts = table
                .keys()
                .map(|name| part(scene, tree, trees, &format!("{key}.{name}")));
            format!("{}: {}", words(key), parts.collect::<Vec<_>>().join(", "))
        }
        Some(Value::String(text)) => text.replace('-', " "),
        Some(Value::Number(number)) => {
            let others = trees.iter().filter_map(|tree| at(tree, key)?.as_f64());
            let others: Vec<f64> = others.collect();
            let value = match number.as_u64() {
                Some(whole) if key == SEED => whole.to_string(),
                _ => numbers::among(number.as_f64().unwrap_or(f64::NAN), &others),
            };
            match scene.notation(key) {
                Some(it) => format!("${}$ = {value} {}", it.symbol, it.unit)
                    .trim_end()
                    .to_owned(),
                None => format!("{} = {value}", words(key)),
            }
        }
        Some(Value::Bool(true)) => words(key),
        Some(Value::Bool(false)) => format!("no {}", words(key)),
        Some(other) => match other.to_string() {
            text if text.len() <= LONGEST => format!("{} = {text}", words(key)),
            // Long lists have numbers, in the order in which they come.
            _ => {
                let lists = trees.iter().map(|tree| at(tree, key));
                let mut different: Vec<Option<&Value>> = Vec::new();
                lists.for_each(|list| {
                    if !different.contains(&list) {
                        different.push(list);
                    }
                });
                let place = different.iter().position(|list| *list == Some(other));
                format!("{}: list {}", words(key), place.unwrap_or(0) + 1)
            }
        },
    }
}

fn words(key: &str) -> String {
    leaf(key).replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Gravity, Integrator};
    use crate::scene::{Radii, Shape, Spheres, Start, StartSphere, Time};

    fn falling(acceleration: Option<f64>, density: f64) -> Scene {
        let mut scene = Scene::new(
            Spheres {
                count: 1,
                radius: Radii::One(0.004),
                density,
                shape: Shape::Sphere,
            },
            Start::list(vec![StartSphere::at([0.0, 0.0, 1.0])]),
            Time {
                dt: 1e-4,
                safety_factor: None,
                resolution: None,
                duration: 0.1,
                frame_interval: 1e-2,
                integrator: Integrator::VelocityVerlet,
            },
        );
        let gravity = |acceleration| Gravity {
            acceleration,
            tilt: 0.0,
        };
        scene.dem.effects.gravity = acceleration.map(gravity);
        scene
    }

    #[test]
    fn runs_are_named_by_what_differs() {
        let scenes = [
            falling(Some(9.8), 2500.0),
            falling(None, 2500.0),
            falling(Some(1.6), 3e3),
        ];
        let names = of(&[&scenes[0], &scenes[1], &scenes[2]]);
        assert_eq!(names[0], ["gravity: $g$ = 9.8 m/s²", "$ρ$ = 2500 kg/m³"]);
        assert_eq!(names[1], ["gravity not set", "$ρ$ = 2500 kg/m³"]);
        assert_eq!(names[2], ["gravity: $g$ = 1.6 m/s²", "$ρ$ = 3000 kg/m³"]);
        assert_eq!(of(&[&scenes[0], &scenes[0]]), [[""; 0]; 2]);
    }

    /// Symptom: two records had one name. Cause: four digits, whatever the other values are.
    #[test]
    fn names_have_the_digits_that_tell_values_apart() {
        let scenes = [falling(None, 2500.1), falling(None, 2500.3)];
        let names = of(&[&scenes[0], &scenes[1]]);
        assert_eq!(names, [["$ρ$ = 2500.1 kg/m³"], ["$ρ$ = 2500.3 kg/m³"]]);
    }

    /// Symptom: runs of the seeds 2^53 and 2^53 + 1 had one name. Cause: as real numbers these are
    /// equal.
    #[test]
    fn seeds_have_all_their_digits() {
        let seeds = [1 << 53, (1 << 53) + 1, u64::MAX];
        let scenes = seeds.map(|seed| Scene {
            seed,
            ..falling(None, 2500.0)
        });
        let names = of(&scenes.each_ref());
        let expected = [
            "9007199254740992",
            "9007199254740993",
            "18446744073709551615",
        ];
        assert_eq!(names, expected.map(|seed| [format!("$seed$ = {seed}")]));
        assert_eq!(differences(&scenes.each_ref(), &["seed"]), [[""; 0]; 3]);
    }

    #[test]
    fn long_lists_have_numbers() {
        let lists = [vec![0.004; 20], vec![0.003; 20], vec![0.004; 20]];
        let scenes = lists.map(|radii| {
            let mut scene = falling(None, 2500.0);
            scene.spheres.radius = Radii::Each(radii);
            scene
        });
        let names = of(&scenes.each_ref());
        assert_eq!(
            names,
            [1, 2, 1].map(|list| [format!("radius: list {list}")])
        );
    }

    #[test]
    fn titles_that_differ_are_the_names() {
        let mut scenes = [falling(Some(9.8), 2500.0), falling(None, 2500.0)];
        scenes[0].title = Some("one".to_owned());
        scenes[1].title = Some("other".to_owned());
        assert_eq!(of(&[&scenes[0], &scenes[1]]), [["one"], ["other"]]);
        assert_eq!(of(&[&scenes[0]]), [[""; 0]; 1]);
    }
}
