//! What must be right in a scene of another program.

use crate::document::{Problem, one_of, shown, suggest};
use crate::rule::Unit;
use crate::scene::program::{Marks, TextPiece, absent};
use crate::scene::{ExternalProgram, ProgramTable, Scene, TemplateFile};
use serde_json::Value;

/// Most columns that records keep.
const MOST_COLUMNS: usize = 200;

/// Largest size of all texts together (bytes): they are part of each record.
const MOST_TEXT: usize = 1_000_000;

impl Scene {
    /// All problems of a scene of another program.
    pub(crate) fn problems_of_program(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let Some(program) = &self.program else {
            return problems;
        };
        self.check_parameters(&mut problems);
        self.check_commands(program, &mut problems);
        self.check_files(program, &mut problems);
        self.check_tables(program, &mut problems);
        self.check_units(program, &mut problems);
        if let Some(code) = program
            .exit_codes
            .iter()
            .find(|it| !(0..=255).contains(*it))
        {
            let message = format!("{code} is no exit code");
            let problem = Problem::new("program.exit_codes", message);
            problems.push(problem.help("use numbers from 0 to 255"));
        }
        if program.exit_codes.is_empty() {
            let problem = Problem::new("program.exit_codes", "no exit code counts as success");
            problems.push(problem.help("write `exit_codes = [0]`, or leave it out"));
        }
        if program.found_version.is_some() && program.version.is_empty() {
            let problem = Problem::new("program.found_version", "the program has no `version`");
            problems.push(problem.help("remove it").at_key());
        }
        problems
    }

    fn check_parameters(&self, problems: &mut Vec<Problem>) {
        for (name, value) in &self.parameters {
            let path = format!("parameters.{name}");
            if ExternalProgram::NAMES.contains(&name.as_str()) {
                let message = format!("`@{{{name}}}` is the seed of the run");
                problems.push(
                    Problem::new(path, message)
                        .help("use another name")
                        .at_key(),
                );
            } else if !is_name(name) {
                let message = format!("`{name}` is no name of a parameter");
                let help = "use letters, digits and `_`, a letter first";
                problems.push(Problem::new(path, message).help(help).at_key());
            } else if value.is_object() || value.is_array() {
                let message = format!("`{path}` must be a number, a text, true or false");
                let help = "give a program long lists in a file of `program.files`";
                problems.push(Problem::new(path, message).help(help));
            }
        }
    }

    fn check_commands(&self, program: &ExternalProgram, problems: &mut Vec<Problem>) {
        let of_resume = program.resume.iter().map(|it| &it.commands);
        let lists = [("program.commands", &program.commands)];
        let all = lists
            .into_iter()
            .chain(of_resume.map(|it| ("program.resume.commands", it)));
        for (path, commands) in all {
            if commands.is_empty() {
                let help =
                    "write the program and its words, such as `[[\"python3\", \"model.py\"]]`";
                problems.push(Problem::new(path, "there is no command").help(help));
            }
            for (place, words) in commands.iter().enumerate() {
                let path = format!("{path}[{place}]");
                if words.first().is_none_or(String::is_empty) {
                    let help = "write the name of a program first";
                    problems.push(Problem::new(&path, "the command is empty").help(help));
                }
                for (word, text) in words.iter().enumerate() {
                    self.check_marks(text, &format!("{path}[{word}]"), "", problems);
                }
            }
        }
        let words = program.version.iter().enumerate();
        for (word, text) in words.filter(|(_, text)| Marks::of(text).any(|it| it.is_mark())) {
            let message = format!("`{text}` holds a mark, but all runs have one version");
            let problem = Problem::new(format!("program.version[{word}]"), message);
            problems.push(problem.help("leave the mark out"));
        }
    }

    fn check_files(&self, program: &ExternalProgram, problems: &mut Vec<Problem>) {
        let size: usize = program.texts().map(|it| it.text.len()).sum();
        if size > MOST_TEXT {
            let message = format!("the files hold {size} bytes, which each record would keep");
            let help = format!(
                "{MOST_TEXT} are the most; name large files of data by their full path in a \
                 command or template instead"
            );
            problems.push(Problem::new("program.files", message).help(help));
        }
        let mut names: Vec<String> = Vec::new();
        for (place, file) in program.files.iter().enumerate() {
            let TemplateFile::Text(file) = file else {
                continue;
            };
            let path = format!("program.files[{place}]");
            self.check_place(&file.name, &format!("{path}.name"), problems);
            let name = self.filled_text(&file.name);
            if ExternalProgram::is_reserved(&name) {
                let message = format!("`{}` is a file of this program", shown(&name));
                let help = "use a name that does not begin with `phase-`";
                problems.push(Problem::new(format!("{path}.name"), message).help(help));
            }
            if names.contains(&name) {
                let message = format!("two files have the name `{}`", shown(&name));
                problems.push(Problem::new(&path, message).help("rename one of them"));
            }
            names.push(name);
            let shown = format!("{}: ", file.name);
            self.check_marks(&file.text, &format!("{path}.text"), &shown, problems);
        }
        for (file, path) in [
            (
                program.states.as_ref().map(|it| &it.file),
                "program.states.file",
            ),
            (
                program.resume.as_ref().map(|it| &it.file),
                "program.resume.file",
            ),
        ] {
            if let Some(file) = file {
                self.check_place(file, path, problems);
            }
        }
    }

