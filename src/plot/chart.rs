//! A chart: lines over a horizontal axis, in panels of equal size.

use super::canvas::{Body, Drawn, FigureSheet};
use super::legend::{LegendEntry, LegendKey};
use super::page::{FigurePage, PagePlan, PanelFrame};
use super::scale::AxisSpan;
use super::spacing::AxisSpacing;
use super::style::{self, px};
use super::svg::{Origin, Svg};
use super::ticks::Ticks;
use super::{PlotError, palette};
use plotters::element::{ErrorBar, PathElement};
use plotters::style::{Color, RGBColor};

/// A line: points in the order of x, and its colour.
#[derive(Clone, Debug)]
pub(super) struct ChartLine {
    pub(super) points: Vec<(f64, f64)>,
    pub(super) color: RGBColor,
}

impl ChartLine {
    /// A line of observations over time.
    pub(super) fn over(time: &[f64], values: &[f32], color: RGBColor) -> Self {
        let values = values.iter().map(|&value| f64::from(value));
        Self {
            points: time.iter().copied().zip(values).collect(),
            color,
        }
    }
}

/// The mean of several values and its interval, a point between two ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bar {
    pub(super) at: (f64, f64),
    /// Ends of the interval, the lower first; both at the point where there is none.
    ends: [f64; 2],
    pub(super) color: RGBColor,
}

impl Bar {
    /// An interval that reaches as far down as up; none if that is infinite.
    pub(super) fn about(at: (f64, f64), half: f64, color: RGBColor) -> Self {
        let half = if half.is_finite() { half } else { 0.0 };
        Self::between(at, [at.1 - half, at.1 + half], color)
    }

    /// An interval between two ends, the lower first.
    pub(super) fn between(at: (f64, f64), ends: [f64; 2], color: RGBColor) -> Self {
        Self { at, ends, color }
    }

    /// Ends of what is drawn, the lower first.
    pub(super) fn ends(&self) -> [f64; 2] {
        self.ends
    }
}

/// Both axes of powers of ten.
pub(super) const BOTH_LOGARITHMIC: [AxisSpacing; 2] =
    [AxisSpacing::Logarithmic, AxisSpacing::Logarithmic];

/// A panel.
#[derive(Clone, Debug, Default)]
pub(super) struct ChartPanel {
    /// What stands above it, with markup: items of a list, which breaks between them.
    pub(super) head: Vec<String>,
    /// Ends of its axes. What lies left of them or right is not drawn.
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
    pub(super) lines: Vec<ChartLine>,
    /// Drawn over the lines.
    pub(super) bars: Vec<Bar>,
    /// How values of the horizontal and of the vertical axis are spaced.
    pub(super) spacing: [AxisSpacing; 2],
    /// Where the horizontal axis has ticks.
    pub(super) ticks: Ticks,
}

impl ChartPanel {
    /// A panel of lines, with all their values in sight.
    pub(super) fn new(head: Vec<String>, x: (f64, f64), lines: Vec<ChartLine>) -> Self {
        let points = lines.iter().flat_map(|line| &line.points);
        let y = range(points.map(|point| point.1)).unwrap_or((0.0, 1.0));
        Self {
            head,
            x,
            y,
            lines,
            bars: Vec::new(),
            ..Self::default()
        }
    }

    /// The same with intervals, which are in sight too.
    pub(super) fn with_bars(self, bars: Vec<Bar>) -> Self {
        let points = self.lines.iter().flat_map(|line| &line.points);
        let values = points.map(|point| point.1);
        let values = values.chain(bars.iter().flat_map(|bar| bar.ends));
        let y = range(values).unwrap_or(self.y);
        Self { y, bars, ..self }
    }

    /// The same with heights over powers of ten; all values must be above zero. Intervals are in
    /// sight down to a tenth of their value.
    pub(super) fn logarithmic(self) -> Self {
        let points = self.lines.iter().flat_map(|line| &line.points);
        let bars = self.bars.iter();
        let ends = bars.flat_map(|bar| [bar.ends[0].max(0.1 * bar.at.1), bar.ends[1]]);
        let y = decades(points.map(|point| point.1).chain(ends));
        let spacing = [self.spacing[0].clone(), AxisSpacing::Logarithmic];
        Self { y, spacing, ..self }
    }

