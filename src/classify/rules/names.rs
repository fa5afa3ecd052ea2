//! What rules may name: the columns of a run and the numbers of its scene.

use crate::observe::Observations;
use crate::record::RunRecord;
use crate::rule::{Names, Unit, Values};
use crate::scene::{ExternalProgram, Notation, Scene};
use std::borrow::Cow;

/// The names that the rules for runs of a scene may use.
pub(super) struct SceneNames<'a> {
    scene: &'a Scene,
}

/// Columns that models declare for themselves, with their units.
const OF_MODELS: [(&str, &str); 1] = [("spots", "1")];

impl<'a> SceneNames<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self { scene }
    }

    /// Names and units of the columns that its runs may have.
    fn columns(&self) -> impl Iterator<Item = (&'a str, &'a str)> {
        let program = self.scene.program.as_ref();
        let of_program = program.into_iter().flat_map(ExternalProgram::columns);
        let of_program = of_program.map(|column| (column.name(), column.unit()));
        let of_spheres = Observations::COLUMNS.iter();
        let of_spheres = of_spheres.map(|column| (column.name, column.unit));
        let has_spheres = program.is_none();
        let of_models = of_spheres.chain(OF_MODELS).filter(move |_| has_spheres);
        of_program.chain(of_models)
    }
}

impl Names for SceneNames<'_> {
    fn column(&self, name: &str) -> Option<Unit> {
        let unit = self.columns().find(|column| column.0 == name)?.1;
        Unit::parse(unit).ok()
    }

    fn key(&self, path: &str) -> Option<Unit> {
        self.scene.number(path)?;
        let own = self.scene.is_external().then(|| self.scene.notation(path));
        let notation = own.unwrap_or_else(|| Notation::anywhere(path));
        Unit::parse(notation.map_or("", |it| it.unit)).ok()
    }

    fn time(&self) -> Unit {
        let unit = self.scene.unit_of_time();
        Unit::parse(unit).unwrap_or(Unit::ONE)
    }

    fn suggestions(&self) -> Vec<String> {
        let columns = self.columns().map(|column| column.0.to_owned());
        columns.chain(self.scene.numeric_keys()).collect()
    }
}

/// The values of a run.
pub(super) struct RunValues<'a> {
    record: &'a RunRecord,
}

impl<'a> RunValues<'a> {
    pub(super) fn new(record: &'a RunRecord) -> Self {
        Self { record }
    }

    /// Whether the record has a column, with a value in each frame.
    pub(super) fn has(&self, name: &str) -> bool {
        let frames = self.record.observations.frames();
        let own = self.record.observations.scalars();
        name == "time"
            || own
                .iter()
                .any(|it| it.name == name && it.values.len() == frames)
    }
}

impl Values for RunValues<'_> {
    fn time(&self) -> &[f64] {
        &self.record.observations.time
    }

    fn column(&self, name: &str) -> Cow<'_, [f64]> {
        let series = self.record.observations.scalars();
        let own = series.into_iter().find(|it| it.name == name);
        let values = own.map_or(&[][..], |it| it.values);
        values.iter().map(|&it| f64::from(it)).collect()
    }

    fn key(&self, path: &str) -> f64 {
        self.record.scene.number(path).unwrap_or(f64::NAN)
    }
}