    fn check_tables(&self, program: &ExternalProgram, problems: &mut Vec<Problem>) {
        if program.columns().next().is_none() {
            let help = "add [[program.read]] with `file` and `columns`";
            problems.push(Problem::new("program.read", "nothing is read of a run").help(help));
        }
        if program.columns().count() > MOST_COLUMNS {
            let help = format!("{MOST_COLUMNS} are the most");
            problems.push(Problem::new("program.read", "too many columns").help(help));
        }
        let timed = program.read.iter().filter(|it| it.time.is_some()).count();
        if timed != 0 && timed != program.read.len() {
            let help = "give `time` for all tables, or for none: rows go together by it";
            let message = "some tables have a time and others have none";
            problems.push(Problem::new("program.read", message).help(help));
        }
        if let (Some(states), Some(filled)) = (&program.states, self.filled_program())
            && let Some((_, radius)) = filled.states
            && !(radius > 0.0 && radius.is_finite())
        {
            let message = format!("`{}` is no radius", states.radius);
            let help = "write a number above 0 in quotes, or a mark such as `\"@{radius}\"`";
            problems.push(Problem::new("program.states.radius", message).help(help));
        }
        let mut names: Vec<&str> = vec!["time"];
        for (place, table) in program.read.iter().enumerate() {
            let path = format!("program.read[{place}]");
            self.check_place(&table.file, &format!("{path}.file"), problems);
            check_columns(table, &path, &mut names, problems);
        }
    }

    fn check_units(&self, program: &ExternalProgram, problems: &mut Vec<Problem>) {
        for (name, unit) in &program.units {
            let path = format!("program.units.{name}");
            if name != "time" && !self.parameters.contains_key(name) {
                let message = format!("[parameters] has no `{name}`");
                let help = suggest(name, self.parameters.keys().map(String::as_str));
                let problem = Problem::new(&path, message).at_key();
                problems.push(match help {
                    Some(near) => problem.help(format!("did you mean `{near}`?")),
                    None => problem.help("remove it"),
                });
            }
            problems.extend(wrong_unit(unit, &path));
        }
    }

    /// A file of a run lies in its folder.
    fn check_place(&self, name: &str, path: &str, problems: &mut Vec<Problem>) {
        self.check_marks(name, path, "", problems);
        // Marks may lead elsewhere.
        let name = self.filled_text(name);
        if !ExternalProgram::is_inside(&name) {
            let message = format!("`{}` is no file in the folder of a run", shown(&name));
            let help = "write its path in this folder, without `..` and without a leading `/`";
            problems.push(Problem::new(path, message).help(help));
        }
    }

    /// Every mark is the name of a parameter or of a seed.
    fn check_marks(&self, text: &str, path: &str, shown: &str, problems: &mut Vec<Problem>) {
        for piece in Marks::of(text) {
            let (place, message, help) = match piece {
                TextPiece::Plain(_) => continue,
                TextPiece::Mark(name, _) if self.is_known(name) => continue,
                TextPiece::Mark(name, place) => {
                    let known = self.parameters.keys().map(String::as_str);
                    let known: Vec<&str> = known.chain(ExternalProgram::NAMES).collect();
                    let help = match suggest(name, known.iter().copied()) {
                        Some(near) => format!("did you mean `@{{{near}}}`? "),
                        None => String::new(),
                    };
                    let known = one_of(&known);
                    let message = format!("`@{{{name}}}` stands for nothing");
                    let help = format!(
                        "{help}[parameters] and the run have {known}; `@@{{` \
                                        writes `@{{` itself"
                    );
                    (place, message, help)
                }
                TextPiece::Open(place) => {
                    let help = "write `}` behind its name, or `@@{` for the signs themselves";
                    (place, "the mark has no end".to_owned(), help.to_owned())
                }
            };
            let problem = match shown {
                "" => Problem::new(path, message).part(place),
                shown => {
                    let line = text[..place.start].matches('\n').count() + 1;
                    let file = shown.trim_end_matches(": ");
                    Problem::new(path, format!("{file}:{line}: {message}"))
                }
            };
            problems.push(problem.help(help));
        }
    }