    /// The same with both over powers of ten.
    pub(super) fn logarithmic_both(self) -> Self {
        let points = self.lines.iter().flat_map(|line| &line.points);
        let x = decades(points.map(|point| point.0));
        let panel = self.logarithmic();
        Self {
            x,
            spacing: BOTH_LOGARITHMIC,
            ..panel
        }
    }

    /// The same with zero at its lower end.
    pub(super) fn down_to_zero(self) -> Self {
        let y = (0.0, self.y.1);
        Self { y, ..self }
    }
}

/// A chart.
#[derive(Default)]
pub(super) struct Chart {
    /// Name of the figure.
    pub(super) name: &'static str,
    /// What stands below the title and holds for all panels, as items of a list.
    pub(super) common: Vec<String>,
    /// Panels, row by row.
    pub(super) panels: Vec<ChartPanel>,
    /// Panels per row.
    pub(super) columns: usize,
    /// Height of a panel.
    pub(super) height: i32,
    /// Labels of the axes, with markup.
    pub(super) x_label: String,
    pub(super) y_label: String,
    /// Names of the lines, by colour.
    pub(super) legend: Vec<(RGBColor, String)>,
    /// Sentences below everything.
    pub(super) notes: Vec<String>,
}

impl Chart {
    pub(super) fn draw(&self, origin: &Origin<'_>) -> Result<Svg, PlotError> {
        let body = self.body(origin.title)?;
        Ok(Svg::new(self.name, origin, &body))
    }

    /// Size of the canvas, and what is drawn on it below a title.
    pub(super) fn body(&self, title: Option<&str>) -> Result<Body, PlotError> {
        let frame = |panel: &ChartPanel| PanelFrame {
            head: panel.head.clone(),
            x: AxisSpan {
                spacing: panel.spacing[0].clone(),
                ticks: panel.ticks.clone(),
                ..AxisSpan::linear(panel.x)
            },
            y: AxisSpan {
                spacing: panel.spacing[1].clone(),
                ..AxisSpan::linear(panel.y)
            },
        };
        let legend = self.legend.iter();
        let page = FigurePage::new(PagePlan {
            title,
            common: &self.common,
            frames: self.panels.iter().map(frame).collect(),
            columns: self.columns,
            height: self.height,
            labels: [self.x_label.clone(), self.y_label.clone()],
            legend: legend
                .map(|(color, text)| LegendEntry::new(LegendKey::Line(*color), text))
                .collect(),
            notes: &self.notes,
            ..PagePlan::default()
        });
        page.draw(|sheet| {
            let mut panels = self.panels.iter().enumerate();
            panels.try_for_each(|(index, panel)| panel.draw(sheet, &page, index))
        })
    }
}

impl ChartPanel {
    fn draw(&self, sheet: &FigureSheet<'_>, page: &FigurePage, index: usize) -> Drawn {
        let axes = page.axes(sheet, index)?;
        let plot = axes.plot();
        if self.y.0 < 0.0 && self.y.1 > 0.0 {
            let zero = [(self.x.0, 0.0), (self.x.1, 0.0)];
            plot.draw(&PathElement::new(zero, palette::GUIDE.stroke_width(8)))?;
        }
        for line in &self.lines {
            let inside = |point: &&(f64, f64)| (self.x.0..=self.x.1).contains(&point.0);
            let points = line.points.iter().filter(inside);
            let points = thinned(points.map(|point| plot.map_coordinate(point)));
            sheet.draw(&PathElement::new(points, style::line(line.color)))?;
        }
        for bar in &self.bars {
            let [low, high] = bar.ends.map(|end| end.clamp(self.y.0, self.y.1));
            let ink = bar.color.filled().stroke_width(12);
            let (x, y) = bar.at;
            plot.draw(&ErrorBar::new_vertical(x, low, y, high, ink, px(6) as u32))?;
        }
        axes.draw()
    }
}

