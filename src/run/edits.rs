//! Changes of a scene file from a command line.

use crate::document::Problem;
use crate::scene::is_within;

/// Changes of a scene file from a command line.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edits<'a> {
    /// Settings such as `spot.walk.bias=3`; a value that is not TOML is a text.
    pub set: &'a [String],
    /// Paths of tables or keys that are left out, such as `spot.weighting`.
    pub remove: &'a [String],
    /// Other options, each with the key that it sets once the scene is loaded. The edits above must
    /// not touch these keys.
    pub options: &'a [(&'a str, &'a str)],
}

impl Edits<'_> {
    /// Edits that contradict each other; `paths` are the keys that `set` sets.
    pub(super) fn contradictions(&self, paths: &[String]) -> Vec<Problem> {
        let touches = |one: &str, other: &str| is_within(one, other) || is_within(other, one);
        let mut found = Vec::new();
        for (place, path) in paths.iter().enumerate() {
            let mut others = paths
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != place);
            let is_later = paths[..place].contains(path);
            if is_later || others.any(|(_, other)| other != path && is_within(path, other)) {
                found.push(format!("--set {path}: this key is set twice; set it once"));
            }
        }
        for removed in self.remove {
            let set = paths.iter().filter(|path| touches(path, removed));
            found.extend(set.map(|path| {
                format!("--set {path} and --without {removed} contradict each other; leave one out")
            }));
        }
        for (option, key) in self.options {
            let set = paths.iter().filter(|path| touches(path, key));
            let set = set.map(|path| format!("--set {path}"));
            let removed = self.remove.iter().filter(|path| touches(path, key));
            let removed = removed.map(|path| format!("--without {path}"));
            found.extend(
                set.chain(removed).map(|edit| {
                    format!("{option} and {edit} both decide on `{key}`; leave one out")
                }),
            );
        }
        found
            .into_iter()
            .map(|message| Problem::new("", message))
            .collect()
    }
}
