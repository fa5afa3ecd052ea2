//! The rooms of the library import one another in one direction: each only those that stand above
//! it in the table of ARCHITECTURE.md.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms of the table in ARCHITECTURE.md, by name: their rank, the lowest first. Rooms of one
/// row have the same rank and may import one another.
fn ranks() -> BTreeMap<String, usize> {
    let text = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let section = text.split("\n## Rooms").nth(1).expect("a section `Rooms`");
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| `"));
    let mut ranks = BTreeMap::new();
    for (rank, row) in rows.enumerate() {
        let names = row.split('|').nth(1).unwrap();
        for name in names.split(',') {
            let name = name.trim().trim_matches('`').to_owned();
            assert_eq!(
                ranks.insert(name.clone(), rank),
                None,
                "{name} stands there twice"
            );
        }
    }
    ranks
}

/// All Rust files below a folder.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found
}

/// The modules that a file of `src` is in, such as `["store", "record", "read"]`.
fn module_of(file: &Path) -> Vec<String> {
    let path = file.strip_prefix("src").unwrap().with_extension("");
    let mut parts: Vec<String> = path
        .iter()
        .map(|part| part.to_str().unwrap().to_owned())
        .collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts
}

/// The names that follow `root`, or so many `super::` that they lead there, in code.
fn imports(text: &str, root: &str, depth: usize) -> Vec<String> {
    let code: Vec<&str> = text
        .lines()
        .map(|line| line.split("//").next().unwrap())
        .collect();
    let code = code.join("\n");
    let to_root = "super::".repeat(depth);
    let mut found = Vec::new();
    for start in [root, to_root.as_str()] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|it| it.is_alphanumeric() || it == '_' || it == ':') {
                continue;
            }
            found.extend(names_at(&code[at + start.len()..]));
        }
    }
    found
}

/// The first names of a path, or of all paths of a group in braces.
fn names_at(code: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let is_part = |it: &char| it.is_alphanumeric() || *it == '_';
        text.trim_start().chars().take_while(is_part).collect()
    };
    let Some(group) = code.strip_prefix('{') else {
        return vec![name(code)];
    };
    let mut names = vec![name(group)];
    let mut open = 1;
    for (at, character) in group.char_indices() {
        match character {
            '{' => open += 1,
            '}' => open -= 1,
            ',' if open == 1 => names.push(name(&group[at + 1..])),
            _ => {}
        }
        if open == 0 {
            break;
        }
    }
    names
}

#[test]
fn every_room_stands_in_the_table_once() {
    let ranks = ranks();
    let mut rooms: Vec<String> = files(Path::new("src"))
        .iter()
        .filter_map(|file| module_of(file).first().cloned())
        .filter(|room| !["lib", "main"].contains(&room.as_str()))
        .collect();
    rooms.sort();
    rooms.dedup();
    let known: Vec<&String> = ranks.keys().collect();
    assert_eq!(rooms.iter().collect::<Vec<_>>(), known);
}

#[test]
fn a_room_imports_only_rooms_above_it_in_the_table() {
    let ranks = ranks();
    let mut wrong = Vec::new();
    for file in files(Path::new("src")) {
        let module = module_of(&file);
        let Some(&rank) = module.first().and_then(|room| ranks.get(room)) else {
            continue;
        };
        let text = fs::read_to_string(&file).unwrap();
        for name in imports(&text, "crate::", module.len()) {
            if ranks.get(&name).is_some_and(|&other| other > rank) {
                wrong.push(format!("{} imports `{name}`", file.display()));
            }
        }
    }
    wrong.sort();
    wrong.dedup();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// What two commands need is a helper in `cli/`, or in the library.
#[test]
fn no_command_and_no_helper_imports_a_command() {
    let mut wrong = Vec::new();
    for file in files(Path::new("src/cli")) {
        let module = module_of(&file);
        let text = fs::read_to_string(&file).unwrap();
        let found = match module.get(2) {
            // A file of the command `own`; what it calls `commands` itself is not looked for.
            Some(own) if module[1] == "commands" => {
                let names = imports(&text, "crate::cli::commands::", module.len() - 2);
                let is_command = |name: &String| {
                    let path = Path::new("src/cli/commands").join(name);
                    path.is_dir() || path.with_extension("rs").is_file()
                };
                let others = names.into_iter().filter(|name| name != own);
                others.filter(is_command).collect()
            }
            _ if module.len() == 1 || module[1] == "commands" => Vec::new(),
            _ => {
                let names = imports(&text, "crate::cli::", module.len() - 1);
                let commands = names.into_iter().filter(|name| name == "commands");
                commands.collect::<Vec<_>>()
            }
        };
        let wrong_here = found
            .iter()
            .map(|name| format!("{} imports `{name}`", file.display()));
        wrong.extend(wrong_here);
    }
    wrong.sort();
    wrong.dedup();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// The test of the imports can fail.
#[test]
fn imports_are_found_however_they_are_written() {
    let text = "
        use crate::store::write_record; // use crate::cli::none
        use crate::{run::{Run, model_of}, sweep, cost as price};
        use super::super::plot::all;
        use super::near::Near;
        fn f() -> crate::record::Outcome { my_crate::render() }
    ";
    let mut found = imports(text, "crate::", 2);
    found.sort();
    assert_eq!(found, ["cost", "plot", "record", "run", "store", "sweep"]);
}
