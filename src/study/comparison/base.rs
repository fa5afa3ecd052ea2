//! What a comparison starts from: a scene, or a sweep over one, whose keys settings change.

use super::Setting;
use crate::classify::Family;
use crate::document::{Document, LoadError, Problem, number};
use crate::grid::{PointScenes, SceneTree, Variant, check_change, give_the_step_to_an_axis};
use crate::run::{self, Reading};
use crate::scene::{Change, FileKind, Friction, Scene, is_within};
use crate::sweep::{self, Sweep};
use serde_json::{Value, json};

/// A scene or a sweep, and its scene as the file has it.
#[derive(Clone, Debug)]
pub(crate) struct Base {
    /// The sweep; of a scene that of its own seed alone.
    pub(crate) sweep: Sweep,
    source: SceneTree,
}

impl Base {
    /// What the key `scene` of a study says: the path of a scene or sweep, or a scene itself.
    pub(crate) fn of_entry(entry: &Value, document: &Document) -> Result<Self, LoadError> {
        let Some(path) = entry.as_str() else {
            let source = SceneTree::within(entry, document.folder());
            // The entry is as the file has it, without the keys that follow from others.
            let scene = source.scene().map_err(|problems| {
                let placed = problems.into_iter().map(|it| it.within("scene"));
                document.refuse(&placed.collect::<Vec<_>>())
            })?;
            return Ok(Self {
                sweep: Sweep::of_scene(scene),
                source,
            });
        };
        let file = Document::read(&document.folder().join(path));
        match file.and_then(|file| Self::of_document(&file)) {
            Err(error @ LoadError::Read { .. }) => {
                let help = "the path is relative to the folder of this file";
                Err(document.refuse(&[Problem::new("scene", error.to_string()).help(help)]))
            }
            other => other,
        }
    }

    /// The base that a file of a scene or a sweep describes.
    ///
    /// # Errors
    /// All that is wrong with the file, each with line, column and the fix.
    pub(crate) fn of_document(document: &Document) -> Result<Self, LoadError> {
        if FileKind::of(document).0 != FileKind::Sweep {
            // Also what is neither, which is refused with all that is wrong with it.
            return Ok(Self {
                sweep: Sweep::of_scene(run::base_of_document(document, Reading::RUN)?),
                source: SceneTree::of_document(document),
            });
        }
        if document.tree().get("variant").is_some() {
            let message = "the sweep has variants, and a study compares its own";
            let help = "name a sweep without them, or leave the key out";
            return Err(document.refuse(&[Problem::new("variant", message).help(help)]));
        }
        // The whole grid is compared.
        let sweep = Sweep {
            refine: None,
            ..sweep::of_document(document)?
        };
        let source = SceneTree::of_entry(document)?;
        Ok(Self { sweep, source })
    }

    /// The base with a change, from which settings then start.
    ///
    /// # Errors
    /// What is wrong with it, by paths of the scene.
    pub(crate) fn changed(&self, change: &Change) -> Result<Self, Vec<Problem>> {
        check_change(change, &self.sweep.axes)?;
        let source = self.source.changed(change)?;
        let mut sweep = self.sweep.clone();
        sweep.scene = source.scene()?;
        give_the_step_to_an_axis(&mut sweep.scene, &sweep.axes);
        for (name, factor) in &change.scale {
            for axis in sweep.axes.iter_mut().filter(|axis| axis.name == *name) {
                axis.values.iter_mut().for_each(|value| *value *= factor);
            }
        }
        Ok(Self { sweep, source })
    }

