//! Ablations.

use super::{Conclusion, Study};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::format;
use phase::plot::{self, StudyResult};
use phase::record::Program;
use phase::study::StudyName;
use phase::study::ablation::{Ablated, Ablation, Finding, Skipped, write_ablation};
use phase::study::comparison::{Comparison, Cost, RunRow};
use serde_json::json;

impl Study for Ablation {
    const NAME: StudyName = StudyName::Ablation;

    fn figures(&self) -> Vec<String> {
        vec!["ablation".to_owned()]
    }

    fn comparison(&self) -> &Comparison {
        &self.comparison
    }

    fn note_skipped(&self, console: &Console) {
        for Skipped { name, reason } in &self.skipped {
            console.note(format_args!("not tried: {name}: {reason}"));
        }
    }

    fn extended(&self, rows: &[Option<RunRow>]) -> Result<Option<Self>, Failure> {
        Ok(self.with_pairs(rows)?)
    }

    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure> {
        let (ablated, cost) = (self.evaluate(rows), self.cost(rows));
        let finding = self.finding(&ablated);
        let result = StudyResult::Ablation(self, &ablated, &cost);
        let drawn = plot::draw("ablation", (result, &Program::current()));
        Ok(Conclusion {
            json: json!({
                "cost": cost,
                "ablated": ablated,
                "skipped": self.skipped,
                "finding": finding,
            }),
            text: text(&ablated, &cost, &finding),
            table: Some(Box::new(move |path| write_ablation(&ablated, &cost, path))),
            figures: vec![("ablation".to_owned(), drawn)],
        })
    }
}

/// A line for every effect, and the sentence.
fn text(ablated: &[Ablated], cost: &Cost, finding: &Finding) -> String {
    let longest = ablated.iter().map(|it| it.name.chars().count()).max();
    let width = longest.unwrap_or(0).max(7);
    let mut lines = vec![format!(
        "as it is: {} of processor time and {} force evaluations a run",
        format::short_duration(cost.cpu_seconds),
        format::with_prefix(cost.force_evaluations, "")
    )];
    for it in ablated {
        let labels = it.states.disagreement.as_ref();
        let labels = labels.map_or_else(
            || "labels unknown".to_owned(),
            |it| {
                format!(
                    "{:.1} % of labels changed ({:.1} to {:.1}), seeds alone {:.1}",
                    100.0 * it.excess.value,
                    100.0 * it.excess.low,
                    100.0 * it.excess.high,
                    100.0 * it.floor.value
                )
            },
        );
        let time = it.cost.cpu_seconds / cost.cpu_seconds;
        lines.push(format!(
            "{:<width$}  {:<10}  {labels}; takes {time:.2} of the time",
            it.name,
            it.verdict.words()
        ));
    }
    lines.push(finding.sentence.clone());
    lines.join("\n")
}
