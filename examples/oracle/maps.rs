//! Maps that have been published as tables of labels.

use super::replay::Oracle;
use phase::refine::{AxisScale, Code, Lattice, LatticeAxis, RefineError, Trial};
use std::path::{Path, PathBuf};

/// Why a published map cannot be read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MapError {
    /// The file is no table.
    #[error("{}: {source}", path.display())]
    Table { path: PathBuf, source: csv::Error },
    /// A column is missing, or a cell does not hold a number.
    #[error("{}: {reason}", path.display())]
    Content { path: PathBuf, reason: String },
    /// The table is no whole grid.
    #[error(transparent)]
    Grid(#[from] RefineError),
}

/// All runs of a full map: the label of each place and seed.
#[derive(Clone, Debug)]
pub(crate) struct PublishedMap {
    lattice: Lattice,
    /// Seeds and labels of each place, by seed.
    labels: Vec<Vec<(u64, Code)>>,
}

impl PublishedMap {
    /// A map from a function of place and seed.
    pub(crate) fn from_formula(
        lattice: Lattice,
        seeds: std::ops::RangeInclusive<u64>,
        label: impl Fn(&[f64], u64) -> Code,
    ) -> Self {
        let labels = (0..lattice.places()).map(|place| {
            let values = lattice.values(place);
            let seeds = seeds.clone();
            seeds.map(|seed| (seed, label(&values, seed))).collect()
        });
        Self {
            labels: labels.collect(),
            lattice,
        }
    }

    /// Reads the table `labels.csv` of a sweep: the columns between `id` and `seed` are axes, and
    /// `code` is the label. Axes have equal distances between neighbouring values.
    ///
    /// # Errors
    /// If the file cannot be read, lacks one of the columns, or holds something else than numbers
    /// in them; if not all combinations of the values have labels.
    pub(crate) fn read(path: &Path) -> Result<Self, MapError> {
        let table = |source| MapError::Table {
            path: path.to_owned(),
            source,
        };
        let content = |reason| MapError::Content {
            path: path.to_owned(),
            reason,
        };
        let mut reader = csv::Reader::from_path(path).map_err(table)?;
        let headers = reader.headers().map_err(table)?.clone();
        let column = |column: &'static str| {
            let place = headers.iter().position(|name| name == column);
            place.ok_or_else(|| content(format!("no column `{column}`")))
        };
        let (id, seed, code) = (column("id")?, column("seed")?, column("code")?);
        let axes = id + 1..seed;
        let mut rows: Vec<(Trial, Code)> = Vec::new();
        for (row, record) in reader.records().enumerate() {
            let record = record.map_err(table)?;
            let text = |column: usize| record.get(column).unwrap_or_default();
            let bad = |column: usize| {
                let text = text(column);
                content(format!("row {}: `{text}` is not a number", row + 1))
            };
            let values = axes.clone().map(|at| text(at).parse().map_err(|_| bad(at)));
            let run = Trial {
                values: values.collect::<Result<_, _>>()?,
                seed: text(seed).parse().map_err(|_| bad(seed))?,
            };
            rows.push((run, text(code).parse().map_err(|_| bad(code))?));
        }
        let names: Vec<&str> = axes.map(|at| &headers[at]).collect();
        Ok(Self::from_rows(&names, rows)?)
    }

    fn from_rows(names: &[&str], rows: Vec<(Trial, Code)>) -> Result<Self, RefineError> {
        let axes = names.iter().enumerate().map(|(axis, name)| {
            let mut values: Vec<f64> = rows.iter().map(|(run, _)| run.values[axis]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            LatticeAxis::new(name, values, AxisScale::Rank)
        });
        let lattice = Lattice::new(axes.collect::<Result<_, _>>()?)?;
        let labels = vec![Vec::new(); lattice.places()];
        let mut map = Self { lattice, labels };
        for (run, code) in rows {
            let place = map.place(&run.values);
            map.labels[place].push((run.seed, code));
        }
        for (place, labels) in map.labels.iter_mut().enumerate() {
            labels.sort_unstable();
            if labels.is_empty() {
                let values = map.lattice.values(place);
                return Err(RefineError::place(&values, names.len()));
            }
        }
        Ok(map)
    }

    /// The axes and places.
    pub(crate) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The place of these values, which must be values of the axes.
    pub(crate) fn place(&self, values: &[f64]) -> usize {
        let axes = self.lattice.axes().iter().zip(values);
        let indices: Vec<usize> = axes
            .map(|(axis, value)| axis.values().partition_point(|other| other < value))
            .collect();
        self.lattice.place(&indices)
    }

    /// Seeds and labels of a place.
    pub(crate) fn at(&self, place: usize) -> &[(u64, Code)] {
        &self.labels[place]
    }

    /// The label of most seeds of a place; of equals the one that comes first by seed.
    pub(crate) fn label(&self, place: usize) -> Code {
        let at = &self.labels[place];
        let count = |code: Code| at.iter().filter(|(_, other)| *other == code).count();
        let mut best = at[0].1;
        for (_, code) in at {
            if count(*code) > count(best) {
                best = *code;
            }
        }
        best
    }
}

impl Oracle for PublishedMap {
    fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    fn label(&self, run: &Trial) -> Code {
        let at = &self.labels[self.place(&run.values)];
        // Seeds that the map does not have show what its first seed does.
        let own = at.iter().find(|(seed, _)| *seed == run.seed);
        own.unwrap_or(&at[0]).1
    }
}
