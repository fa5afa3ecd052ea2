//! How evidence becomes labels on a page: thresholds that may be moved where what is stored
//! decides.

use super::SweepResults;
use super::holes::HolesOfRuns;
use crate::classify::{DRAINAGE, Family, Label, LabelTable, SILO, Sieves, StoredRule, TANK};
use crate::report::codes::ends;
use crate::report::document::{
    ColumnsByStop, ComparisonEntry, NotMovable, RuleEntry, RulesEntry, SideEntry, ThresholdEntry,
};
use serde_json::Value;

/// Why most thresholds of sieves have no slider.
const OF_FRAMES: &str = "acts on the frames of a run, and the table of labels holds what follows \
                         from them; edit a copy of the sweep file, then `phase classify --sweep`";

/// The rules of a sweep; none where a page cannot tell which label follows from what is stored.
pub(super) fn rules(
    results: &SweepResults<'_>,
    labels: &[Label],
    holes: Option<HolesOfRuns>,
) -> Option<RulesEntry> {
    let SweepResults { sweep, table, .. } = results;
    let family = table.family;
    let place = |label: Label| labels.iter().position(|it| *it == label);
    let mut rules = RulesOfTable {
        table,
        entry: RulesEntry {
            list: Vec::new(),
            otherwise: place(family.otherwise()?)?,
            fixed: place(Label::UNSTABLE).into_iter().collect(),
            thresholds: Vec::new(),
            not_movable: Vec::new(),
        },
        place: &place,
    };
    let mut before = Vec::new();
    for rule in family.stored_rules(&sweep.scene) {
        rules.add_rule(&rule, &before)?;
        before.push(rule.label);
    }
    if family.is_labelled_by(&TANK) {
        rules.add_tank(&sweep.sieves, holes)?;
    } else if family.is_labelled_by(&SILO) {
        rules.add_silo(&sweep.sieves)?;
    } else if family.is_labelled_by(&DRAINAGE) {
        rules.add_drainage()?;
    } else if !family.has_rules_alone() {
        return None;
    }
    rules.tell_of_others(&sweep.sieves, family);
    (!rules.entry.thresholds.is_empty()).then_some(rules.entry)
}

/// Rules as they are read from a table.
struct RulesOfTable<'a> {
    table: &'a LabelTable,
    entry: RulesEntry,
    /// The place of a label among all.
    place: &'a dyn Fn(Label) -> Option<usize>,
}