    fn is_known(&self, name: &str) -> bool {
        self.parameters.contains_key(name) || ExternalProgram::NAMES.contains(&name)
    }
}

fn check_columns<'a>(
    table: &'a ProgramTable,
    path: &str,
    names: &mut Vec<&'a str>,
    problems: &mut Vec<Problem>,
) {
    for (place, column) in table.columns.iter().enumerate() {
        let (name, path) = (column.name(), format!("{path}.columns[{place}]"));
        let is_small = |it: char| it.is_ascii_lowercase() || it.is_ascii_digit() || it == '_';
        if !is_name(name) || !name.chars().all(is_small) {
            let message = format!("`{name}` is no name of a column");
            let help = format!(
                "write `{{ name = \"...\", from = \"{name}\" }}`, with a name of small letters, \
                 digits and `_`"
            );
            problems.push(Problem::new(&path, message).help(help));
        } else if names.contains(&name) {
            let message = format!("another column has the name `{name}` already");
            let help = "give it another `name`, and this one as `from`";
            problems.push(Problem::new(&path, message).help(help));
        }
        names.push(name);
        let unit = column.unit();
        problems.extend(wrong_unit(unit, &format!("{path}.unit")));
    }
    let header = &table.header;
    let is_lacking = |name: &str| !header.is_empty() && !header.iter().any(|it| it == name);
    if let Some(wanted) = table.time.as_deref().filter(|it| is_lacking(it)) {
        let message = format!("`header` names no column `{wanted}`");
        let problem = Problem::new(format!("{path}.time"), message);
        problems.push(problem.help("give the name as `header` has it"));
    }
    let mut columns = table.columns.iter();
    if let Some(lacking) = columns.find(|column| is_lacking(column.source())) {
        let message = format!("`header` names no column `{}`", lacking.source());
        let problem = Problem::new(format!("{path}.header"), message);
        problems.push(problem.help("name all columns of the file, in order"));
    }
}

/// Whether a name begins with a letter and goes on with letters, digits and `_`.
fn is_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(|it| it.is_ascii_alphabetic())
        && letters.all(|it| it.is_ascii_alphanumeric() || it == '_')
}

fn wrong_unit(unit: &str, path: &str) -> Option<Problem> {
    let error = Unit::parse(unit).err()?;
    let problem = Problem::new(path, error.message).help(error.help);
    Some(problem.part(error.span))
}

/// Refuses tables that mean nothing beside a program, and adds what stands for the parts of models
/// to the tree of its scene.
pub(in crate::scene) fn complete(tree: &mut Value) -> Vec<Problem> {
    const KEPT: [&str; 4] = ["title", "seed", "program", "parameters"];
    if !tree["program"].is_object() {
        if tree.get("parameters").is_some() {
            let message = "[parameters] are for a program, and the scene has no [program]";
            let help = "remove it, or add [program]";
            return vec![Problem::new("parameters", message).help(help).at_key()];
        }
        return Vec::new();
    }
    let absent = absent_parts();
    let is_absent = |key: &String, value: &Value| {
        let mut parts = absent.iter();
        parts.any(|(name, part)| name == key && part == value)
    };
    let keys = tree.as_object().into_iter().flatten();
    let others =
        keys.filter(|(key, value)| !KEPT.contains(&key.as_str()) && !is_absent(key, value));
    let refuse = |key: &String| {
        let message = format!("`{key}` means nothing in a scene of another program");
        let help = "remove it; what the program is given stands in [parameters]";
        Problem::new(key, message).help(help).at_key()
    };
    let problems: Vec<Problem> = others.map(|(key, _)| refuse(key)).collect();
    if problems.is_empty() {
        add_absent(tree);
    }
    problems
}

/// Adds what stands for the parts of models.
pub(super) fn add_absent(tree: &mut Value) {
    for (key, part) in absent_parts() {
        tree[key] = part;
    }
}

/// What stands for the parts of models.
fn absent_parts() -> [(&'static str, Value); 4] {
    let kept = |value: Result<Value, serde_json::Error>| value.expect("it holds numbers and words");
    [
        ("spheres", kept(serde_json::to_value(absent::spheres()))),
        ("start", kept(serde_json::to_value(absent::start()))),
        ("time", kept(serde_json::to_value(absent::time()))),
        ("output", kept(serde_json::to_value(absent::output()))),
    ]
}
