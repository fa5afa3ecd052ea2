//! The numeric keys of a scene by their paths, so that a sweep can vary any of them.

use super::settings::TIMES_OF_SHAKING;
use super::{LIST_KEY, SCENE, Scene};
use crate::document::kind::{KeyTable, NumberRange, TableKey, ValueKind};
use crate::document::{Problem, any_of, lasting, one_of, suggest};
use serde_json::Value;
use std::borrow::Cow;

/// The key that only a scene with `dt = "auto"` has.
const SAFETY_FACTOR_KEY: &str = "time.safety_factor";

/// Constraint on entries of a vector.
static COMPONENT: ValueKind = ValueKind::Number(NumberRange::ANY);

/// The table of what other programs are given.
const PARAMETERS: &str = "parameters";

/// Whether the key at `path` of a scene may hold a number, for any values of the other keys.
pub(crate) fn may_hold(path: &str, number: f64) -> bool {
    let mut problems = Vec::new();
    SCENE.kind.visit("", &mut |own, key| {
        if own == path {
            key.kind.check(&Value::from(number), path, &mut problems);
        }
    });
    problems.is_empty()
}

/// A key that a sweep may vary.
pub(super) struct NumericKey {
    pub(super) path: String,
    /// What it may hold.
    pub(super) kind: &'static ValueKind,
    /// How figures write it, in this scene.
    notation: Option<Notation>,
}

/// How figures write a numeric key of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Notation {
    /// Symbol; `_` makes a subscript of the next character or of a group in braces.
    pub symbol: &'static str,
    /// Unit: SI, or in units of the spheres if the scene uses these; empty for a pure number.
    pub unit: &'static str,
    /// Plain name, without the unit.
    pub name: &'static str,
}

impl Scene {
    /// Paths of the keys that a sweep may vary: the numeric keys in the tables that this scene has,
    /// set or default. Left out are `seed`, which has its own table in a sweep, the keys of
    /// `output`, which do not change the motion, and entries of lists, although these may be varied
    /// too (`spheres.radius[1].share`).
    pub fn numeric_keys(&self) -> Vec<String> {
        let keys = self.for_keys(&[]).all_numeric_keys().into_iter();
        keys.map(|key| key.path)
            .filter(|path| !path.contains('['))
            .collect()
    }

    /// How figures write a numeric key, with its unit in this scene. Entries of lists have no
    /// notation.
    pub fn notation(&self, key: &str) -> Option<Notation> {
        if let Some(name) = key.strip_prefix(PARAMETERS) {
            return self.notation_of_parameter(name.strip_prefix('.')?);
        }
        let mut keys = self.for_keys(&[]).all_numeric_keys().into_iter();
        let own = keys.find(|known| known.path == key);
        let notation = own.map_or_else(|| Notation::anywhere(key), |known| known.notation)?;
        Some(Notation {
            unit: self.units().shown(notation.unit),
            ..notation
        })
    }

    /// How figures write what another program is given: by its name in the file.
    fn notation_of_parameter(&self, name: &str) -> Option<Notation> {
        let (name, _) = self.parameters.get_key_value(name)?;
        let unit = self.program.as_ref().and_then(|it| it.units.get(name));
        let unit = unit.filter(|unit| *unit != "1");
        Some(Notation {
            symbol: lasting(name),
            unit: unit.map_or("", |unit| lasting(unit)),
            name: lasting(name),
        })
    }