impl RulesOfTable<'_> {
    /// A rule of the family: with a slider if it is one comparison with a number. None if the table
    /// does not tell whether it holds for a run.
    fn add_rule(&mut self, rule: &StoredRule, before: &[Label]) -> Option<()> {
        let Some(comparison) = &rule.comparison else {
            self.entry.not_movable.push(NotMovable {
                key: format!("label \"{}\"", rule.label.name),
                value: rule.when.to_owned(),
                why: "has several comparisons, of which the table holds one".to_owned(),
            });
            let rows = self.table.rows.iter();
            let stored = rows.map(|row| {
                let label = row.verdict.label;
                let margin = row.verdict.value(rule.margin);
                match margin {
                    _ if label == Label::UNSTABLE => Some(0),
                    // Had it held, it would have decided.
                    _ if !before.contains(&label) => Some(u8::from(label == rule.label)),
                    Some(margin) if margin != 0.0 => Some(u8::from(margin > 0.0)),
                    _ => None,
                }
            });
            let stored: Option<Vec<u8>> = stored.collect();
            return self.add(rule.label, Some(stored?), Vec::new());
        };
        let values = self.values(rule.value);
        let [low, high] = ends(&values);
        let key = format!("label.{}", rule.label.name);
        self.entry.thresholds.push(ThresholdEntry {
            quantity: format!("{}: {}", rule.label.name, rule.when),
            unit: comparison.unit.clone(),
            toml: Some(format!(
                "# [[label]] name = {}\nwhen = \"{} {} {{value}}\"\n",
                toml::Value::from(rule.label.name),
                comparison.left,
                comparison.order
            )),
            ..ThresholdEntry::new(&key, comparison.threshold, [low, high])
        });
        let compared = ComparisonEntry::of_measure(rule.value, comparison.order, Value::from(key));
        self.add(rule.label, None, vec![compared])
    }

    fn add(
        &mut self,
        label: Label,
        stored: Option<Vec<u8>>,
        comparisons: Vec<ComparisonEntry>,
    ) -> Option<()> {
        self.entry.list.push(RuleEntry {
            label: (self.place)(label)?,
            stored,
            comparisons,
        });
        Some(())
    }

    /// The sieves of a tank, of which the last that says yes decides.
    fn add_tank(&mut self, sieves: &Sieves, holes: Option<HolesOfRuns>) -> Option<()> {
        let spout = |order, threshold| ComparisonEntry::of_measure("spout_peak", order, threshold);
        let small = self.share(
            "sieves.spout.small",
            "small spout: rising spheres stay below this share",
            sieves.spout.small,
            0.0,
        );
        self.add(Label::SMALL_SPOUT, None, vec![spout("<", small.clone())])?;
        self.add(Label::LARGE_SPOUT, None, vec![spout(">=", small)])?;
        let pinned = self.share(
            "sieves.pinned.share",
            "pinned: least share of frames with a hole",
            sieves.pinned.share,
            self.least("pinned_share", sieves.pinned.share),
        );
        let side = match holes {
            None => SideEntry::Measure {
                measure: "pinned_share".to_owned(),
            },
            Some(holes) => self.by_holes(holes, sieves.pinned.hole),
        };
        let compared = ComparisonEntry {
            side,
            order: ">=",
            threshold: pinned,
        };
        self.add(Label::PINNED, None, vec![compared])?;
        let fluid = self.share(
            "sieves.fluid.share",
            "fluid: least share of frames with a fluid's surface",
            sieves.fluid.share,
            self.least("fluid_share", sieves.fluid.share),
        );
        let compared = ComparisonEntry::of_measure("fluid_share", ">=", fluid);
        self.add(Label::FLUID, None, vec![compared])?;
        let compared = ComparisonEntry::of_measure("settle_time", ">=", Value::from(0));
        self.add(Label::SETTLED, None, vec![compared])
    }

    /// The left side of the pinned sieve where the radius of the hole moves too.
    fn by_holes(&mut self, holes: HolesOfRuns, stored: f64) -> SideEntry {
        const KEY: &str = "sieves.pinned.hole";
        self.entry.thresholds.push(ThresholdEntry {
            quantity: "pinned: radius of the hole over that of a sphere".to_owned(),
            stops: holes.stops.clone(),
            ..ThresholdEntry::new(KEY, stored, ends(&holes.stops))
        });
        SideEntry::By {
            name: "pinned_share".to_owned(),
            by: ColumnsByStop {
                key: KEY.to_owned(),
                columns: holes.columns,
            },
        }
    }

    /// The sieves of a silo, of which the first that says yes decides.
    fn add_silo(&mut self, sieves: &Sieves) -> Option<()> {
        let least = sieves.flowing.least as f64;
        let counts = self.values("flowing_count");
        let most = counts.into_iter().fold(least + 1.0, f64::max);
        let key = "sieves.flowing.least";
        self.entry.thresholds.push(ThresholdEntry {
            quantity: "flowing: least grains in the last window".to_owned(),
            is_whole: true,
            ..ThresholdEntry::new(key, least, [1.0, most])
        });
        let arching = ComparisonEntry::of_measure("arching_margin", ">=", Value::from(0));
        self.add(Label::ARCHING, None, vec![arching])?;
        let flowing = ComparisonEntry::of_measure("flowing_count", ">=", Value::from(key));
        self.add(Label::FLOWING, None, vec![flowing])
    }

    /// The sieve of a drainage. What is not known to be over the opening may block it.
    fn add_drainage(&mut self) -> Option<()> {
        let rows = self.table.rows.iter();
        let stored = rows.map(|row| {
            let margin = row.verdict.value("blocked_margin");
            let is_over = row.verdict.value("spheres_over_opening") != Some(0.0);
            u8::from(margin.is_some_and(|margin| margin >= 0.0) && is_over)
        });
        let stored = stored.collect();
        self.add(Label::BLOCKED, Some(stored), Vec::new())
    }

    /// Adds a slider of a share, from `low` on; its key.
    fn share(&mut self, key: &str, quantity: &str, value: f64, low: f64) -> Value {
        self.entry.thresholds.push(ThresholdEntry {
            quantity: quantity.to_owned(),
            ..ThresholdEntry::new(key, value, [low, 1.0])
        });
        Value::from(key)
    }

    /// The least share whose label the table tells. A steady run that is too short for the share as
    /// it is has no evidence, but may be long enough for a smaller one.
    fn least(&self, measure: &str, share: f64) -> f64 {
        let mut rows = self.table.rows.iter();
        let is_short = rows.any(|row| {
            let verdict = &row.verdict;
            verdict.value("settle_time").is_some() && verdict.value(measure).is_none()
        });
        if is_short { share } else { 0.0 }
    }

    /// The values of a measure that runs have.
    fn values(&self, measure: &str) -> Vec<f64> {
        let rows = self.table.rows.iter();
        rows.filter_map(|row| row.verdict.value(measure)).collect()
    }

    /// Names the thresholds of the family's sieves that have no slider.
    fn tell_of_others(&mut self, sieves: &Sieves, family: &Family) {
        let Ok(Value::Object(tables)) = serde_json::to_value(sieves) else {
            return;
        };
        for sieve in family.sieves {
            let keys = tables.get(sieve.name).and_then(Value::as_object);
            for (key, value) in keys.into_iter().flatten() {
                let key = format!("sieves.{}.{key}", sieve.name);
                if self.entry.thresholds.iter().all(|it| it.key != key) {
                    self.entry.not_movable.push(NotMovable {
                        key,
                        value: value.to_string(),
                        why: OF_FRAMES.to_owned(),
                    });
                }
            }
        }
    }
}

impl ThresholdEntry {
    /// A threshold that may be moved between two ends; they may have been rounded.
    fn new(key: &str, value: f64, [low, high]: [f64; 2]) -> Self {
        Self {
            key: key.to_owned(),
            quantity: String::new(),
            unit: String::new(),
            value,
            low: low.min(value),
            high: high.max(value),
            is_whole: false,
            stops: Vec::new(),
            toml: None,
        }
    }
}

impl ComparisonEntry {
    fn of_measure(measure: &str, order: &'static str, threshold: Value) -> Self {
        Self {
            side: SideEntry::Measure {
                measure: measure.to_owned(),
            },
            order,
            threshold,
        }
    }
}
