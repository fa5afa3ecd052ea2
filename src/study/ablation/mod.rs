//! Which effects a scene needs: each is switched off, or down to a simpler law, and what that
//! changes is told from what seeds change.

mod finding;
mod table;

pub use finding::{Finding, Verdict};
pub use table::write_ablation;

use crate::document::{Document, LoadError, Problem};
use crate::grid::{PointError, Variant};
use crate::run;
use crate::scene::{Change, Start};
use crate::study::comparison::{
    AS_IT_IS, Base, Comparison, Cost, Measurement, RunRow, States, with_variants,
};
use crate::sweep::{Job, StudyRuns};
use serde::Serialize;

/// Fewest seeds of an ablation by default.
pub const FEWEST_SEEDS: usize = 5;

/// Most effects that are ablated in pairs: those that matter most.
const MOST_IN_PAIRS: usize = 4;

/// Most work of a simplification over that of the scene as it is.
const MOST_WORK: f64 = 20.0;

/// Effects that are ablated, with the scene as it is.
#[derive(Clone, Debug)]
pub struct Ablation {
    /// The scene as it is, then one setting for each simplification.
    pub comparison: Comparison,
    /// Simplifications that cannot be run or take far more work, and why.
    pub skipped: Vec<Skipped>,
    /// How it is made.
    pub options: AblationOptions,
    base: Base,
    /// What was found of single simplifications, of an ablation with pairs.
    of_singles: Option<Finding>,
}

/// How an ablation is made.
#[derive(Clone, Debug, PartialEq)]
pub struct AblationOptions {
    /// Number of seeds at each point; none for those of the sweep, or [`FEWEST_SEEDS`] if it has
    /// fewer.
    pub seeds: Option<usize>,
    /// Share of the labels that may change without an effect that is called not needed.
    pub tolerance: f64,
    /// Words of the names of the simplifications that are tried; empty for all.
    pub effects: Vec<String>,
}

/// All effects, at the seeds of the sweep.
impl Default for AblationOptions {
    fn default() -> Self {
        Self {
            seeds: None,
            tolerance: 0.05,
            effects: Vec::new(),
        }
    }
}

/// A simplification that is not tried.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Skipped {
    /// Its name.
    pub name: String,
    /// Why not.
    pub reason: String,
}

/// What a simplification does.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ablated {
    /// Its name.
    pub name: String,
    /// Runs that there are.
    pub runs: usize,
    /// Runs that there are not.
    pub missing: usize,
    /// What a run costs on average.
    pub cost: Cost,
    /// What it changes.
    pub states: States,
    /// Whether the scene needs what it takes away.
    pub verdict: Verdict,
}

/// Why there is no ablation.
#[derive(Debug, thiserror::Error)]
pub enum AblationError {
    /// The file is wrong.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A point cannot be run.
    #[error(transparent)]
    Point(#[from] PointError),
    /// The scene as it is cannot be labelled.
    #[error("the scene as it is cannot be compared: {0}")]
    AsItIs(String),
    /// The scene has nothing to take away: the file, and why what was meant is not tried.
    #[error("{0}: nothing of the scene can be switched off{1}")]
    NothingToAblate(String, String),
    /// No simplification has a name with this word.
    #[error("--ablate={word}: no simplification has that word in its name; there are {known}")]
    UnknownEffect {
        /// The word.
        word: String,
        /// Names of all simplifications.
        known: String,
    },
}

crate::refusal::always!(true: AblationError);

/// Refuses a setting whose time step is so small that it simplifies nothing. `work_of` is the work
/// of all runs of a variant.
fn check_work(
    work_of: impl Fn(&Variant) -> Result<u64, PointError>,
    as_it_is: &Variant,
    variant: &Variant,
) -> Result<(), String> {
    let work = |variant| work_of(variant).map(|it| it as f64);
    let of_variant = work(variant).map_err(|error| error.to_string())?;
    let ratio = of_variant / work(as_it_is).map_err(|error| error.to_string())?;
    match ratio > MOST_WORK {
        true => Err(format!(
            "its time steps, chosen by `dt = \"auto\"`, make {ratio:.0} times the work of the \
             scene as it is; give `time.dt` a number to try it all the same"
        )),
        false => Ok(()),
    }
}

/// The changes whose names hold one of these words; all without words.
fn chosen(
    mut changes: Vec<(String, Change)>,
    words: &[String],
) -> Result<Vec<(String, Change)>, AblationError> {
    let names = || changes.iter().map(|(name, _)| name.as_str());
    let unknown = words
        .iter()
        .find(|word| !names().any(|it| it.contains(*word)));
    if let Some(word) = unknown {
        return Err(AblationError::UnknownEffect {
            word: word.clone(),
            known: names().collect::<Vec<_>>().join(", "),
        });
    }
    changes.retain(|(name, _)| words.is_empty() || words.iter().any(|it| name.contains(it)));
    Ok(changes)
}

impl Ablation {
    /// The ablation of a scene or sweep.
    ///
    /// # Errors
    /// All that is wrong with the file, or if the scene has no effect.
    pub(super) fn of_document(
        document: &Document,
        options: AblationOptions,
    ) -> Result<Self, AblationError> {
        let mut base = Base::of_document(document)?;
        if matches!(base.sweep.scene.start, Start::List { .. }) {
            let message = "every sphere has its place, so that seeds change nothing and tell no \
                           noise; give it a random start";
            return Err(AblationError::AsItIs(message.to_owned()));
        }
        let first = base.sweep.seeds.first().copied().unwrap_or(1);
        let count = options
            .seeds
            .unwrap_or(base.sweep.seeds.len().max(FEWEST_SEEDS));
        if count != base.sweep.seeds.len() {
            base.sweep.seeds = (0..count as u64)
                .map(|next| first.saturating_add(next))
                .collect();
        }
        let scene = &base.sweep.scene;
        let singles = run::model_of(scene).simplifications(scene).into_iter();
        let singles = singles.map(|it| (it.name.clone(), Change::of_simplification(&it)));
        let singles = chosen(singles.collect(), &options.effects)?;
        base.sweep.study = Some(StudyRuns::Compared);
        let mut ablation = Self::new(base, singles, options)?;
        if ablation.comparison.settings.len() < 2 {
            let path = document.path().display().to_string();
            return Err(AblationError::NothingToAblate(path, ablation.why_skipped()));
        }
        ablation
            .skipped
            .sort_by(|one, other| one.name.cmp(&other.name));
        Ok(ablation)
    }

