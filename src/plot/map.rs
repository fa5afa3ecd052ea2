//! Maps of a number over the grid: settle time (Rice, 2012, figure 16), order parameters, and
//! the evidence of the sieves. Means over the seeds that have a value.

use super::chart::Bar;
use super::color_bar::ColorBar;
use super::diagram::{Diagram, Look};
use super::grid::PanelGrid;
use super::style::Fill;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::classify::{FAMILIES, Family, Measure, MeasureRange, Point};
use crate::scene::Units;
use crate::statistics::{Estimate, mean_share_interval};
use plotters::style::RGBColor;
use std::collections::HashSet;
use std::sync::LazyLock;

/// A map of one measure of the verdicts.
pub(super) struct MeasureMap {
    /// The measure's name, with dashes.
    name: String,
    family: &'static Family,
    measure: &'static Measure,
}

/// All maps: one of each measure of each family, what runs did before evidence of the sieves.
pub(super) static MAPS: LazyLock<Vec<MeasureMap>> =
    LazyLock::new(|| FAMILIES.into_iter().flat_map(of_family).collect());

/// The maps of all measures of a family.
fn of_family(family: &'static Family) -> impl Iterator<Item = MeasureMap> {
    let mut measures: Vec<_> = family.measures().collect();
    measures.sort_by_key(|measure| measure.is_evidence);
    measures.into_iter().map(move |measure| MeasureMap {
        name: measure.name.replace('_', "-"),
        family,
        measure,
    })
}

/// The map of that name of a measure that the rules of a file added, if there is one.
pub(super) fn of_rules(name: &str, family: &'static Family) -> Option<MeasureMap> {
    let has_rules = !FAMILIES.contains(&family);
    // Measures are named with `_` in files.
    let name = name.replace('_', "-");
    of_family(family).find(|map| has_rules && map.name == name)
}

/// The figures of measures and labels that the rules of a file added: their names, and what they
/// show.
pub fn figures_of_rules(family: &'static Family) -> Vec<(String, String)> {
    let maps = of_family(family).filter(|_| !FAMILIES.contains(&family));
    maps.map(|map| (map.name.clone(), map.description()))
        .collect()
}

pub(super) fn figure(map: &'static MeasureMap) -> Figure {
    let description = map.description();
    Figure::of_sweep(&map.name, description, |source| map.draw(source)).for_families([map.family])
}

/// The maps of what runs of a family did, without the evidence of its sieves.
pub(super) fn of_measures(family: &'static Family) -> impl Iterator<Item = MeasureMap> {
    of_family(family).filter(|map| !map.measure.is_evidence)
}

impl MeasureMap {
    fn description(&self) -> String {
        format!("map: {}", super::text::plain(&self.label(Units::Si)))
    }

    /// Quantity and unit, with markup.
    pub(super) fn label(&self, units: Units) -> String {
        let quantity = self.measure.quantity;
        match units.shown(self.measure.unit) {
            "" => quantity.to_owned(),
            unit => format!("{quantity} ({unit})"),
        }
    }

    /// The bar of the mean over several runs; `None` without values.
    pub(super) fn bar(&self, x: f64, values: &[f64], color: RGBColor) -> Option<Bar> {
        let Estimate { value, half_width } = Estimate::of_mean(values)?;
        let bar = Bar::about((x, value), half_width, color);
        let ends = match self.measure.range {
            // One run says nothing of its scatter.
            MeasureRange::Share if values.len() > 1 => mean_share_interval(values)?,
            MeasureRange::Share | MeasureRange::Part => bar.ends().map(|end| end.clamp(0.0, 1.0)),
            MeasureRange::Any | MeasureRange::Signed => return Some(bar),
        };
        Some(Bar::between(bar.at, ends, color))
    }

    /// Values of the seeds of a point that have one. One that is not a number is none.
    pub(super) fn values(&self, source: &Source<'_>, point: &Point) -> Vec<f64> {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        let values = rows.filter_map(|row| row.verdict.value(self.measure.name));
        values.filter(|value| value.is_finite()).collect()
    }

    /// Mean over the seeds of a point that have a value.
    fn mean(&self, source: &Source<'_>, point: &Point) -> Option<f64> {
        Estimate::of_mean(&self.values(source, point)).map(|mean| mean.value)
    }

    pub(super) fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let grid = PanelGrid::new(source.sweep, source.table)?;
        let points = grid
            .panels
            .iter()
            .flat_map(|panel| panel.cells.iter().flatten());
        let values = points.filter_map(|point| self.mean(source, point));
        let label = self.label(source.sweep.units());
        let bar = ColorBar::new(
            values,
            self.measure.range == MeasureRange::Signed,
            label.clone(),
        );
        Diagram {
            name: &self.name,
            grid: &grid,
            look: &|point| {
                let value = self.mean(source, point)?;
                Some(Look::new(Fill::Color(bar.as_ref()?.color(value)), None))
            },
            empty: match &bar {
                Some(_) => "no value".to_owned(),
                None => format!("{label}: no values"),
            },
            failed: HashSet::new(),
            legend: Vec::new(),
            bar: bar.clone(),
        }
        .draw(source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::BLACK;

    /// Symptom: bars of rising spheres began below none, those of holes ended beyond the tank.
    /// Cause: only measures that were called shares had their bars between 0 and 1.
    #[test]
    fn bars_of_parts_stay_between_0_and_1() {
        let ends = |name: &str, values: &[f64]| {
            let map = MAPS.iter().find(|map| map.name == name).unwrap();
            map.bar(0.0, values, BLACK).unwrap().ends()
        };
        for name in [
            "spout-count",
            "hole-radius",
            "packing-fraction",
            "discharged-share",
        ] {
            assert_eq!(ends(name, &[0.1, 0.9]), [0.0, 1.0], "{name}");
            assert_eq!(ends(name, &[0.4]), [0.4, 0.4], "{name}");
        }
        // No run without a spout has one by chance; grains may all leave by chance.
        assert_eq!(ends("spout-count", &[0.0; 3]), [0.0, 0.0]);
        assert!(ends("discharged-share", &[1.0; 3])[0] < 0.5);
        assert!(ends("settle-time", &[0.1, 0.9])[0] < 0.0);
    }
}
