//! `phase ablate`: which effects a scene needs.

use super::accuracy;
use super::study::{Options, Place, Tally};
use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use crate::cli::format;
use phase::plot::ablation as figure;
use phase::record::Program;
use phase::store;
use phase::study::ablation::{Ablated, Ablation, AblationError, Finding, Skipped, write_ablation};
use phase::study::comparison::{Comparing, Cost, KnownRuns, Report, read_runs};
use serde::Serialize;
use std::path::PathBuf;

/// Switch off each effect of a scene, or down to its simpler law, and see what that changes.
///
/// Every law and effect is taken away by itself: quadratic drag down to linear, Mindlin friction
/// down to Coulomb's and to none, the counting shield to none, and so on. Labels and order
/// parameters are compared with those of the scene as it is, beyond what seeds change by
/// themselves. Where two effects matter, both are taken away at once too. Runs whose row is in the
/// table already are not made again.
#[derive(clap::Args)]
#[command(after_help = "\
Example: which effects decide the published diagram?
  phase ablate sweeps/theoretical-9x9.toml --seeds 5

The results folder holds runs.csv (one row per run), ablation.csv (one row per effect),
ablation.json (all of it, with the sentence) and the figure as SVG and PNG.")]
pub(crate) struct Arguments {
    /// The scene or sweep file (TOML).
    file: PathBuf,
    /// Number of seeds at each point [default: those of the sweep, or 5 if it has fewer].
    #[arg(short, long, value_name = "N", value_parser = three_or_more)]
    seeds: Option<usize>,
    /// Share of the labels that may change without an effect that is called not needed.
    #[arg(long, value_name = "SHARE", default_value = "0.05", value_parser = share)]
    tolerance: f64,
    /// Take away one effect at a time only.
    #[arg(long)]
    no_pairs: bool,
    #[command(flatten)]
    pub(super) options: Options,
}

fn three_or_more(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if (3..=10_000).contains(&number) => Ok(number),
        _ => Err(
            "must be a whole number from 3 to 10000: fewer seeds tell nothing from noise".into(),
        ),
    }
}

fn share(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(share) if share > 0.0 && share <= 1.0 => Ok(share),
        _ => Err("must be a number above 0, and 1 at most".to_owned()),
    }
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let ablation = Ablation::load(&arguments.file, arguments.seeds).map_err(Failure::refused)?;
    let options = &arguments.options;
    let files = (
        &["runs.csv", "ablation.csv", "ablation.json"][..],
        &["ablation"][..],
    );
    let place = Place::open("ablation", &arguments.file, options, files, console)?;
    let known = accuracy::known_runs(&ablation.comparison, options, &place)?;
    for Skipped { name, reason } in &ablation.skipped {
        console.note(format_args!("not tried: {name}: {reason}"));
    }
    let mut done = Done::run(ablation, known, arguments, &place, console)?;
    let is_whole = |done: &Done| done.tally.left == 0;
    let needed = done.finding.clone();
    if is_whole(&done) && !arguments.no_pairs {
        let pairs = done.ablation.with_pairs(&done.report.rows, &needed);
        let pairs = pairs.map_err(|error: AblationError| Failure::failed(error))?;
        // Also those of pairs that were made before.
        let table = Comparing::table(&place.folder);
        let known = read_runs(&pairs.comparison, &table).map_err(Failure::failed)?;
        done = Done::run(pairs, known, arguments, &place, console)?;
        // The sentence is about single effects.
        done.finding = needed;
    }
    console.file(&Comparing::table(&place.folder));
    if is_whole(&done) {
        done.conclude(options, &place, console)?;
    }
    let exit = done.tally.exit();
    console.answer(&Answer {
        tally: &done.tally,
        kept: done.kept(),
        files: console.files(),
    });
    Ok(exit)
}

/// An ablation whose runs were made.
struct Done {
    ablation: Ablation,
    report: Report,
    tally: Tally,
    ablated: Vec<Ablated>,
    finding: Finding,
}

impl Done {
    fn run(
        ablation: Ablation,
        known: KnownRuns,
        arguments: &Arguments,
        place: &Place,
        console: &Console,
    ) -> Result<Self, Failure> {
        let comparison = &ablation.comparison;
        let (report, tally) = accuracy::run(comparison, &arguments.options, place, known, console)?;
        let ablated = ablation.evaluate(&report.rows, arguments.tolerance);
        let finding = Finding::of(&ablated, arguments.tolerance);
        Ok(Self {
            ablation,
            report,
            tally,
            ablated,
            finding,
        })
    }

    /// What is kept of it.
    fn kept(&self) -> Kept<'_> {
        Kept {
            cost: self.ablation.cost(&self.report.rows),
            ablated: &self.ablated,
            skipped: &self.ablation.skipped,
            finding: &self.finding,
        }
    }

    /// Prints and writes what was found.
    fn conclude(&self, options: &Options, place: &Place, console: &Console) -> Result<(), Failure> {
        let cost = self.ablation.cost(&self.report.rows);
        console.result(text(&self.ablated, &cost, &self.finding));
        let table = place.file("ablation.csv");
        write_ablation(&self.ablated, &cost, &table).map_err(Failure::failed)?;
        console.file(&table);
        let json = place.file("ablation.json");
        let bytes = serde_json::to_vec_pretty(&self.kept()).map_err(Failure::failed)?;
        store::write_atomic(&json, &bytes).map_err(Failure::failed)?;
        console.file(&json);
        if !options.no_plot {
            let sweep = &self.ablation.comparison.settings[0].sweep;
            let drawn = figure::draw(&self.ablated, &cost, sweep, &Program::current());
            let drawn = drawn.map_err(Failure::failed)?;
            figures::write(
                &drawn,
                |end| place.file(&format!("ablation.{end}")),
                console,
            )?;
        }
        Ok(())
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

/// What `ablation.json` holds.
#[derive(Serialize)]
struct Kept<'a> {
    cost: Cost,
    ablated: &'a [Ablated],
    skipped: &'a [Skipped],
    finding: &'a Finding,
}

/// What `--json` prints.
#[derive(Serialize)]
struct Answer<'a> {
    #[serde(flatten)]
    tally: &'a Tally,
    #[serde(flatten)]
    kept: Kept<'a>,
    files: Vec<String>,
}