    fn new(
        base: Base,
        changes: Vec<(String, Change)>,
        options: AblationOptions,
    ) -> Result<Self, AblationError> {
        let in_words = |problems: Vec<Problem>| {
            let problems: Vec<String> = problems.iter().map(Problem::to_string).collect();
            problems.join("; ")
        };
        let as_it_is = base.setting(AS_IT_IS.to_owned(), Change::default());
        let as_it_is = as_it_is.map_err(|it| AblationError::AsItIs(in_words(it)))?;
        let work_of = |variant: &Variant| {
            let jobs = with_variants(&base.sweep, vec![variant.clone()]).jobs()?;
            Ok(jobs.iter().map(Job::work).sum())
        };
        let (mut settings, mut skipped) = (vec![as_it_is], Vec::new());
        for (name, change) in changes {
            let setting = base.setting(name.clone(), change).map_err(in_words);
            let setting = setting.and_then(|it| {
                check_work(work_of, &settings[0].1, &it.1)?;
                Ok(it)
            });
            match setting {
                Ok(setting) => settings.push(setting),
                Err(reason) => skipped.push(Skipped { name, reason }),
            }
        }
        let measurement = Measurement::States(Box::new(base.sweep.sieves.clone()));
        Ok(Self {
            comparison: Comparison::new(&base.sweep, settings, 0, measurement)?,
            skipped,
            options,
            base,
            of_singles: None,
        })
    }

    /// The same with each pair of those that matter: both at once. The sentence of its finding
    /// stays that about single effects. None if there is no pair, or these are here already.
    ///
    /// # Errors
    /// If a pair cannot be run at a point.
    pub fn with_pairs(&self, rows: &[Option<RunRow>]) -> Result<Option<Self>, AblationError> {
        if self.of_singles.is_some() {
            return Ok(None);
        }
        let ablated = self.evaluate(rows);
        let of_singles = Some(self.finding(&ablated));
        let mut matter: Vec<&Ablated> = ablated
            .iter()
            .filter(|it| it.verdict == Verdict::Needed)
            .collect();
        let excess = |it: &Ablated| {
            it.states
                .disagreement
                .as_ref()
                .map_or(0.0, |it| it.excess.value)
        };
        matter.sort_by(|one, other| excess(other).total_cmp(&excess(one)));
        matter.truncate(MOST_IN_PAIRS);
        let singles: Vec<(String, Change)> = self.comparison.settings[1..]
            .iter()
            .map(|it| (it.name.clone(), it.change.clone()))
            .collect();
        let chosen: Vec<&(String, Change)> = singles
            .iter()
            .filter(|(name, _)| matter.iter().any(|it| it.name == *name))
            .collect();
        let mut pairs = Vec::new();
        for (place, one) in chosen.iter().enumerate() {
            for other in &chosen[place + 1..] {
                if !one.1.touches(&other.1) {
                    pairs.push((format!("{} and {}", one.0, other.0), one.1.then(&other.1)));
                }
            }
        }
        if pairs.is_empty() {
            return Ok(None);
        }
        let mut both = Self::new(
            self.base.clone(),
            singles.into_iter().chain(pairs).collect(),
            self.options.clone(),
        )?;
        both.of_singles = of_singles;
        both.skipped.extend(self.skipped.clone());
        both.skipped.sort_by(|one, other| one.name.cmp(&other.name));
        both.skipped.dedup();
        Ok(Some(both))
    }

    /// What is not tried and why, behind a semicolon; empty if there is nothing.
    fn why_skipped(&self) -> String {
        let skipped = self.skipped.iter();
        let reasons: Vec<String> = skipped
            .map(|it| format!("{}: {}", it.name, it.reason))
            .collect();
        match reasons.as_slice() {
            [] => String::new(),
            reasons => format!("; {}", reasons.join("; ")),
        }
    }

    /// What follows from what simplifications do.
    pub fn finding(&self, ablated: &[Ablated]) -> Finding {
        let known = self.of_singles.clone();
        known.unwrap_or_else(|| Finding::of(ablated, self.options.tolerance))
    }

    /// What each simplification does, from the rows of all jobs.
    pub fn evaluate(&self, rows: &[Option<RunRow>]) -> Vec<Ablated> {
        let places = 1..self.comparison.settings.len();
        let of = |place: usize| {
            let sample = self.comparison.sample(place, rows);
            let states = States::of(&self.comparison, place, rows);
            let missing = sample.missing();
            Ablated {
                name: self.comparison.settings[place].name.clone(),
                runs: sample.runs().count(),
                missing,
                cost: sample.cost(),
                verdict: Verdict::of(&states, missing, self.options.tolerance),
                states,
            }
        };
        places.map(of).collect()
    }

    /// What a run of the scene as it is costs.
    pub fn cost(&self, rows: &[Option<RunRow>]) -> Cost {
        self.comparison.sample(0, rows).cost()
    }
}
