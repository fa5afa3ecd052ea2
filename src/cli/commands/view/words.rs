//! Text around the panels, and in the metadata.

use super::moment::{self, seconds};
use phase::observe::Snapshot;
use phase::record::RunRecord;
use phase::scene::{Radii, Units};
use std::collections::BTreeSet;

/// The caption of a state: its time after the origin (s), and what happened since the state before.
pub(super) fn caption(record: &RunRecord, state: &Snapshot, origin: f64) -> String {
    let unit = record.scene.units().of_time();
    let time = format!("t = {} {unit}", seconds(record, state.time - origin));
    let news = moment::news(record, state).map(|kind| kind.name().to_owned());
    let words: Vec<String> = std::iter::once(time).chain(news).collect();
    words.join(", ")
}

/// What is known of the run's place in a sweep.
pub(super) fn place(record: &RunRecord) -> String {
    let named = named(record).into_iter();
    named.map(|(_, words)| words).collect::<Vec<_>>().join(", ")
}

/// The keys that give a run's place in a sweep, with their values.
fn named(record: &RunRecord) -> Vec<(&'static str, String)> {
    let scene = &record.scene;
    let mut named = vec![("spheres.count", format!("n = {}", record.radius.len()))];
    let radii = match &scene.spheres.radius {
        Radii::One(_) if scene.units() == Units::OfSpheres => Vec::new(),
        Radii::One(radius) => vec![*radius],
        Radii::Shares(shares) => shares.iter().map(|it| it.radius).collect(),
        Radii::File { .. } | Radii::Each(_) => Vec::new(),
    };
    if !radii.is_empty() {
        let radii: Vec<String> = radii.iter().map(|radius| millimetres(*radius)).collect();
        named.push(("spheres.radius", format!("r = {} mm", radii.join(" and "))));
    }
    if let Some(swirl) = &scene.dem.effects.swirl {
        named.push(("swirl.omega", format!("Ω = {} rad/s", swirl.omega)));
    }
    named.push(("seed", format!("seed {}", scene.seed)));
    named
}

/// A length (m) in millimetres, as its file would have it: a product would have other last digits.
fn millimetres(length: f64) -> String {
    let shifted = format!("{length}e3").parse();
    shifted.unwrap_or(1e3 * length).to_string()
}

/// Letters of a line of a caption that has several.
const LINE: usize = 36;

/// What distinguishes each of several runs from the others, in lines; nothing if their titles and
/// places do.
pub(super) fn differences(records: &[&RunRecord]) -> Vec<Vec<String>> {
    let titles: BTreeSet<&str> = records
        .iter()
        .filter_map(|it| it.scene.title.as_deref())
        .collect();
    if titles.len() == records.len() {
        return vec![Vec::new(); records.len()];
    }
    let is_told = |key: &str| {
        records
            .iter()
            .all(|it| named(it).iter().any(|(name, _)| *name == key))
    };
    let mut told: Vec<&str> = records
        .iter()
        .flat_map(|it| named(it))
        .map(|(key, _)| key)
        .collect();
    told.retain(|key| is_told(key));
    let differences = phase::plot::differences(records, &told).into_iter();
    differences.map(|parts| lines(&parts)).collect()
}

/// A list in lines.
fn lines(parts: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parts {
        match lines.last_mut() {
            Some(line) if line.chars().count() + part.chars().count() < LINE => {
                line.push_str(", ");
                line.push_str(part);
            }
            _ => lines.push(part.clone()),
        }
    }
    lines
}

/// The text in the metadata of a picture.
pub(super) fn texts(record: &RunRecord) -> Vec<(&'static str, String)> {
    vec![
        ("Title", record.scene.title.clone().unwrap_or_default()),
        ("Software", format!("phase {}", record.program.version)),
        ("Commit", record.program.commit.clone()),
        ("Run", record.scene.identity()),
        ("Seed", record.scene.seed.to_string()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symptom: two radii had one caption. Cause: numbers were rounded to 14 digits.
    #[test]
    fn lengths_have_the_digits_of_their_file() {
        for (length, expected) in [
            (0.003, "3"),
            (0.0023, "2.3"),
            (0.003_000_000_000_000_01, "3.00000000000001"),
            (1e-7, "0.0001"),
        ] {
            assert_eq!(millimetres(length), expected);
        }
    }
}