    /// The value of a numeric key, if the scene sets it.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        let place = key.replace(['.', '['], "/").replace(']', "");
        let tree = self.for_keys(&[key]).tree();
        tree.pointer(&format!("/{place}"))?.as_f64()
    }

    pub(super) fn all_numeric_keys(&self) -> Vec<NumericKey> {
        let mut keys = Vec::new();
        collect(&SCENE.kind, None, Some(&self.tree()), "", &mut keys);
        keys.retain(|key| key.path != "seed" && !is_without_effect(&key.path));
        if self.is_external() {
            keys.retain(|key| key.path.starts_with(PARAMETERS));
        }
        if self.time.safety_factor.is_none() {
            keys.retain(|key| key.path != SAFETY_FACTOR_KEY);
        }
        if let Some(shaking) = &self.dem.effects.shaking {
            let replaced = TIMES_OF_SHAKING.map(|(_, of_time)| format!("time.{of_time}"));
            let given = [shaking.frames_per_period, shaking.periods].map(|it| it.is_some());
            for (path, _) in replaced.iter().zip(given).filter(|(_, given)| *given) {
                keys.retain(|key| key.path != *path);
            }
        }
        keys
    }

    /// The full path of a numeric key: `key` itself, or the one path that ends in it. A path that
    /// the scene sets takes precedence over default ones.
    pub(crate) fn resolve_key(&self, key: &str) -> Result<String, Problem> {
        let keys = self.for_keys(&[key]).all_numeric_keys();
        if keys.iter().any(|known| known.path == key) {
            return Ok(key.to_owned());
        }
        let paths = self.numeric_keys();
        let ending = format!(".{key}");
        let mut matches: Vec<&String> = paths
            .iter()
            .filter(|path| path.ends_with(&ending))
            .collect();
        let tree = self.for_keys(&[]).tree();
        let is_set = |path: &&String| {
            let place = format!("/{}", path.replace('.', "/"));
            tree.pointer(&place).is_some()
        };
        if matches.iter().any(is_set) {
            matches.retain(is_set);
        }
        match matches.as_slice() {
            [path] => Ok((*path).clone()),
            [] => Err(self.unknown_key(key, &paths)),
            several => Err(
                Problem::new("", format!("`{key}` could be {}", any_of(several)))
                    .help("write the full path"),
            ),
        }
    }

    fn unknown_key(&self, key: &str, paths: &[String]) -> Problem {
        if key == "seed" {
            return Problem::new("", "seeds are not an axis").help("list them in [seeds]");
        }
        if is_without_effect(key) {
            return Problem::new("", format!("`{key}` changes nothing in the motion"))
                .help("set it in the scene; every job then has it");
        }
        if [SAFETY_FACTOR_KEY, leaf(SAFETY_FACTOR_KEY)].contains(&key) {
            return Problem::new("", format!("`{key}` goes with `dt = \"auto\"` only"))
                .help("use `dt = \"auto\"` in [time] of the scene, or vary `time.dt`");
        }
        let table = key.split('.').next().unwrap_or(key);
        if let ValueKind::Table(scene) = &SCENE.kind
            && table != key
            && !self.is_external()
            && scene.keys.iter().any(|known| known.name == table)
            && self.for_keys(&[]).tree().get(table).is_none()
        {
            return Problem::new("", format!("the scene has no [{table}] to vary `{key}` in"))
                .help(format!("add [{table}] to the scene"));
        }
        let parameter = key.strip_prefix(PARAMETERS);
        let parameter = parameter.and_then(|it| it.strip_prefix('.')).unwrap_or(key);
        if let Some(value) = self.parameters.get(parameter) {
            let message = format!("`{key}` is {value}, not a number");
            return Problem::new("", message)
                .help("write a number without quotes, or use variants");
        }
        let leaves = paths.iter().map(|path| leaf(path));
        let near = suggest(key, paths.iter().map(String::as_str).chain(leaves));
        let known = format!("this scene has {}", one_of(paths));
        Problem::new("", format!("`{key}` is not a numeric key of the scene")).help(match near {
            Some(near) => format!("did you mean `{near}`? {known}"),
            None => known,
        })
    }

    /// The scene, without the spheres that its start lists unless a key belongs to one of them. In
    /// a tree of values a sphere takes more than a kilobyte.
    pub(super) fn for_keys(&self, keys: &[&str]) -> Cow<'_, Self> {
        match self.apart_from_list() {
            Some((scene, _)) if !keys.iter().any(|key| key.starts_with(LIST_KEY)) => {
                Cow::Owned(scene)
            }
            _ => Cow::Borrowed(self),
        }
    }
}

/// The last part of a path, without index: `radius` of `spheres.radius`.
pub(crate) fn leaf(path: &str) -> &str {
    let last = path.rsplit('.').next().unwrap_or(path);
    last.split('[').next().unwrap_or(last)
}

/// Whether a key has no effect on the motion.
fn is_without_effect(key: &str) -> bool {
    key.starts_with("output.") || key.starts_with("neighbours.")
}

fn collect(
    kind: &'static ValueKind,
    notation: Option<Notation>,
    value: Option<&Value>,
    path: &str,
    keys: &mut Vec<NumericKey>,
) {
    let mut push = |path: String, kind: &'static ValueKind, notation: Option<Notation>| {
        keys.push(NumericKey {
            path,
            kind,
            notation,
        });
    };
    match kind {
        ValueKind::Number(_) | ValueKind::Whole(_) => push(path.to_owned(), kind, notation),
        ValueKind::Either(kinds) => {
            if kinds
                .iter()
                .any(|kind| matches!(kind, ValueKind::Number(_)))
            {
                push(path.to_owned(), kind, notation);
            }
            let lists = kinds
                .iter()
                .filter(|kind| matches!(kind, ValueKind::List(_)));
            for kind in lists.filter(|kind| value.is_some_and(|value| kind.fits_type_of(value))) {
                collect(kind, None, value, path, keys);
            }
        }
        ValueKind::Table(table) => collect_table(table, value, path, keys),
        ValueKind::Tagged(tag, variants) => {
            let word = value.and_then(|value| value.get(tag)?.as_str());
            if let Some(variant) = variants.iter().find(|it| Some(it.word.as_str()) == word) {
                collect_table(&variant.table, value, path, keys);
            }
        }
        ValueKind::List(entry) => {
            for (index, value) in entries(value) {
                collect(entry, None, Some(value), &format!("{path}[{index}]"), keys);
            }
        }
        ValueKind::Vector => {
            for (index, _) in entries(value) {
                push(format!("{path}[{index}]"), &COMPONENT, None);
            }
        }
        ValueKind::AnyTable if path == PARAMETERS => {
            let parameters = value.and_then(Value::as_object).into_iter().flatten();
            for (name, _) in parameters.filter(|(_, value)| value.is_number()) {
                push(format!("{path}.{name}"), &COMPONENT, None);
            }
        }
        ValueKind::Text
        | ValueKind::Flag
        | ValueKind::Choice(_)
        | ValueKind::Any
        | ValueKind::AnyTable => {}
    }
}

