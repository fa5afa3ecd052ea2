//! A noun names one type: few names of types are used more than once in `src`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// How many names may be used more than once. Lower it when fewer are.
const MOST: usize = 27;

/// Types of which each command has its own.
const OF_COMMANDS: [&str; 2] = ["Answer", "Arguments"];

#[test]
fn few_names_of_types_are_used_twice() {
    let mut places: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    let files = crate::rooms::files(Path::new("src")).into_iter();
    for file in files.filter(|file| !file.ends_with("tests.rs")) {
        let text = fs::read_to_string(&file).unwrap();
        let lines = text.lines().take_while(|line| *line != "#[cfg(test)]");
        // Types that belong to a trait or a function are indented.
        for line in lines {
            let with_reach = || Some(line.strip_prefix("pub(")?.split_once(") ")?.1);
            let item = line
                .strip_prefix("pub ")
                .or_else(with_reach)
                .unwrap_or(line);
            let (kind, rest) = item.split_once(' ').unwrap_or_default();
            if ["struct", "enum", "trait", "type"].contains(&kind) {
                let name = rest.split(|it: char| !it.is_alphanumeric()).next().unwrap();
                places
                    .entry(name.to_owned())
                    .or_default()
                    .push(file.clone());
            }
        }
    }
    places.retain(|name, files| files.len() > 1 && !OF_COMMANDS.contains(&name.as_str()));
    let count = places.len();
    assert!(
        count <= MOST,
        "{count} names have several types: {places:#?}"
    );
}
