//! Ablations.

use super::{Conclusion, Study};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::format;
use phase::plot::ablation as figure;
use phase::record::Program;
use phase::study::StudyName;
use phase::study::ablation::{Ablated, Ablation, Finding, Skipped, write_ablation};
use phase::study::comparison::{Comparison, Cost, RunRow};
use serde_json::json;

/// An ablation, and whether effects are yet to be taken away in pairs.
impl Study for (Ablation, bool) {
    const NAME: StudyName = StudyName::Ablation;

    fn figures(&self) -> Vec<String> {
        vec!["ablation".to_owned()]
    }

    fn comparison(&self) -> &Comparison {
        &self.0.comparison
    }

    fn note_skipped(&self, console: &Console) {
        for Skipped { name, reason } in &self.0.skipped {
            console.note(format_args!("not tried: {name}: {reason}"));
        }
    }

    fn extended(&self, rows: &[Option<RunRow>]) -> Result<Option<Self>, Failure> {
        match self {
            (_, false) => Ok(None),
            (singles, true) => {
                let pairs = singles.with_pairs(rows).map_err(Failure::failed)?;
                Ok(Some((pairs, false)))
            }
        }
    }

    fn conclude(&self, rows: &[Option<RunRow>]) -> Result<Conclusion, Failure> {
        let (ablation, _) = self;
        let (ablated, cost) = (ablation.evaluate(rows), ablation.cost(rows));
        let finding = ablation.finding(&ablated);
        let sweep = &ablation.comparison.settings[0].sweep;
        let drawn = figure::draw(&ablated, &cost, sweep, &Program::current());
        Ok(Conclusion {
            json: json!({
                "cost": cost,
                "ablated": ablated,
                "skipped": ablation.skipped,
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