fn collect_table(
    table: &'static KeyTable,
    value: Option<&Value>,
    path: &str,
    keys: &mut Vec<NumericKey>,
) {
    // Setting a key in an absent table would add an effect.
    let Some(value) = value else { return };
    for key in &table.keys {
        let path = key.path(path);
        let notation = Notation::of(key, value).filter(|_| !path.contains('['));
        collect(&key.kind, notation, value.get(&key.name), &path, keys);
    }
}

impl Notation {
    /// The notation of a key in any scene that has it.
    pub(crate) fn anywhere(path: &str) -> Option<Self> {
        let mut found = None;
        SCENE.kind.visit("", &mut |known, key| {
            if known == path && found.is_none() {
                found = Self::of(key, &Value::Null);
            }
        });
        found
    }

    /// The notation of a key in a table with these values.
    fn of(key: &'static TableKey, table: &Value) -> Option<Self> {
        let quantity = key.quantity.as_ref()?;
        (!quantity.symbol.is_empty()).then(|| Self {
            symbol: &quantity.symbol,
            unit: quantity.unit_in(table),
            name: &quantity.name,
        })
    }
}

fn entries(value: Option<&Value>) -> impl Iterator<Item = (usize, &Value)> {
    value
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .enumerate()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::path::Path;

    /// Spheres of two radii in a tank.
    pub(in crate::scene) fn scene() -> Scene {
        let text = r#"
            spheres.count = 3
            spheres.radius = [{ radius = 0.004, share = 1 }, { radius = 0.005, share = 2 }]
            spheres.density = 1e3
            tank = { radius = 0.06 }
            start = { kind = "random", z_min = 0.0, z_max = 0.3 }
            time = { dt = 1e-4, duration = 1.0, frame_interval = 1e-3 }
        "#;
        crate::scene::Scene::from_toml(text, Path::new("scene.toml")).unwrap()
    }

    #[test]
    fn keys_are_found_by_their_last_part() {
        let scene = scene();
        assert_eq!(scene.resolve_key("dt").unwrap(), "time.dt");
        assert_eq!(scene.resolve_key("time.dt").unwrap(), "time.dt");
        assert_eq!(scene.resolve_key("vertical").unwrap(), "guards.vertical");
        for key in [
            "radius",
            "seed",
            "output.profile_bins",
            "omega",
            "swirl.omega",
            "law",
        ] {
            assert!(scene.resolve_key(key).is_err(), "{key}");
        }
    }

    /// Symptom: a sweep over `density` was ambiguous in a scene with [drag]. Cause: the law has a
    /// key for the density of the fluid, which this scene does not set.
    #[test]
    fn a_key_that_is_set_comes_before_one_that_is_not() {
        let mut scene = scene();
        let drag = r#"{ "law": "constant", "linear": 1e-6 }"#;
        scene.dem.effects.drag = Some(serde_json::from_str(drag).unwrap());
        assert_eq!(scene.resolve_key("density").unwrap(), "spheres.density");
        assert_eq!(scene.resolve_key("viscosity").unwrap(), "drag.viscosity");
        scene.dem.effects.drag.as_mut().unwrap().density = Some(1.2);
        assert!(scene.resolve_key("density").is_err());
    }

    #[test]
    fn the_unit_of_a_key_depends_on_its_table() {
        let mut scene = scene();
        let unit = |scene: &Scene, key: &str| scene.notation(key).unwrap().unit;
        assert_eq!(unit(&scene, "spheres.density"), "kg/m³");
        scene.spheres.shape = crate::scene::Shape::Disc;
        assert_eq!(unit(&scene, "spheres.density"), "kg/m²");
        scene.dem.contact = Some(crate::scene::Contact::Silbert(crate::scene::Silbert {
            stiffness: 1e6,
            damping: 1.0,
        }));
        assert_eq!(unit(&scene, "contact.stiffness"), "Pa");
        assert_eq!(scene.notation("spheres.radius[0].share"), None);
    }
}
