//! Maps of a number over the grid: settle time (Rice, 2012, figure 16), order parameters, and
//! the evidence of the sieves. Means over the seeds that have a value.

use super::color_bar::ColorBar;
use super::diagram::{Diagram, Look};
use super::grid::Grid;
use super::style::Fill;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::classify::Verdict;
use crate::sweep::Point;

/// A map of one number of the verdicts.
pub(super) struct Map {
    name: &'static str,
    /// What it shows, with markup; also the label of the colour bar.
    quantity: &'static str,
    /// Unit; empty for a pure number.
    unit: &'static str,
    /// Whether zero is a natural middle.
    signed: bool,
    value: fn(&Verdict) -> Option<f64>,
}

/// All maps.
#[rustfmt::skip]
pub(super) static MAPS: [Map; 16] = [
    map("settle-time", "settle time", "s", |verdict| verdict.settle_time),
    map("hole-radius", "hole radius / $R$", "", |verdict| verdict.order.hole_radius),
    signed("paraboloid-rotation", "paraboloid rotation", "rad/s", |verdict| verdict.order.paraboloid_rotation),
    map("paraboloid-residual", "paraboloid residual / $r$", "", |verdict| verdict.order.paraboloid_residual),
    map("rotation", "rotation of the spheres / $Ω$", "", |verdict| verdict.order.rotation),
    map("mobility", "velocity fluctuation / √(2$rg$)", "", |verdict| verdict.order.mobility),
    map("packing-height", "packing height / $R$", "", |verdict| verdict.order.packing_height),
    map("spout-count", "rising spheres / $n$", "", |verdict| verdict.order.spout_count),
    map("settle-change", "least change of energy / tolerance", "", |verdict| verdict.evidence.settle_change),
    map("fluid-share", "share of fluid frames", "", |verdict| verdict.evidence.fluid_share),
    signed("fluid-margin", "margin of the fluid sieve", "", |verdict| verdict.evidence.fluid_margin),
    map("pinned-share", "share of frames with a hole", "", |verdict| verdict.evidence.pinned_share),
    signed("pinned-margin", "margin of the pinned sieve", "", |verdict| verdict.evidence.pinned_margin),
    map("spout-share", "share of frames with a spout", "", |verdict| verdict.evidence.spout_share),
    signed("spout-margin", "margin of the spout sieve", "", |verdict| verdict.evidence.spout_margin),
    map("spout-peak", "most rising spheres / $n$", "", |verdict| verdict.evidence.spout_peak),
];

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
        value,
    }
}

const fn signed(
    name: &'static str,
    quantity: &'static str,
    unit: &'static str,
    value: fn(&Verdict) -> Option<f64>,
) -> Map {
    Map {
        signed: true,
        ..map(name, quantity, unit, value)
    }
}

impl Map {
    /// Mean over the seeds of a point that have a value. One that is not a number is none.
    fn mean(&self, source: &Source<'_>, point: &Point) -> Option<f64> {
        let verdicts = point
            .rows
            .iter()
            .map(|&row| &source.table.rows[row].verdict);
        let values: Vec<f64> = verdicts
            .filter_map(self.value)
            .filter(|value| value.is_finite())
            .collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }
}

impl Figure for Map {
    fn name(&self) -> &'static str {
        self.name
    }

    fn description(&self) -> String {
        let unit = if self.unit.is_empty() {
            String::new()
        } else {
            format!(" ({})", self.unit)
        };
        format!("map: {}{unit}", super::text::plain(self.quantity))
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let grid = Grid::new(source)?;
        let points = grid
            .panels
            .iter()
            .flat_map(|panel| panel.cells.iter().flatten());
        let values = points.filter_map(|point| self.mean(source, point));
        let label = if self.unit.is_empty() {
            self.quantity.to_owned()
        } else {
            format!("{} ({})", self.quantity, self.unit)
        };
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
    use crate::classify::{Evidence, OrderParameters};
    use std::collections::BTreeSet;

    #[test]
    fn every_order_parameter_and_evidence_has_its_map() {
        let mut fields = BTreeSet::from(["settle-time".to_owned()]);
        for value in [
            serde_json::to_value(OrderParameters::default()).unwrap(),
            serde_json::to_value(Evidence::default()).unwrap(),
        ] {
            let table = value.as_object().unwrap();
            fields.extend(table.keys().map(|key| key.replace('_', "-")));
        }
        let maps: BTreeSet<String> = MAPS.iter().map(|map| map.name.to_owned()).collect();
        assert_eq!(maps, fields);
    }
}
