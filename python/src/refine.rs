//! Refining as ask and tell.

use crate::error::Failure;
use crate::folder::{coordinate_of, folder_at, labels_of, sweep_of};
use crate::table::{Attribute, Table, Values, Variable};
use crate::watch::watched;
use phase::refine::{
    AxisScale, Borders, Code, Finish, Lattice, LatticeAxis, Observations, ProbabilityMap,
    RefineError, Round, Rounds, Settings, Trial,
};
use phase::sweep::{Learnt, Sweep, label_name};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Most labels of a function.
const MOST_LABELS: usize = 100;

/// A diagram that is refined by questions and answers.
#[pyclass(module = "phase._lib")]
pub(crate) struct Refinement {
    /// What is asked and learnt, label by code.
    rounds: Rounds,
    /// Names of labels, each with its code.
    names: Vec<(Code, String)>,
    /// Runs that were asked for and are not told yet.
    open: Vec<Trial>,
    /// Labels that were told since the last batch.
    told: Vec<(Trial, String)>,
    end: Option<Finish>,
    /// The sweep of the folder that it is made of.
    sweep: Option<Sweep>,
}

#[pymethods]
impl Refinement {
    /// Questions about a function on these axes, each with its values. `settings` is the TOML text
    /// of the table.
    #[new]
    fn new(axes: Vec<(String, Vec<f64>)>, settings: &str) -> PyResult<Self> {
        let settings: Settings =
            toml::from_str(settings).map_err(|error| Failure::refused(error.message()))?;
        let axes = axes.into_iter().map(|(name, mut values)| {
            values.sort_by(f64::total_cmp);
            let scale = AxisScale::of(&values);
            LatticeAxis::new(&name, values, scale)
        });
        let axes = axes.collect::<Result<_, _>>().map_err(refused)?;
        let lattice = Lattice::new(axes).map_err(refused)?;
        check_budget(&lattice, &settings)?;
        let rounds = Rounds::new(lattice, settings).map_err(refused)?;
        Ok(Self::of(rounds, Vec::new(), None))
    }

    /// What the runs of a results folder tell.
    #[staticmethod]
    fn of_folder(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        watched(py, None, |_| {
            let folder = folder_at(&path)?;
            let mut sweep = sweep_of(&folder)?;
            let table = labels_of(&folder)?;
            let refining = folder.read_refining(&sweep)?;
            if sweep.refine.is_none() {
                let refined = sweep.refine_by_default();
                refined.map_err(|reason| Failure::refused(reason).of(folder.root()))?;
            }
            let settings = sweep
                .refine
                .clone()
                .ok_or_else(|| Failure::refused("the sweep is not refined").of(folder.root()))?;
            let runs = Learnt::runs_of(refining.as_ref(), &table).map_err(refused)?;
            let mut rounds =
                Rounds::new(sweep.lattice().map_err(refused)?, settings).map_err(refused)?;
            learn_all(&mut rounds, &runs).map_err(refused)?;
            let codes = runs.iter().map(|(_, code)| code);
            let family = table.family;
            let names = codes.map(|code| (code, label_name(family, code).to_owned()));
            let mut names: Vec<(Code, String)> = names.collect();
            names.sort_unstable();
            names.dedup();
            Ok(Self::of(rounds, names, Some(sweep)))
        })
    }

    /// The runs of the batch that are not told yet, each by its values and seed; a new batch once
    /// all are told, and none at the end.
    fn ask(&mut self, py: Python<'_>) -> PyResult<Vec<(Vec<f64>, u64)>> {
        let open = watched(py, None, |_| self.next_batch())?;
        Ok(open.into_iter().map(|run| (run.values, run.seed)).collect())
    }

    /// Takes the label of a run.
    fn tell(&mut self, values: Vec<f64>, seed: u64, label: String) -> PyResult<()> {
        let run = Trial { values, seed };
        self.check(&run, &label)?;
        self.open.retain(|open| *open != run);
        let is_told = self.told.iter().any(|(told, _)| *told == run);
        if !is_told && self.rounds.runs().label(&run).is_none() {
            self.told.push((run, label));
        }
        self.end = None;
        Ok(())
    }