    /// Tables and keys that a change leaves out although they are not there.
    pub(crate) fn not_there<'a>(&self, change: &'a Change) -> Vec<&'a str> {
        self.source.not_there(change)
    }

    /// The setting that makes a change, and the variant that it is.
    ///
    /// # Errors
    /// What is wrong with it, by paths of the scene.
    pub(crate) fn setting(
        &self,
        name: String,
        change: Change,
    ) -> Result<(Setting, Variant), Vec<Problem>> {
        let held = self.hold_impulse(&change);
        let whole = held.as_ref().map(|held| change.then(held));
        let mut sweep = self.changed(whole.as_ref().unwrap_or(&change))?.sweep;
        self.check(&sweep, held.is_some())?;
        // Rows need none of these.
        sweep.scene.output.snapshot_interval = 0.0;
        sweep.scene.output.trajectory = false;
        let note = held.and_then(|held| {
            let coefficient = held.value("friction.coefficient")?.as_f64()?;
            Some(format!(
                "mu/dt of \"spin\" friction is held: friction.coefficient = {}",
                number(coefficient)
            ))
        });
        let variant = Variant {
            name: name.clone(),
            scale: change.scale.clone(),
            scene: sweep.scene,
        };
        let setting = Setting {
            method: name.clone(),
            name,
            rung: None,
            change,
            note,
        };
        Ok((setting, variant))
    }

    /// What holds mu/dt of "spin" friction where a change gives another time step: the law is an
    /// impulse mu per step, so that the step alone would change the friction.
    fn hold_impulse(&self, change: &Change) -> Option<Change> {
        let coefficient = spin_coefficient(&self.sweep.scene)?;
        let is_changed = |key: &str| change.value(key).is_some();
        if is_changed("friction.law") || is_changed("friction.coefficient") {
            return None;
        }
        let is_removed = change.remove.iter().any(|it| is_within("friction", it));
        let is_axis = self.varies("friction.coefficient");
        let dt = change.value("time.dt")?.as_f64()?;
        let before = self.source.number("time", "dt")?;
        // The same step changes nothing, and must not change the last bit of the coefficient.
        let held = coefficient * dt / before;
        (!is_removed && !is_axis && dt != before && held != coefficient)
            .then(|| Change::of_key("friction.coefficient", json!(held)))
    }

    /// Whether an axis varies a key.
    fn varies(&self, key: &str) -> bool {
        self.sweep.axes.iter().any(|axis| axis.key == key)
    }

    /// Whether the sweep of a setting can be run and compared.
    fn check(&self, sweep: &Sweep, is_held: bool) -> Result<(), Vec<Problem>> {
        let refuse = |problem| Err(vec![problem]);
        let (before, after) = (&self.sweep.scene, &sweep.scene);
        let both_spin = spin_coefficient(before).zip(spin_coefficient(after));
        let is_same_step = before.time.dt == after.time.dt;
        let becomes_spin = both_spin.is_none() && spin_coefficient(after).is_some();
        if becomes_spin && !is_same_step {
            let message = "\"spin\" friction is an impulse mu per step, and both the law and the \
                           step are new, so it is not known which friction is meant";
            let help = "give the scene \"spin\" friction by [base], or change one at a time";
            return refuse(Problem::new("friction.law", message).help(help));
        }
        if let Some((old, new)) = both_spin {
            if !is_same_step && self.varies("friction.coefficient") {
                let message = "\"spin\" friction is an impulse mu per step, and an axis varies mu, \
                               so another step is another friction";
                let help = "leave the step as it is, or use a friction law without the step";
                return refuse(Problem::new("time.dt", message).help(help));
            }
            if !is_same_step && !is_held && old == new {
                let message = "\"spin\" friction is an impulse mu per step, so another step is \
                               another friction";
                let help = "give `time.dt` as a number in the scene and in the study, and mu/dt is \
                            held; or set `friction.coefficient` with it";
                return refuse(Problem::new("time.dt", message).help(help));
            }
        }
        let (of_base, own) = (Family::of(before), Family::of(after));
        if of_base != own {
            let message = format!(
                "with it the scene is a {}, and no label of it can be compared with those of a {}",
                own.name, of_base.name
            );
            return refuse(Problem::new("", message).help("do not change what makes it one"));
        }
        if let Err(error) = sweep.sieves.check(after) {
            return refuse(Problem::new("", error.to_string()));
        }
        let scenes = PointScenes::new(&sweep.scene, &sweep.axes).map_err(|error| error.problems)?;
        for values in sweep.grid() {
            scenes.checked(&values).map_err(|error| {
                let at = error.point;
                let mut problems = error.problems;
                for problem in problems.iter_mut().filter(|_| !at.is_empty()) {
                    problem.message = format!("at {at}: {}", problem.message);
                }
                problems
            })?;
        }
        Ok(())
    }
}

/// The coefficient of "spin" friction, if that is the law.
fn spin_coefficient(scene: &Scene) -> Option<f64> {
    match &scene.dem.friction {
        Some(Friction::Spin(spin)) => Some(spin.coefficient),
        _ => None,
    }
}
