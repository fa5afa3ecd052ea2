//! Maps of a number over the grid: settle time (Rice, 2012, figure 16), order parameters, and
//! the evidence of the sieves. Means over the seeds that have a value.

use super::color_bar::ColorBar;
use super::diagram::{Diagram, Look};
use super::grid::Grid;
use super::style::Fill;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::classify::Point;
use crate::classify::{Family, Verdict};
use crate::statistics::Estimate;

/// A map of one number of the verdicts.
pub(super) struct Map {
    name: &'static str,
    /// What it shows, with markup; also the label of the colour bar.
    quantity: &'static str,
    /// Unit; empty for a pure number.
    unit: &'static str,
    /// Whether zero is a natural middle.
    signed: bool,
    /// Whether it says how clearly a sieve decided, and not what the run did.
    evidence: bool,
    /// Whether it is a share of something, from 0 to 1.
    share: bool,
    family: Family,
    value: fn(&Verdict) -> Option<f64>,
}

/// All maps.
#[rustfmt::skip]
pub(super) static MAPS: [Map; 30] = [
    map("settle-time", "settle time", "s", |verdict| verdict.tank()?.settle_time),
    map("hole-radius", "hole radius / $R$", "", |verdict| verdict.tank()?.order.hole_radius),
    signed(map("paraboloid-rotation", "paraboloid rotation", "rad/s", |verdict| verdict.tank()?.order.paraboloid_rotation)),
    map("paraboloid-residual", "paraboloid residual / $r$", "", |verdict| verdict.tank()?.order.paraboloid_residual),
    map("rotation", "rotation of the spheres / $Ω$", "", |verdict| verdict.tank()?.order.rotation),
    map("mobility", "velocity fluctuation / √(2$rg$)", "", |verdict| verdict.tank()?.order.mobility),
    map("packing-height", "packing height / $R$", "", |verdict| verdict.tank()?.order.packing_height),
    map("spout-count", "rising spheres / $n$", "", |verdict| verdict.tank()?.order.spout_count),
    evidence(map("settle-change", "least change of energy / tolerance", "", |verdict| verdict.tank()?.evidence.settle_change)),
    evidence(map("fluid-share", "share of fluid frames", "", |verdict| verdict.tank()?.evidence.fluid_share)),
    evidence(signed(map("fluid-margin", "margin of the fluid sieve", "", |verdict| verdict.tank()?.evidence.fluid_margin))),
    evidence(map("pinned-share", "share of frames with a hole", "", |verdict| verdict.tank()?.evidence.pinned_share)),
    evidence(signed(map("pinned-margin", "margin of the pinned sieve", "", |verdict| verdict.tank()?.evidence.pinned_margin))),
    evidence(map("spout-share", "share of frames with a spout", "", |verdict| verdict.tank()?.evidence.spout_share)),
    evidence(signed(map("spout-margin", "margin of the spout sieve", "", |verdict| verdict.tank()?.evidence.spout_margin))),
    evidence(map("spout-peak", "most rising spheres / $n$", "", |verdict| verdict.tank()?.evidence.spout_peak)),
    silo(map("rest-time", "time at rest", "s", |verdict| verdict.silo()?.order.rest_time)),
    silo(map("heap-height", "height of the highest centre at rest", "m", |verdict| verdict.silo()?.order.heap_height)),
    silo(map("packing-fraction", "packing fraction at rest", "", |verdict| verdict.silo()?.order.packing_fraction)),
    silo(map("coordination", "contacts of a grain at rest", "", |verdict| verdict.silo()?.order.coordination)),
    silo(map("discharge-rate", "discharge rate", "grains/s", |verdict| verdict.silo()?.order.discharge_rate)),
    silo(map("mass-rate", "discharge rate", "kg/s", |verdict| verdict.silo()?.order.mass_rate)),
    silo(share(map("discharged-share", "share of the grains that left", "", |verdict| verdict.silo()?.order.discharged_share))),
    silo(map("emptying-time", "time to empty", "s", |verdict| verdict.silo()?.order.emptying_time)),
    silo(evidence(signed(map("emptied-margin", "margin of the emptied sieve", "", |verdict| verdict.silo()?.evidence.emptied_margin)))),
    silo(evidence(map("over-opening", "grains over the opening at the end", "", |verdict| verdict.silo()?.evidence.over_opening))),
    silo(evidence(map("arching-pause", "time without an outflow", "s", |verdict| verdict.silo()?.evidence.arching_pause))),
    silo(evidence(signed(map("arching-margin", "margin of the arching sieve", "", |verdict| verdict.silo()?.evidence.arching_margin)))),
    silo(evidence(map("flowing-count", "grains in the last window", "", |verdict| verdict.silo()?.evidence.flowing_count))),
    silo(evidence(signed(map("flowing-margin", "margin of the flowing sieve", "", |verdict| verdict.silo()?.evidence.flowing_margin)))),
];

/// The maps of what runs of a family did, without the evidence of its sieves.
pub(super) fn of_measures(family: Family) -> impl Iterator<Item = &'static Map> {
    MAPS.iter()
        .filter(move |map| map.family == family && !map.evidence)
}

