//! Ceilings that a change may not break without a reason: lines of rooms, commands, and what it
//! takes to extend the program.

use std::fs;
use std::path::Path;

/// Lines of code: without blank lines, comments, and the tests at the end of a file.
fn code_lines(file: &Path) -> usize {
    let text = fs::read_to_string(file).unwrap();
    let code = text.lines().take_while(|line| *line != "#[cfg(test)]");
    code.map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
        .count()
}

fn lines_of_rooms(rooms: &[&str]) -> usize {
    let files = rooms
        .iter()
        .flat_map(|room| crate::rooms::files(&Path::new("src").join(room)));
    files
        .filter(|file| !file.ends_with("tests.rs"))
        .map(|file| code_lines(&file))
        .sum()
}

fn commands() -> usize {
    let text = fs::read_to_string("src/cli/commands/mod.rs").unwrap();
    text.lines().filter(|line| line.starts_with("mod ")).count()
}

/// What is measured, and what it may be at most. Lower a number when it has come down.
#[test]
fn rooms_stay_small() {
    let rows = [
        ("lines of cli", lines_of_rooms(&["cli"]), 10_150),
        (
            "lines of grid, sweep and study",
            lines_of_rooms(&["grid", "sweep", "study"]),
            8750,
        ),
        ("commands", commands(), 19),
        (
            "a backend: a process for each job",
            code_lines(Path::new("examples/processes.rs")),
            110,
        ),
        (
            "a refined sweep without the command line",
            code_lines(Path::new("examples/refined_sweep.rs")),
            40,
        ),
    ];
    for (what, number, most) in rows {
        assert!(number <= most, "{what}: {number}, more than {most}");
    }
}
