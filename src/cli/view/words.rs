//! What is written around the panels, and into the metadata.

use super::moment;
use phase::observe::Snapshot;
use phase::record::RunRecord;
use phase::scene::{Radii, Units};

/// A time as text, with as many digits as the frames ask for.
fn seconds(record: &RunRecord, time: f64) -> String {
    let interval = record.scene.time.frame_interval;
    let tenfold = std::iter::successors(Some(interval), |scaled| Some(10.0 * scaled));
    let digits = tenfold.take(18).position(|scaled| scaled >= 1.0 - 1e-9);
    format!("{time:.*}", digits.unwrap_or(18))
}

/// The same without zeros at its end.
pub(super) fn brief(record: &RunRecord, time: f64) -> String {
    let text = seconds(record, time);
    text.parse()
        .map_or(text, |rounded: f64| rounded.to_string())
}

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
    let scene = &record.scene;
    let mut place = vec![format!("n = {}", record.radius.len())];
    let millimetres = |radius: f64| clean(1e3 * radius).to_string();
    match &scene.spheres.radius {
        Radii::One(_) if scene.units() == Units::OfSpheres => {}
        Radii::One(radius) => place.push(format!("r = {} mm", millimetres(*radius))),
        Radii::Shares(shares) => {
            let radii: Vec<String> = shares.iter().map(|it| millimetres(it.radius)).collect();
            place.push(format!("r = {} mm", radii.join(" and ")));
        }
        Radii::File { .. } | Radii::Each(_) => {}
    }
    if let Some(swirl) = &scene.dem.effects.swirl {
        place.push(format!("Ω = {} rad/s", clean(swirl.omega)));
    }
    place.push(format!("seed {}", scene.seed));
    place.join(", ")
}

/// A number as its file has it: without the last digits, which only calculations change.
fn clean(value: f64) -> f64 {
    format!("{value:.13e}").parse().unwrap_or(value)
}

/// What the metadata of a picture says.
pub(super) fn texts(record: &RunRecord) -> Vec<(&'static str, String)> {
    vec![
        ("Title", record.scene.title.clone().unwrap_or_default()),
        ("Software", format!("phase {}", record.program.version)),
        ("Commit", record.program.commit.clone()),
        ("Run", record.scene.identity()),
        ("Seed", record.scene.seed.to_string()),
    ]
}
