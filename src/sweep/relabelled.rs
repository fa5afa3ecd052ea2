//! A sweep whose runs are labelled in another way.

use super::Sweep;
use super::load::{SWEEP, SweepFile, check_sieves, problem_of_labels};
use crate::classify::{Rules, Sieves};
use crate::document::{Document, LoadError, Problem};
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;

/// The keys of a sweep file that decide on labels and measures.
const KEYS: [&str; 4] = ["labels", "sieves", "label", "measure"];

impl Sweep {
    /// The same runs, labelled as `text` says, which stands for the file `path` in errors. It has
    /// the keys `labels`, `sieves`, `label` and `measure` of a sweep file. What it does not have
    /// stays as it is, each threshold by itself; labels by rules replace those of before.
    ///
    /// # Errors
    /// All that is wrong with the text, each with line, column and the fix.
    pub fn relabelled(&self, text: &str, path: &Path) -> Result<Self, LoadError> {
        let document = Document::parse(text.to_owned(), path)?;
        let mut problems = other_keys(&document);
        let mut tree = document.tree().clone();
        // A sweep file has a scene; which one does not matter here.
        tree["scene"] = Value::from("");
        SWEEP.kind.check(&tree, "", &mut problems);
        document.accept(&problems)?;
        let mut sieves = serde_json::to_value(Sieves {
            rules: Rules::default(),
            ..self.sieves.clone()
        })
        .expect("thresholds are numbers");
        put_over(&mut sieves, &document.tree()["sieves"]);
        tree["sieves"] = sieves;
        let file = SweepFile::deserialize(&tree).map_err(|error| {
            document.refuse(&[Problem::new("", format!("not a sweep: {error}"))])
        })?;
        let mut rules = self.own_rules();
        if document.holds("label") {
            rules.sieves = file.label.is_empty();
            rules.labels = file.label;
        }
        if document.holds("measure") {
            rules.measures = file.measure;
        }
        rules.sieves |= file.labels.is_some();
        let sweep = Self {
            sieves: Sieves {
                rules,
                ..file.sieves
            },
            ..self.clone()
        };
        problems.extend(problem_of_labels(file.labels.as_deref(), &sweep.scene));
        check_sieves(&sweep, document.tree(), &mut problems);
        document.accept(&problems)?;
        Ok(sweep)
    }

    /// The rules that label its runs: those of its scene's file where it has none itself.
    fn own_rules(&self) -> Rules {
        let rules = &self.sieves.rules;
        match rules.is_empty() && !rules.sieves {
            true => Rules::of(&self.scene),
            false => rules.clone(),
        }
    }
}

/// Keys that do not decide on labels.
fn other_keys(document: &Document) -> Vec<Problem> {
    let keys = document.entries().into_iter().map(|(key, _)| key);
    let others = keys.filter(|key| !KEYS.contains(&key.as_str()));
    let problem = |key: String| {
        let message = format!("`{key}` does not decide on labels");
        let help = "give `sieves`, `label`, `measure` or `labels`";
        Problem::new(key, message).help(help).at_key()
    };
    others.map(problem).collect()
}

/// Replaces the values of a tree that another one has too.
fn put_over(tree: &mut Value, other: &Value) {
    match (tree, other) {
        (Value::Object(tree), Value::Object(other)) => {
            for (key, value) in other {
                put_over(tree.entry(key).or_insert(Value::Null), value);
            }
        }
        (_, Value::Null) => {}
        (tree, other) => *tree = other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tank() -> Sweep {
        crate::sweep::load(Path::new("sweeps/theoretical-9x9.toml")).unwrap()
    }

    fn relabelled(text: &str) -> Result<Sweep, String> {
        let sweep = tank().relabelled(text, Path::new("labels.toml"));
        sweep.map_err(|error| error.to_string())
    }

    #[test]
    fn a_threshold_alone_changes() {
        let wider = relabelled("sieves.pinned.hole = 1.5").unwrap();
        let mut expected = tank();
        expected.sieves.pinned.hole = 1.5;
        assert_eq!(wider, expected);
        let both = wider.relabelled("sieves.fluid = {}", Path::new("labels.toml"));
        assert_eq!(both.unwrap(), expected);
        assert!(tank().keys_of_other_runs(&wider).is_empty());
    }

    #[test]
    fn rules_replace_sieves_and_go_again() {
        let text = "label = [{ name = \"high\", when = \"last(height_max) > 0.1[m]\" }]";
        let ruled = relabelled(text).unwrap();
        assert!(ruled.family().has_rules_alone());
        assert!(ruled.family().label("high").is_some());
        let back = ruled
            .relabelled("label = []", Path::new("labels.toml"))
            .unwrap();
        assert_eq!(back.family(), tank().family());
    }

    #[test]
    fn what_is_wrong_has_its_place() {
        for (text, expected) in [
            ("sieves.pinned.whole = 1.5", "did you mean `hole`"),
            ("sieves.arching.window = 1.0", "is not a sieve of a tank"),
            ("title = \"other\"", "`title` does not decide on labels"),
            ("labels = \"silo\"", "the scene is a tank, and no silo"),
            ("sieves.pinned.hole = -1.0", "sieves.pinned.hole"),
        ] {
            let error = relabelled(text).unwrap_err();
            assert!(error.contains(expected), "{error}");
            assert!(error.contains("labels.toml:1:"), "{error}");
        }
    }
}
