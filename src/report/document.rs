//! The document of a page: `page/README.md` says what each field means.

use crate::classify::{Measure, MeasureRange};
use crate::record::Program;
use crate::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// All that a page holds.
#[derive(Clone, Debug, Serialize)]
pub struct PageDocument {
    format: &'static str,
    format_version: u32,
    pub(super) title: String,
    program: ProgramEntry,
    commands: Vec<CommandEntry>,
    sections: Vec<Section>,
}

#[derive(Clone, Debug, Serialize)]
struct ProgramEntry {
    name: &'static str,
    version: String,
    commit: String,
}

/// A command, and what it is for.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CommandEntry {
    purpose: String,
    line: String,
}

/// A part of a page.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Section {
    /// A sweep, or where integrators are stable.
    Sweep(Box<SweepSection>),
    /// Records beside each other.
    Records(RecordsSection),
    /// What accuracy costs.
    Accuracy(AccuracySection),
    /// Which effects decide.
    Ablation(AblationSection),
}

impl PageDocument {
    /// A page of this title, with commands by their purposes.
    pub fn new(title: String, commands: Vec<(String, String)>, sections: Vec<Section>) -> Self {
        let program = Program::current();
        let commands = commands.into_iter();
        Self {
            format: "phase report",
            format_version: 1,
            title,
            program: ProgramEntry {
                name: "phase",
                version: program.version,
                commit: program.commit,
            },
            commands: commands
                .map(|(purpose, line)| CommandEntry { purpose, line })
                .collect(),
            sections,
        }
    }
}

impl SweepSection {
    /// Its title.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// How much of the page its animations take (bytes).
    pub fn bytes_of_animations(&self) -> usize {
        bytes(&self.states)
    }

    /// How many runs are animated.
    pub fn animations(&self) -> usize {
        self.states.len()
    }
}

impl RecordsSection {
    /// How much of the page its animations take (bytes).
    pub fn bytes_of_animations(&self) -> usize {
        bytes(&self.states)
    }

    /// How many runs are animated.
    pub fn animations(&self) -> usize {
        self.states.len()
    }
}

fn bytes(states: &[StatesEntry]) -> usize {
    serde_json::to_string(states).map_or(0, |text| text.len())
}

/// A sweep on a page.
#[derive(Clone, Debug, Default, Serialize)]
pub struct SweepSection {
    pub(super) title: String,
    pub(super) axes: Vec<AxisOfPage>,
    pub(super) labels: Vec<LabelEntry>,
    pub(super) runs: RunColumns,
    pub(super) measures: Vec<MeasureEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) rules: Option<RulesEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) lattice: Option<LatticeEntry>,
    pub(super) curves: Vec<CurveEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) series: Option<SeriesEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) states: Vec<StatesEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) scene: Option<SceneEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) command: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) failed: Option<FailedColumns>,
    pub(super) view: ViewEntry,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) notes: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct AxisOfPage {
    pub(super) name: String,
    pub(super) key: String,
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) values: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) shown: Option<ShownEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) words: Vec<String>,
    pub(super) spacing: &'static str,
    /// What each value sets or leaves out (`null`), by keys.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) changes: Vec<Vec<(String, Option<String>)>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct ShownEntry {
    pub(super) factor: f64,
    pub(super) quantity: String,
    pub(super) unit: String,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LabelEntry {
    pub(super) name: &'static str,
    pub(super) code: i8,
    pub(super) color: String,
    pub(super) hatched: bool,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct RunColumns {
    pub(super) label: Vec<usize>,
    pub(super) places: Vec<Vec<usize>>,
    pub(super) seed: Vec<serde_json::Value>,
    pub(super) id: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) steady: Vec<Option<u8>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct MeasureEntry {
    pub(super) name: &'static str,
    pub(super) quantity: &'static str,
    pub(super) unit: &'static str,
    pub(super) description: &'static str,
    pub(super) range: &'static str,
    pub(super) is_evidence: bool,
    pub(super) values: Vec<Option<f64>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct RulesEntry {
    pub(super) list: Vec<RuleEntry>,
    pub(super) otherwise: usize,
    pub(super) fixed: Vec<usize>,
    pub(super) thresholds: Vec<ThresholdEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) not_movable: Vec<NotMovable>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct RuleEntry {
    pub(super) label: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) stored: Option<Vec<u8>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) comparisons: Vec<ComparisonEntry>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct ComparisonEntry {
    #[serde(flatten)]
    pub(super) side: SideEntry,
    pub(super) order: &'static str,
    /// A number, or the key of a threshold.
    pub(super) threshold: serde_json::Value,
}

/// What a comparison has on its left.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum SideEntry {
    Measure { measure: String },
    By { name: String, by: ColumnsByStop },
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct ColumnsByStop {
    pub(super) key: String,
    pub(super) columns: Vec<Vec<Option<f64>>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct ThresholdEntry {
    pub(super) key: String,
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) value: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) is_whole: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) stops: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) toml: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct NotMovable {
    pub(super) key: String,
    pub(super) value: String,
    pub(super) why: String,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LatticeEntry {
    pub(super) label: Vec<usize>,
    pub(super) certainty: Vec<f64>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct CurveEntry {
    pub(super) kind: &'static str,
    pub(super) name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) level: Option<u8>,
    pub(super) x: usize,
    pub(super) y: usize,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) slice: BTreeMap<usize, usize>,
    pub(super) pieces: Vec<Vec<f64>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct SeriesEntry {
    pub(super) columns: Vec<ColumnEntry>,
    pub(super) runs: Vec<usize>,
    pub(super) points: usize,
    pub(super) times: Vec<[f64; 2]>,
    pub(super) frames: Vec<usize>,
    pub(super) width: u32,
    pub(super) ranges: Vec<f64>,
    pub(super) data: String,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct ColumnEntry {
    pub(super) name: String,
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) description: String,
    pub(super) is_usual: bool,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct StatesEntry {
    pub(super) run: usize,
    pub(super) times: Vec<f64>,
    pub(super) count: usize,
    pub(super) radii: RadiiEntry,
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    pub(super) is_flat: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) walls: Option<WallsEntry>,
    pub(super) data: String,
}

/// Radii of spheres: one of all, or one of each.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum RadiiEntry {
    One(f64),
    Each(Vec<f64>),
}