    /// Why nothing more is asked: `budget`, `width` or `complete`; none before.
    #[getter]
    fn end(&self) -> Option<&'static str> {
        self.end.map(|end| match end {
            Finish::Budget => "budget",
            Finish::Width => "width",
            Finish::Complete => "complete",
        })
    }

    /// Number of runs that were told.
    #[getter]
    fn runs(&self) -> usize {
        self.rounds.runs().len() + self.told.len()
    }

    /// Names of the axes.
    #[getter]
    fn axes(&self) -> Vec<&str> {
        let axes = self.rounds.lattice().axes().iter();
        axes.map(LatticeAxis::name).collect()
    }

    /// The first seed of points.
    #[getter]
    fn first_seed(&self) -> u64 {
        self.rounds.settings().first_seed
    }

    /// Largest number of seeds of a point.
    #[getter]
    fn replicates(&self) -> u64 {
        self.rounds.settings().replicates
    }

    /// Probabilities of labels at all points.
    fn labels(&self, py: Python<'_>) -> PyResult<Table> {
        watched(py, None, |_| {
            let mut now = self.now()?;
            let map = now.rounds.map().map_err(refused)?.clone();
            Ok(now.table_of(&map))
        })
    }

    /// Where labels change along an axis.
    fn borders(&self, py: Python<'_>, axis: &str) -> PyResult<Table> {
        let own = self.axes();
        let Some(place) = own.iter().position(|own| *own == axis) else {
            let refused = Failure::refused(format_args!("there is no axis `{axis}`"));
            return Err(refused.help(format!("those are {}", own.join(", "))).into());
        };
        watched(py, None, |_| {
            let mut now = self.now()?;
            let map = now.rounds.map().map_err(refused)?.clone();
            let borders = Borders::new(now.rounds.lattice(), &map, place);
            Ok(now.table_of_borders(&borders.map_err(refused)?))
        })
    }
}

/// Refuses a budget that the coarse grid alone exceeds.
fn check_budget(lattice: &Lattice, settings: &Settings) -> Result<(), Failure> {
    let generous = Settings {
        budget: usize::MAX,
        ..settings.clone()
    };
    let first = Rounds::new(lattice.clone(), generous).and_then(|mut it| it.next_round());
    let Round::Runs(coarse) = first.map_err(refused)? else {
        return Ok(());
    };
    let (coarse, budget) = (coarse.len(), settings.budget);
    match coarse > budget {
        false => Ok(()),
        true => Err(Failure::refused(format_args!(
            "the coarse grid alone has {coarse} points, not {budget}"
        ))
        .help(format!(
            "use `budget` = {coarse} or more, or a smaller `start`"
        ))),
    }
}

fn refused(error: RefineError) -> Failure {
    Failure::refused(error)
}

fn learn_all(rounds: &mut Rounds, runs: &Observations) -> Result<(), RefineError> {
    for (run, _) in runs.iter() {
        if let Some(found) = runs.found(run) {
            rounds.learn(run.clone(), found.clone())?;
        }
    }
    Ok(())
}

impl Refinement {
    fn of(rounds: Rounds, names: Vec<(Code, String)>, sweep: Option<Sweep>) -> Self {
        Self {
            rounds,
            names,
            open: Vec::new(),
            told: Vec::new(),
            end: None,
            sweep,
        }
    }

    fn next_batch(&mut self) -> Result<Vec<Trial>, Failure> {
        if self.open.is_empty() && self.end.is_none() {
            self.learn()?;
            match self.rounds.next_round().map_err(refused)? {
                Round::Runs(runs) => self.open = runs,
                Round::Finished(end) => self.end = Some(end),
            }
        }
        Ok(self.open.clone())
    }

    /// Learns what was told. New labels get their codes in the order of their names, so that no bit
    /// depends on the order in which runs are told.
    fn learn(&mut self) -> Result<(), Failure> {
        let mut new: Vec<&String> = self.told.iter().map(|(_, label)| label).collect();
        new.retain(|label| self.code(label).is_none());
        new.sort_unstable();
        new.dedup();
        let new: Vec<String> = new.into_iter().cloned().collect();
        for label in new {
            let code = self.free_code()?;
            self.names.push((code, label));
        }
        for (run, label) in std::mem::take(&mut self.told) {
            if let Some(code) = self.code(&label) {
                self.rounds.learn(run, code).map_err(refused)?;
            }
        }
        Ok(())
    }

    /// The smallest code that no label has.
    fn free_code(&self) -> Result<Code, Failure> {
        let is_free = |code: &Code| self.names.iter().all(|(own, _)| own != code);
        let mut codes = (0..=Code::MAX).take(MOST_LABELS);
        codes.find(is_free).ok_or_else(|| {
            Failure::refused(format_args!("there are more than {MOST_LABELS} labels"))
                .help("a label is one of few states; put numbers into classes")
        })
    }

    /// What would be learnt now, without an effect on the next batch.
    fn now(&self) -> Result<Self, Failure> {
        let mut now = Self {
            rounds: self.rounds.clone(),
            names: self.names.clone(),
            open: Vec::new(),
            told: self.told.clone(),
            end: None,
            sweep: self.sweep.clone(),
        };
        now.learn()?;
        if now.rounds.runs().is_empty() {
            return Err(Failure::refused("there are no labels to learn from")
                .help("ask for points, and tell their labels"));
        }
        Ok(now)
    }

