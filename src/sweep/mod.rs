//! Sweeps: the jobs of a grid, who runs them, and their results folder.

mod access;
mod backend;
mod dumps;
mod failure;
mod failures;
mod folder;
mod job;
mod labelling;
mod load;
mod merge;
mod names;
mod next;
mod plan;
mod pool;
mod records;
mod refining;
mod relabelled;
mod select;
mod shard;
mod status;
mod study;
pub mod work;

pub use crate::document::differing_keys;
pub use access::Access;
pub use backend::{
    Backend, BackendError, Batch, Begin, Claim, Event, Halt, LocalThreads, Permit, Report, Results,
    Wishes,
};
pub use dumps::{DumpScene, find_dumps};
pub use failure::Failure;
pub use failures::read_failures;
pub use folder::{Folder, FolderError};
pub use job::Job;
pub use labelling::{
    Labelled, Labelling, LabellingError, Since, WithoutRoom, refuse_to_lose_labels,
};
pub(crate) use load::{SWEEP, of_document};
pub use load::{from_str, load};
pub use merge::Taken;
pub use names::{NamePattern, NamedRun};
pub use next::NextJobs;
pub use plan::{Done, ForeignRecord, Plan, PlanError, Standing};
pub use pool::{Pool, PoolError};
pub use refining::{
    FAILED, Learnt, Refined, Refinement, RefinementError, Refining, RoundsError, Step, WatchRounds,
    label_name,
};
pub use select::{SelectError, Selection, parse_point};
pub use shard::{ForeignShard, Shard};
pub use status::{Claimed, Status, UnderWay};
pub use study::StudyRuns;
pub(crate) use study::{RunScenes, fit_frames, output_of_balance};

use crate::classify::{Family, Sieves};
use crate::grid::{Axis, Variant, variant_at};
use crate::refine::Settings;
use crate::scene::{Scene, Units};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sweep, fully resolved: what is asked for. The results folder keeps it as `sweep.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Free text, the title of figures.
    pub title: Option<String>,
    /// The scene that every job starts from, before its axes' values are put in.
    #[serde(deserialize_with = "Scene::by_tree")]
    pub scene: Scene,
    /// Up to four axes, that of variants among them. The first varies slowest.
    pub axes: Vec<Axis>,
    /// Seeds; each point of the grid runs once per seed.
    pub seeds: Vec<u64>,
    /// How it is refined, if not the whole grid is run: its `seeds` are then those that a point
    /// may have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refine: Option<Settings>,
    /// How its points become runs, if it is the sweep of a study.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub study: Option<StudyRuns>,
    /// Thresholds of the sieves.
    pub sieves: Sieves,
    /// What the phase diagram shows.
    pub plot: PlotSettings,
}

impl Sweep {
    /// The family of its runs, with the rules of the file.
    pub fn family(&self) -> &'static Family {
        self.sieves.family(&self.scene)
    }

    /// Its scene and the scenes of its variants.
    pub fn scenes_mut(&mut self) -> impl Iterator<Item = &mut Scene> {
        let variants = self.axes.iter_mut().flat_map(|axis| &mut axis.variants);
        let of_variants = variants.map(|variant| &mut variant.scene);
        of_variants.chain([&mut self.scene])
    }

    /// The sweep of just one scene.
    pub fn of_scene(scene: Scene) -> Self {
        Self {
            title: None,
            axes: Vec::new(),
            seeds: vec![scene.seed],
            refine: None,
            study: None,
            scene,
            sieves: Sieves::default(),
            plot: PlotSettings::default(),
        }
    }

    /// Names of the variants; empty without that axis.
    pub fn variants(&self) -> Vec<String> {
        let variants = self.axes.iter().flat_map(|axis| &axis.variants);
        variants.map(|variant| variant.name.clone()).collect()
    }

    /// A variant, by its place.
    pub fn variant(&self, place: f64) -> Option<&Variant> {
        self.axes.iter().find_map(|axis| axis.variant(place))
    }

    /// The scene of a variant, by its place; without one that from which all points start.
    pub fn scene_of_variant(&self, place: Option<f64>) -> &Scene {
        let variant = place.and_then(|place| self.variant(place));
        variant.map_or(&self.scene, |variant| &variant.scene)
    }

    /// The scene from which a point starts, before its values are put in.
    pub fn start_of(&self, values: &[f64]) -> &Scene {
        variant_at(&self.axes, values).map_or(&self.scene, |variant| &variant.scene)
    }

    /// The scenes from which points start: those of the variants, or the one that all have.
    pub fn scenes(&self) -> Vec<&Scene> {
        let variants = self.axes.iter().flat_map(|axis| &axis.variants);
        match variants.map(|variant| &variant.scene).collect::<Vec<_>>() {
            scenes if scenes.is_empty() => vec![&self.scene],
            scenes => scenes,
        }
    }

    /// The factors on the values of an axis, by its name: of each variant, or 1 alone.
    pub fn factors(&self, axis: &str) -> Vec<f64> {
        let variants = self.axes.iter().flat_map(|axis| &axis.variants);
        match variants.map(|it| it.factor(axis)).collect::<Vec<_>>() {
            factors if factors.is_empty() => vec![1.0],
            factors => factors,
        }
    }

    /// The units in which all its scenes are best read.
    pub fn units(&self) -> Units {
        let mut units = self.scenes().into_iter().map(Scene::units);
        let first = units.next().unwrap_or(Units::Si);
        match units.all(|other| other == first) {
            true => first,
            false => Units::Si,
        }
    }

    /// The sweep of a scene that takes no time, to test with.
    #[cfg(test)]
    fn of_falling_sphere() -> Self {
        let scene = r#"
            spheres = { count = 1, radius = 0.004, density = 1000.0 }
            start = { kind = "list", spheres = [{ position = [0.0, 0.0, 1.0] }] }
            gravity = { acceleration = 9.8 }
            time = { dt = 1e-3, duration = 0.01, frame_interval = 1e-3 }
        "#;
        Self::of_scene(toml::from_str(scene).unwrap())
    }
}

/// What the phase diagram shows.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlotSettings {
    /// Name of the horizontal axis (default: the first axis).
    pub x: Option<String>,
    /// Name of the vertical axis (default: the second axis).
    pub y: Option<String>,
    /// Name of the axis of small multiples (default: the third axis, if any).
    pub panels: Option<String>,
    /// Names of the axes whose values stand at equal distances in figures, whatever they are
    /// (default: none; values stand at distances of their differences, or of their ratios where
    /// these are more even).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub equal_steps: Vec<String>,
}
