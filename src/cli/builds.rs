//! Results that another build of the program made.

use super::console::Console;
use super::format;
use phase::record::Program;
use std::collections::BTreeMap;

/// Warns of results (each a `thing`) that are reused although another or an unknown build made
/// them: this build might give other bits.
pub(super) fn tell_of_others<'a>(
    thing: &str,
    makers: impl Iterator<Item = Option<&'a Program>>,
    console: &Console,
) {
    let mut counts = BTreeMap::<String, usize>::new();
    for maker in makers.filter(|maker| *maker != Some(&Program::current())) {
        let name = match maker {
            Some(Program { version, commit }) => format!("version {version} (commit {commit})"),
            None => "an unknown version".to_owned(),
        };
        *counts.entry(name).or_default() += 1;
    }
    for (maker, number) in counts {
        let (results, were, them) = match number {
            1 => (format::count(1, thing), "was", "it"),
            _ => (format::count(number, thing), "were", "them"),
        };
        console.warning(format_args!(
            "{results} {were} made by {maker}; --force runs {them} again"
        ));
    }
}
