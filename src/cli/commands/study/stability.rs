//! Studies of stability.

use super::{Conclusion, Study};
use crate::cli::exit::Failure;
use phase::classify::NUMERICS;
use phase::plot::{self, StudyResult};
use phase::record::Program;
use phase::study::StudyName;
use phase::study::comparison::{Comparison, RunRow};
use phase::study::stability::{StabilityStudy, Tried};
use serde_json::json;

impl Study for StabilityStudy {
    const NAME: StudyName = StudyName::Stability;

    fn figures(&self) -> Vec<String> {
        vec!["stability".to_owned()]
    }

    fn comparison(&self) -> &Comparison {
        &self.comparison
    }

    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure> {
        let tried = self.evaluate(rows);
        let lines: Vec<String> = tried.iter().map(line).collect();
        let result = StudyResult::Stability(self, rows);
        let drawn = plot::draw("stability", (result, &Program::current()));
        Ok(Conclusion {
            json: json!({ "integrators": tried }),
            text: lines.join("\n"),
            table: None,
            figures: vec![("stability".to_owned(), drawn)],
        })
    }
}

/// How an integrator did, in a line.
fn line(tried: &Tried) -> String {
    let labels = NUMERICS.labels().into_iter();
    let counts = labels.filter_map(|label| {
        let count = tried.labels.get(label.name)?;
        Some(format!("{count} {}", label.name))
    });
    let mut text = format!(
        "{:<20} {}",
        tried.integrator,
        counts.collect::<Vec<_>>().join(", ")
    );
    match (tried.all_stable_below, tried.none_stable_above) {
        (Some(below), Some(above)) => {
            text += &format!(
                "; the first that is not stable is at {below:.3} of the limit, the last that is at \
                 {above:.3}"
            );
        }
        (None, Some(above)) => text += &format!(", up to {above:.3} of the limit"),
        _ => {}
    }
    text
}