/// A polyline that looks the same with fewer points: of those in one CSS pixel of x only the
/// first, the lowest, the highest and the last.
fn thinned(points: impl Iterator<Item = (i32, i32)>) -> Vec<(i32, i32)> {
    let points: Vec<(i32, i32)> = points.collect();
    let mut kept = Vec::new();
    for column in points.chunk_by(|one, next| one.0.div_euclid(px(1)) == next.0.div_euclid(px(1))) {
        let ends = [0, column.len() - 1];
        let lowest = (0..column.len()).min_by_key(|&index| column[index].1);
        let highest = (0..column.len()).max_by_key(|&index| column[index].1);
        let mut indices: Vec<usize> = ends.into_iter().chain(lowest).chain(highest).collect();
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| column[index]));
    }
    kept.dedup();
    kept
}

/// The range of values above zero, with a little room at both ends of an axis of powers of ten.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = ends(values);
    match low <= high {
        true => (0.8 * low, 1.25 * high),
        false => (0.1, 1.0),
    }
}

/// The smallest and the largest of some values; infinite without any.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// The range of all values, with a little room at both ends; `None` if no value is finite.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let (low, high) = ends(values.into_iter().filter(|value| value.is_finite()));
    let room = match high - low {
        span if span > 0.0 => 0.05 * span,
        0.0 if high != 0.0 => 0.5 * high.abs(),
        0.0 => 1.0,
        _ => return None,
    };
    Some((low - room, high + room))
}

/// Points of a smooth curve.
const SAMPLES: usize = 300;

/// Places of the points of a smooth curve, from `low` to `high`.
pub(super) fn samples(low: f64, high: f64) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |index| low + (high - low) * index as f64 / SAMPLES as f64)
}

/// A unit with the prefix in which `largest` is at least one, from nano to mega, and the factor to
/// it.
pub(super) fn prefixed(unit: &str, largest: f64) -> (String, f64) {
    const PREFIXES: [(f64, &str); 6] = [
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, "µ"),
        (1e9, "n"),
    ];
    let fits = |prefix: &&(f64, &str)| largest * prefix.0 >= 1.0;
    let (factor, prefix) = PREFIXES.iter().find(fits).unwrap_or(&(1.0, ""));
    (format!("{prefix}{unit}"), *factor)
}

/// Scales panels to the unit with the prefix in which the largest value of their lines is at least
/// one; that unit.
pub(super) fn scaled(unit: &str, panels: &mut [ChartPanel]) -> String {
    let lines = panels.iter().flat_map(|panel| &panel.lines);
    let sizes = lines.flat_map(|line| line.points.iter().map(|point| point.1.abs()));
    let (unit, factor) = prefixed(unit, sizes.fold(0.0, f64::max));
    for panel in panels {
        panel.y = (panel.y.0 * factor, panel.y.1 * factor);
        let points = panel.lines.iter_mut().flat_map(|line| &mut line.points);
        points.for_each(|point| point.1 *= factor);
    }
    unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn prefixes() {
        assert_eq!(prefixed("J", 3.2e-4), ("µJ".to_owned(), 1e6));
        assert_eq!(prefixed("J", 1.0), ("J".to_owned(), 1.0));
        assert_eq!(prefixed("N", 0.02), ("mN".to_owned(), 1e3));
        assert_eq!(prefixed("J", 0.0), ("J".to_owned(), 1.0));
    }

    #[test]
    fn ranges_hold_their_values() {
        assert_eq!(range([1.0, f64::NAN, 3.0]), Some((0.9, 3.1)));
        assert_eq!(range([0.0, 0.0]), Some((-1.0, 1.0)));
        assert_eq!(range([-4.0]), Some((-6.0, -2.0)));
        assert_eq!(range([f64::NAN]), None);
    }

    proptest! {
        #[test]
        fn thinning_keeps_ends_and_extremes(
            heights in prop::collection::vec(-1000..1000_i32, 1..400),
            step in 1..30_i32,
        ) {
            let points: Vec<(i32, i32)> =
                (0..).map(|index| index * step).zip(heights.iter().copied()).collect();
            let kept = thinned(points.iter().copied());
            prop_assert_eq!(kept.first(), points.first());
            prop_assert_eq!(kept.last(), points.last());
            prop_assert_eq!(kept.iter().map(|p| p.1).max(), points.iter().map(|p| p.1).max());
            prop_assert!(kept.len() <= 4 * (points.len() * step as usize / 10 + 1));
            prop_assert!(kept.iter().all(|point| points.contains(point)));
            prop_assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        }
    }
}