#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(super) enum WallsEntry {
    Tank { radius: f64, floor: f64 },
    Segments { segments: Vec<[f64; 4]> },
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct SceneEntry {
    pub(super) text: String,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct FailedColumns {
    pub(super) places: Vec<Vec<usize>>,
    pub(super) seed: Vec<serde_json::Value>,
    pub(super) message: Vec<String>,
}

#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct ViewEntry {
    pub(super) x: usize,
    pub(super) y: i64,
}

impl SceneEntry {
    /// A scene as its file would have it.
    pub(super) fn of(scene: &Scene) -> Option<Self> {
        let text = toml::to_string(scene).ok()?;
        Some(Self { text })
    }
}

impl MeasureEntry {
    /// A measure with its value for each run.
    pub(super) fn new(measure: &Measure, values: Vec<Option<f64>>) -> Self {
        let finite = |value: Option<f64>| value.filter(|it| it.is_finite());
        Self {
            name: measure.name,
            quantity: measure.quantity,
            unit: measure.unit,
            description: measure.description,
            range: match measure.range {
                MeasureRange::Any => "any",
                MeasureRange::Signed => "signed",
                MeasureRange::Share => "share",
                MeasureRange::Part => "part",
            },
            is_evidence: measure.is_evidence,
            values: values.into_iter().map(finite).collect(),
        }
    }
}

/// Records on a page.
#[derive(Clone, Debug, Serialize)]
pub struct RecordsSection {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) title: Option<String>,
    pub(super) records: Vec<RecordEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) series: Option<SeriesEntry>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) states: Vec<StatesEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) scene: Option<SceneEntry>,
    pub(super) quantities: Vec<QuantityEntry>,
    pub(super) charts: Vec<ChartEntry>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct RecordEntry {
    pub(super) name: String,
    pub(super) notes: Vec<String>,
    pub(super) changes: Vec<(String, Option<String>)>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct QuantityEntry {
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) values: Vec<Option<f64>>,
    pub(super) half_widths: Vec<Option<f64>>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct ChartEntry {
    pub(super) title: String,
    pub(super) x: QuantityWithUnit,
    pub(super) y: QuantityWithUnit,
    pub(super) lines: Vec<LineEntry>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct QuantityWithUnit {
    pub(super) quantity: String,
    pub(super) unit: String,
}

impl QuantityWithUnit {
    pub(super) fn new(quantity: &str, unit: &str) -> Self {
        Self {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
        }
    }
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LineEntry {
    pub(super) name: String,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
}

/// What accuracy costs, on a page.
#[derive(Clone, Debug, Serialize)]
pub struct AccuracySection {
    pub(super) title: String,
    pub(super) work: QuantityWithUnit,
    pub(super) error: QuantityWithUnit,
    pub(super) settings: Vec<SettingEntry>,
    pub(super) columns: Vec<FurtherColumn>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct SettingEntry {
    pub(super) name: String,
    pub(super) method: Option<String>,
    pub(super) work: f64,
    pub(super) error: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) low: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) high: Option<f64>,
    pub(super) is_base: bool,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct FurtherColumn {
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) values: Vec<Option<f64>>,
}

/// Which effects decide, on a page.
#[derive(Clone, Debug, Serialize)]
pub struct AblationSection {
    pub(super) title: String,
    pub(super) effects: Vec<EffectEntry>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct EffectEntry {
    pub(super) name: String,
    pub(super) verdict: String,
    pub(super) changed: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) time_ratio: f64,
}
