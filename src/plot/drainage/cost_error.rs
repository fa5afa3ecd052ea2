//! Error against cost: how much the measures of each drainage differ from the first one's, over the
//! processor time that it takes.

use super::overlay::{GUIDES, color};
use super::{MeasuredDrainage, each, of_drainages};
use crate::compare::{DrainageQuantity, QUANTITIES};
use crate::plot::chart::{self, Bar, Chart, ChartLine, ChartPanel};
use crate::plot::page::columns;
use crate::plot::runs::Runs;
use crate::plot::style::px;
use crate::plot::svg::Svg;
use crate::plot::ticks::Ticks;
use crate::plot::{Figure, PlotError, numbers, palette};
use crate::scene::Units;
use crate::statistics::Estimate;
use plotters::style::RGBColor;

/// Name of the figure.
const NAME: &str = "cost-error";

/// Room beyond the data, as a factor.
const BEYOND: f64 = 1.5;
/// Colour of the line at the cost of the reference.
const COST: RGBColor = GUIDES[0];

pub(super) fn figure() -> Figure {
    of_drainages(
        NAME,
        "how far measures are from those of the first run, against processor time",
        false,
        draw,
    )
}

fn draw(runs: &Runs<'_>) -> Result<Svg, PlotError> {
    let mut units = Units::Si;
    let measured = each(runs, NAME, |place, drainage| {
        units = drainage.units();
        MeasuredRun::of(place, drainage)
    })?;
    let (reference, others) = match measured.split_first() {
        Some((reference, others)) if !others.is_empty() => (reference, others),
        _ => {
            return Err(PlotError::needs(
                NAME,
                "two runs or more, the first of which is the reference",
            ));
        }
    };
    let panels = panels(reference, others).ok_or_else(|| PlotError::no_measures(NAME))?;
    let time = units.of_time();
    Chart {
        name: NAME,
        common: runs.common.clone(),
        columns: columns(panels.len()),
        height: px(170),
        panels,
        x_label: format!("processor time (s) per {time} of the run"),
        y_label: "difference from the reference, over its value".to_owned(),
        legend: legend(reference, others),
        notes: vec![
            "Bars: 95 % over ten states or blocks of time, of both runs; where nothing tells \
             the scatter, there is none. A difference below the interval of the reference \
             cannot be told."
                .to_owned(),
        ],
    }
    .draw(&runs.origin)
}

/// What a run costs, and its values of the quantities that are shown.
struct MeasuredRun {
    /// Its name in the legend.
    name: String,
    /// Processor time (s) per second of the run.
    cost: f64,
    values: Vec<Option<Estimate>>,
}

impl MeasuredRun {
    fn of(place: Vec<String>, drainage: &MeasuredDrainage<'_>) -> Self {
        let end = drainage.states().last().map_or(f64::NAN, |it| it.time);
        Self {
            name: place.join(", "),
            cost: drainage.record.cpu_seconds / end,
            values: shown().map(|it| (it.measure)(drainage)).collect(),
        }
    }
}

fn shown() -> impl Iterator<Item = &'static DrainageQuantity> {
    QUANTITIES.iter().filter(|it| it.is_of_flow)
}

/// The reference and each other run, by colour.
fn legend(reference: &MeasuredRun, others: &[MeasuredRun]) -> Vec<(RGBColor, String)> {
    let first = &reference.name;
    let time = numbers::rounded(reference.cost, 2);
    let head = [
        (COST, format!("cost of the reference, {time} s: {first}")),
        (palette::GUIDE, "interval of the reference".to_owned()),
    ];
    let named = others.iter().enumerate();
    let named = named.map(|(index, run)| {
        let gain = reference.cost / run.cost;
        let word = match gain.is_finite() {
            true => format!(
                "{}, at 1 / {} of its cost",
                run.name,
                numbers::rounded(gain, 2)
            ),
            false => format!("{}, of unknown cost", run.name),
        };
        (color(index, others.len()), word)
    });
    head.into_iter().chain(named).collect()
}

/// A panel for each quantity that the reference and another run have, all with the same axes; none
/// if there is no quantity, or no error above zero.
fn panels(reference: &MeasuredRun, others: &[MeasuredRun]) -> Option<Vec<ChartPanel>> {
    let costs = others.iter().map(|it| it.cost).chain([reference.cost]);
    let (low, high) = chart::ends(costs.filter(|it| *it > 0.0));
    let x = (low / BEYOND, high * BEYOND);
    let errors: Vec<QuantityErrors> = shown()
        .enumerate()
        .filter_map(|(place, quantity)| QuantityErrors::of(quantity, place, reference, others))
        .collect();
    let values = errors.iter().flat_map(|it| it.points.iter().flatten());
    let floors = errors.iter().map(|it| it.floor);
    let drawn = values.map(|(_, error)| error.value).chain(floors);
    let (low, high) = chart::ends(drawn.filter(|it| *it > 0.0 && it.is_finite()));
    let y = (low / BEYOND, high * BEYOND);
    let is_drawable = x.0 < x.1 && y.0 < y.1 && !errors.is_empty();
    is_drawable.then(|| errors.iter().map(|it| it.panel([x, y])).collect())
}

/// The errors of a quantity.
struct QuantityErrors {
    name: &'static str,
    /// Half width of the interval of the reference, over its value.
    floor: f64,
    /// Cost of the reference.
    cost: f64,
    /// Cost and error of each run; `None` without an error above zero.
    points: Vec<Option<(f64, Estimate)>>,
}

impl QuantityErrors {
    fn of(
        quantity: &DrainageQuantity,
        place: usize,
        reference: &MeasuredRun,
        others: &[MeasuredRun],
    ) -> Option<Self> {
        let first = reference.values[place].filter(|it| it.value != 0.0)?;
        let scale = first.value.abs();
        let error = |run: &MeasuredRun| {
            let other = run.values[place]?;
            let error = Estimate {
                value: (other.value - first.value).abs() / scale,
                half_width: libm::hypot(first.half_width, other.half_width) / scale,
            };
            (error.value > 0.0).then_some((run.cost, error))
        };
        let points: Vec<_> = others.iter().map(error).collect();
        points.iter().any(Option::is_some).then(|| Self {
            name: quantity.name,
            floor: first.half_width / scale,
            cost: reference.cost,
            points,
        })
    }

    fn panel(&self, [x, y]: [(f64, f64); 2]) -> ChartPanel {
        let line = |points, color| ChartLine { points, color };
        let mut lines = vec![line(vec![(self.cost, y.0), (self.cost, y.1)], COST)];
        if (y.0..=y.1).contains(&self.floor) {
            let floor = vec![(x.0, self.floor), (x.1, self.floor)];
            lines.push(line(floor, palette::GUIDE));
        }
        let count = self.points.len();
        let points = self.points.iter().enumerate();
        let bars = points.filter_map(|(index, point)| {
            let (cost, error) = (*point)?;
            let ink = color(index, count);
            let half = error.half_width;
            // An axis of powers of ten has no zero: an interval that reaches it ends at the frame.
            let ends = match half.is_finite() {
                true => [error.value - half, error.value + half].map(|it| it.clamp(y.0, y.1)),
                false => [error.value; 2],
            };
            Some(Bar::between((cost, error.value), ends, ink))
        });
        ChartPanel {
            head: vec![self.name.to_owned()],
            x,
            y,
            lines,
            bars: bars.collect(),
            spacing: chart::BOTH_LOGARITHMIC,
            ticks: Ticks::Round,
        }
    }
}