    /// Refuses a run that lies on no point, or is known with another label.
    fn check(&self, run: &Trial, label: &str) -> Result<(), Failure> {
        let lattice = self.rounds.lattice();
        if run.values.len() != lattice.axes().len() || lattice.place_of(&run.values).is_none() {
            let message = format!("{:?} is no point of the axes", run.values);
            return Err(Failure::refused(message).help("tell points as `ask` gives them"));
        }
        let mut told = self.told.iter();
        let told = told
            .find(|(other, _)| other == run)
            .map(|(_, label)| label.as_str());
        let learnt = self.rounds.runs().label(run).map(|code| self.name(code));
        match told.or(learnt).filter(|known| *known != label) {
            None => Ok(()),
            Some(known) => Err(Failure::refused(format_args!(
                "{:?} has the label `{known}` already, not `{label}`",
                run.values
            ))
            .help("for labels that are left to chance set `replicates`, and use the seed")),
        }
    }

    fn code(&self, label: &str) -> Option<Code> {
        let mut names = self.names.iter();
        names.find(|(_, name)| name == label).map(|(code, _)| *code)
    }

    fn name(&self, code: Code) -> &str {
        let mut names = self.names.iter();
        names
            .find(|(own, _)| *own == code)
            .map_or("", |(_, name)| name)
    }

    /// The most probable label, the probability of each, and the number of runs at all points.
    fn table_of(&self, map: &ProbabilityMap) -> Table {
        let lattice = self.rounds.lattice();
        let axes = lattice.axes().iter();
        let dimensions: Vec<_> = axes
            .map(|axis| (axis.name(), axis.values().len()))
            .collect();
        let places = 0..map.places();
        let variable = |name: &str, values| Variable::new(name, &dimensions, values);
        let label = |place| self.name(map.label(place)).to_owned();
        let label = variable("label", Values::Text(places.clone().map(label).collect()));
        let mut variables = vec![label.with("long_name", "Most probable label")];
        for (column, code) in map.codes().iter().enumerate() {
            let name = self.name(*code);
            let values = places.clone().map(|place| map.at(place)[column]).collect();
            let variable = variable(&format!("p_{name}"), Values::Double(values));
            variables.push(variable.of("1", &format!("Probability of the label {name}")));
        }
        let mut counts = vec![0; map.places()];
        for (run, _) in self.rounds.runs().iter() {
            if let Some(place) = lattice.place_of(&run.values) {
                counts[place] += 1;
            }
        }
        let runs = variable("runs", Values::Integer(counts));
        variables.push(runs.of("1", "Number of runs that were made"));
        Table {
            variables,
            coordinates: self.coordinates(),
            ..Table::default()
        }
    }

    fn coordinates(&self) -> Vec<Variable> {
        if let Some(sweep) = &self.sweep {
            return sweep
                .axes
                .iter()
                .map(|axis| coordinate_of(axis, sweep))
                .collect();
        }
        let axes = self.rounds.lattice().axes().iter();
        let plain = axes
            .map(|axis| Variable::coordinate(axis.name(), Values::Double(axis.values().to_vec())));
        plain.collect()
    }

    /// The borders with their bands, as in `borders.csv`.
    fn table_of_borders(&self, borders: &Borders) -> Table {
        let crossings = &borders.crossings;
        let dimension = [("crossing", crossings.len())];
        let variable = |name: &str, values| Variable::new(name, &dimension, values);
        let axes = self.rounds.lattice().axes();
        let places = axes.iter().enumerate().map(|(place, axis)| {
            let values = crossings.iter().map(|it| it.values[place]).collect();
            variable(axis.name(), Values::Double(values))
        });
        let mut variables: Vec<Variable> = places.collect();
        for (side, name) in ["below", "above"].into_iter().enumerate() {
            let labels = crossings
                .iter()
                .map(|it| self.name(it.labels[side]).to_owned());
            let description = format!("Label {name} the border");
            let labels = variable(name, Values::Text(labels.collect()));
            variables.push(labels.with("long_name", description.as_str()));
        }
        for (end, band) in ["low", "high"].into_iter().enumerate() {
            let of_68 = crossings.iter().map(|it| it.band68[end]).collect();
            let of_95 = crossings.iter().map(|it| it.band95[end]).collect();
            for (share, values) in [("68", of_68), ("95", of_95)] {
                let description = format!("The {band} end of the interval of {share} %");
                let ends = variable(&format!("{band}_{share}"), Values::Double(values));
                variables.push(ends.with("long_name", description.as_str()));
            }
        }
        let widths = Values::Double(crossings.iter().map(|it| it.width).collect());
        let widths = variable("width_95", widths);
        variables.push(widths.of("1", "Length of the interval of 95 % as a share of the axis"));
        let along = axes[borders.axis].name();
        Table {
            variables,
            coordinates: Vec::new(),
            attributes: vec![("along", Attribute::from(along))],
        }
    }
}
