//! Other programs behind the sweep: small scripts of the shell, and real programs.

mod failures;
mod ising;
mod lammps;
mod leave;
mod marks;
mod messages;
mod results;
mod stops;
mod studies;
mod versions;

use crate::support::Workplace;
use std::io::Write;
use std::process::Command;

/// Whether a test has the program that it needs. Where it is absent the test says so; with
/// `PHASE_NEED_PROGRAMS=1` in the environment, as in continuous integration, it fails.
pub(crate) fn has(program: &str, argument: &str) -> bool {
    let answer = Command::new(program).arg(argument).output();
    let is_there = answer.is_ok_and(|it| it.status.success());
    let required = std::env::var_os("PHASE_NEED_PROGRAMS").is_some();
    assert!(is_there || !required, "{program} is needed but absent");
    if !is_there {
        say(&format!("SKIPPED a check of programs: {program} is absent"));
    }
    is_there
}

/// Says something that the test runner does not hide.
pub(crate) fn say(text: &str) {
    std::io::stderr()
        .write_all(format!("{text}\n").as_bytes())
        .unwrap();
}

/// A sweep over `x` that runs a script of the shell, which may use marks and writes the columns
/// `t` and `y` to `out.csv`. `more` goes into the table of the program.
pub(crate) fn sweep_of(script: &str, values: &str, more: &str) -> String {
    format!(
        r#"
[scene.program]
commands = [["sh", "model.sh"]]
files = [{{ name = "model.sh", text = '''
{script}
''' }}]
units = {{ x = "m", time = "s" }}
{more}

[[scene.program.read]]
file = "out.csv"
time = "t"
columns = [{{ name = "y", unit = "m", description = "Place" }}]

[scene.parameters]
x = 1.0

[[axis]]
key = "parameters.x"
values = {values}

[[label]]
name = "far"
when = "last(y) > 2[m]"

[[label]]
name = "near"
when = "last(y) <= 2[m]"
"#
    )
}

/// Writes two frames: `y` is 0, then `x`.
pub(crate) const MODEL: &str = "printf 't,y\\n0,0\\n1.5,@{x}\\n' > out.csv";

/// A folder with the sweep `model.toml`.
pub(crate) fn place_of(script: &str, values: &str, more: &str) -> Workplace {
    let place = Workplace::new();
    place.write("model.toml", &sweep_of(script, values, more));
    place
}