const fn map(
    name: &'static str,
    quantity: &'static str,
    unit: &'static str,
    value: fn(&Verdict) -> Option<f64>,
) -> Map {
    Map {
        name,
        quantity,
        unit,
        signed: false,
        evidence: false,
        share: false,
        family: Family::Tank,
        value,
    }
}

const fn signed(map: Map) -> Map {
    Map {
        signed: true,
        ..map
    }
}

const fn evidence(map: Map) -> Map {
    Map {
        evidence: true,
        ..map
    }
}

const fn share(map: Map) -> Map {
    Map { share: true, ..map }
}

const fn silo(map: Map) -> Map {
    Map {
        family: Family::Silo,
        ..map
    }
}

impl Map {
    /// Quantity and unit, with markup.
    pub(super) fn label(&self) -> String {
        match self.unit {
            "" => self.quantity.to_owned(),
            unit => format!("{} ({unit})", self.quantity),
        }
    }

    /// Whether it is a share of something, from 0 to 1.
    pub(super) fn is_share(&self) -> bool {
        self.share
    }

    /// Values of the seeds of a point that have one. One that is not a number is none.
    pub(super) fn values(&self, source: &Source<'_>, point: &Point) -> Vec<f64> {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        let values = rows.filter_map(|row| (self.value)(&row.verdict));
        values.filter(|value| value.is_finite()).collect()
    }

    /// Mean over the seeds of a point that have a value.
    fn mean(&self, source: &Source<'_>, point: &Point) -> Option<f64> {
        Estimate::of_mean(&self.values(source, point)).map(|mean| mean.value)
    }
}

impl Figure for Map {
    fn name(&self) -> &'static str {
        self.name
    }

    fn description(&self) -> String {
        format!("map: {}", super::text::plain(&self.label()))
    }

    fn family(&self) -> Option<Family> {
        Some(self.family)
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let grid = Grid::new(source)?;
        let points = grid
            .panels
            .iter()
            .flat_map(|panel| panel.cells.iter().flatten());
        let values = points.filter_map(|point| self.mean(source, point));
        let label = self.label();
        let bar = ColorBar::new(values, self.signed, label.clone());
        Diagram {
            name: self.name,
            grid: &grid,
            look: &|point| {
                let value = self.mean(source, point)?;
                Some(Look {
                    fill: Fill::Color(bar.as_ref()?.color(value)),
                    agreement: 1.0,
                    group: 0,
                })
            },
            empty: match &bar {
                Some(_) => "no value".to_owned(),
                None => format!("{label}: no values"),
            },
            legend: Vec::new(),
            bar: bar.clone(),
        }
        .draw(source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{Measures, SiloMeasures, TankMeasures};
    use std::collections::BTreeSet;

    /// Names of all numbers in a tree, as those of maps.
    fn names(value: &serde_json::Value, names: &mut BTreeSet<String>) {
        for (key, value) in value.as_object().unwrap() {
            if value.is_object() {
                self::names(value, names);
            } else {
                names.insert(key.replace('_', "-"));
            }
        }
    }

    #[test]
    fn every_measure_and_evidence_has_its_map() {
        let tank = serde_json::to_value(TankMeasures::default()).unwrap();
        let silo = serde_json::to_value(SiloMeasures::default()).unwrap();
        for (family, measures) in [(Family::Tank, tank), (Family::Silo, silo)] {
            let mut fields = BTreeSet::new();
            names(&measures, &mut fields);
            let of_family = MAPS.iter().filter(|map| map.family == family);
            let maps: BTreeSet<String> = of_family.map(|map| map.name.to_owned()).collect();
            assert_eq!(maps, fields);
        }
    }

    #[test]
    fn a_map_reads_the_measure_of_its_name() {
        // Every number of a verdict is another one.
        for family in [Family::Tank, Family::Silo] {
            for map in MAPS.iter().filter(|map| map.family == family) {
                let verdict = Verdict {
                    label: crate::classify::Label::Unsettled,
                    measures: with_one(family, &map.name.replace('-', "_")),
                };
                assert_eq!((map.value)(&verdict), Some(7.0), "{}", map.name);
            }
        }
    }

    /// Measures of which only the one of that name is there, and 7.
    fn with_one(family: Family, name: &str) -> Measures {
        fn set<T: serde::Serialize + serde::de::DeserializeOwned>(measures: &T, name: &str) -> T {
            let mut tree = serde_json::to_value(measures).unwrap();
            let table = tree.as_object_mut().unwrap();
            for (key, value) in table.iter_mut() {
                match value.as_object_mut() {
                    Some(inner) if inner.contains_key(name) => inner[name] = 7.0.into(),
                    None if key == name => *value = 7.0.into(),
                    _ => {}
                }
            }
            serde_json::from_value(tree).unwrap()
        }
        match Measures::none(family) {
            Measures::Tank(measures) => Measures::Tank(set(&measures, name)),
            Measures::Silo(measures) => Measures::Silo(set(&measures, name)),
        }
    }
}
