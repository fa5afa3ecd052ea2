//! What rules may name: the columns of a run and the numbers of its scene.

use crate::classify::{Family, Measure};
use crate::observe::Observations;
use crate::record::RunRecord;
use crate::rule::{Names, Unit, Values};
use crate::scene::{ExternalProgram, FurtherColumn, Notation, Scene};
use std::borrow::Cow;

/// The names that the rules for runs of a scene may use.
pub(super) struct SceneNames<'a> {
    scene: &'a Scene,
    /// Whether columns that its runs cannot have are no names.
    strict: bool,
}

/// Columns that models declare for themselves, with their units.
const OF_MODELS: [(&str, &str); 1] = [("spots", "1")];

impl<'a> SceneNames<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        Self {
            scene,
            strict: false,
        }
    }

    /// The same without the columns that runs of the scene cannot have.
    pub(super) fn strict(scene: &'a Scene) -> Self {
        Self {
            scene,
            strict: true,
        }
    }

    /// Whether a name is what the sieves of the scene measure of a run.
    pub(super) fn is_measure(&self, name: &str) -> bool {
        self.measure(name).is_some()
    }

    fn measure(&self, name: &str) -> Option<&'static Measure> {
        let mut measures = Family::of(self.scene).measures_of_sieves();
        measures.find(|measure| measure.name == name)
    }

    /// The unit of the column of that name of a profile.
    fn of_profile(&self, name: &str) -> Option<&'static str> {
        let mut profiles = self.scene.output.profiles.iter();
        let found = profiles.find(|profile| profile.columns().any(|it| it == name))?;
        Some(found.of.unit())
    }

    /// The unit of the column of that name of a wall.
    fn of_wall(&self, name: &str) -> Option<&'static str> {
        let mut columns = self.scene.wall_columns();
        let found = columns.find(|column| column.name == name)?;
        Some(found.unit)
    }

    /// Names and units of the columns that its runs may have.
    fn columns(&self) -> impl Iterator<Item = (&'a str, &'a str)> {
        let program = self.scene.program.as_ref();
        let of_program = program.into_iter().flat_map(ExternalProgram::columns);
        let of_program = of_program.map(|column| (column.name(), column.unit()));
        let of_spheres = Observations::COLUMNS.iter();
        let of_spheres = of_spheres.map(|column| (column.name, column.unit));
        let further = FurtherColumn::ALL.iter();
        let further = further.map(|column| (column.name(), column.unit()));
        let of_models = of_spheres.chain(OF_MODELS).chain(further);
        let has_spheres = program.is_none();
        of_program.chain(of_models.filter(move |_| has_spheres))
    }
}

impl Names for SceneNames<'_> {
    fn column(&self, name: &str) -> Option<Unit> {
        if self.strict && self.absent(name).is_some() {
            return None;
        }
        let own = self.columns().find(|column| column.0 == name);
        let unit = own.map(|column| column.1);
        let unit = unit.or_else(|| self.of_profile(name));
        Unit::parse(unit.or_else(|| self.of_wall(name))?).ok()
    }

    fn key(&self, path: &str) -> Option<Unit> {
        if let Some(measure) = self.measure(path) {
            let counted = measure.unit.replace("grains", "1").replace("spheres", "1");
            return Unit::parse(&counted).ok();
        }
        number(self.scene, path)?;
        let own = self.scene.is_external().then(|| self.scene.notation(path));
        let notation = own.unwrap_or_else(|| Notation::anywhere(path));
        Unit::parse(notation.map_or("", |it| it.unit)).ok()
    }

    fn time(&self) -> Unit {
        let unit = self.scene.unit_of_time();
        Unit::parse(unit).unwrap_or(Unit::ONE)
    }

    fn absent(&self, name: &str) -> Option<String> {
        if self.scene.is_external() {
            return None;
        }
        let further = FurtherColumn::of_name(name);
        let why = match further {
            Some(column) if column.is_usual_in(self.scene) => None,
            Some(column) => column.absent_in(self.scene),
            None if !self.scene.output.walls && self.of_wall(name).is_some() => {
                Some("forces on walls are recorded only with `output.walls = true`")
            }
            None => Observations::absent_in(self.scene, name),
        };
        why.map(str::to_owned)
    }

    fn suggestions(&self) -> Vec<String> {
        let columns = self.columns();
        let columns = columns.filter(|column| !self.strict || self.absent(column.0).is_none());
        let columns = columns.map(|column| column.0.to_owned());
        let measures = Family::of(self.scene).measures_of_sieves();
        let measures = measures.map(|measure| measure.name.to_owned());
        let profiles = self.scene.output.profiles.iter();
        let bins = profiles.flat_map(|profile| profile.columns());
        let walls = self.scene.wall_columns().map(|column| column.name);
        let walls = walls.filter(|_| self.scene.output.walls);
        let names = columns.chain(bins).chain(walls).chain(measures);
        names.chain(self.scene.numeric_keys()).collect()
    }
}

/// The number of a key, or pi. The number of `spheres.radius` is the mean of radii that differ.
fn number(scene: &Scene, path: &str) -> Option<f64> {
    match path {
        "pi" => Some(std::f64::consts::PI),
        "spheres.radius" if !scene.is_external() => Some(scene.spheres.radius.mean()),
        path => scene.number(path),
    }
}

/// The values of a run.
pub(super) struct RunValues<'a> {
    record: &'a RunRecord,
    /// What the sieves of its scene measured, in their order; empty if no rule reads it.
    measures: &'a [Option<f64>],
}

impl<'a> RunValues<'a> {
    pub(super) fn new(record: &'a RunRecord, measures: &'a [Option<f64>]) -> Self {
        Self { record, measures }
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
        let mut measures = Family::of(&self.record.scene).measures_of_sieves();
        let value = match measures.position(|measure| measure.name == path) {
            Some(place) => self.measures.get(place).copied().flatten(),
            None => number(&self.record.scene, path),
        };
        value.unwrap_or(f64::NAN)
    }
}
