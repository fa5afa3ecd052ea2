//! Figures in which each run is a line.

use super::{MeasuredDrainage, each, of_drainages};
use crate::color::ColorMap;
use crate::plot::chart::{self, Bar, Chart, ChartLine, ChartPanel};
use crate::plot::page::columns;
use crate::plot::runs::Runs;
use crate::plot::style::px;
use crate::plot::svg::Svg;
use crate::plot::{Figure, PlotError, palette};
use crate::scene::Units;
use crate::store::DataSet;
use plotters::style::RGBColor;

/// A figure in which each run is a line in one panel or several.
pub(super) struct Overlay {
    pub(super) name: &'static str,
    pub(super) description: &'static str,
    /// Labels of the axes, with markup.
    pub(super) labels: [&'static str; 2],
    pub(super) panels: &'static [OverlayPanel],
    pub(super) note: &'static str,
    /// What a run shows.
    pub(super) lines: fn(&MeasuredDrainage<'_>) -> RunLines,
    /// What the first run is compared with, in the first panel.
    pub(super) guides: fn(&MeasuredDrainage<'_>) -> Vec<Guide>,
}

/// A line that runs are compared with.
pub(super) struct Guide {
    /// Its name in the legend.
    pub(super) name: &'static str,
    pub(super) points: Vec<(f64, f64)>,
}

/// No guides.
pub(super) fn none(_: &MeasuredDrainage<'_>) -> Vec<Guide> {
    Vec::new()
}

/// A panel.
pub(super) struct OverlayPanel {
    /// What stands above it.
    pub(super) head: &'static str,
    /// Ends of the horizontal axis; `None` for an axis as long as its lines.
    pub(super) x: Option<(f64, f64)>,
    pub(super) y: PanelScale,
}

/// What the vertical axis of a panel is like.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum PanelScale {
    /// As far as the lines go.
    Free,
    /// From zero up.
    FromZero,
    /// Of powers of ten.
    Logarithmic,
    /// The same, and so is the horizontal axis.
    Decades,
}

/// What a run shows.
pub(super) struct RunLines {
    /// A line for each panel.
    pub(super) curves: Vec<RunCurve>,
    /// What the legend says of it besides its name, with markup.
    pub(super) word: Option<String>,
}

/// A line of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct RunCurve {
    pub(super) points: Vec<(f64, f64)>,
    /// Half widths of the intervals of all points; none if there are none.
    pub(super) half_widths: Vec<f64>,
}

impl RunCurve {
    /// A line without intervals.
    pub(super) fn through(points: Vec<(f64, f64)>) -> Self {
        Self {
            points,
            half_widths: Vec::new(),
        }
    }
}

impl Overlay {
    pub(super) fn figure(&'static self) -> Figure {
        let draw = |runs: &Runs<'_>| self.draw(runs);
        of_drainages(self.name, self.description, true, draw)
    }

    fn draw(&self, runs: &Runs<'_>) -> Result<Svg, PlotError> {
        let mut first = None;
        let mut shown = each(runs, self.name, |place, drainage| {
            first.get_or_insert_with(|| ((self.guides)(drainage), drainage.units()));
            (place, (self.lines)(drainage))
        })?;
        shown.extend(runs.data.iter().map(|data| self.of_data(data)));
        let (guides, units) = first.unwrap_or((Vec::new(), Units::Si));
        let panels = self.panels.iter().enumerate();
        let mut panels: Vec<ChartPanel> = panels
            .map(|(index, frame)| {
                let guides = if index == 0 { &guides[..] } else { &[] };
                frame.panel(shown.iter().map(|(_, it)| &it.curves[index]), guides)
            })
            .collect();
        self.align(&mut panels);
        if panels
            .iter()
            .all(|panel| panel.lines.iter().all(|it| it.points.is_empty()))
        {
            return Err(PlotError::no_measures(self.name));
        }
        let count = shown.len();
        let named = shown.into_iter().enumerate();
        let legend = named.filter_map(|(index, (mut name, lines))| {
            name.extend(lines.word);
            let color = color(index, count);
            (!name.is_empty()).then(|| (color, name.join(", ")))
        });
        let named_guides = guides.iter().zip(GUIDES);
        let named_guides = named_guides.map(|(guide, color)| (color, guide.name.to_owned()));
        let [x_label, y_label] = self.labels.map(|label| in_units(label, units));
        Chart {
            name: self.name,
            common: runs.common.clone(),
            columns: columns(panels.len()),
            height: px(300),
            legend: legend.chain(named_guides).collect(),
            panels,
            x_label,
            y_label,
            notes: Vec::from_iter((!self.note.is_empty()).then(|| self.note.to_owned())),
        }
        .draw(&runs.origin)
    }

    /// What data of another source show: a line in the first panel.
    fn of_data(&self, data: &DataSet) -> (Vec<String>, RunLines) {
        let mut curves = vec![RunCurve::default(); self.panels.len()];
        if let Some(curve) = curves.first_mut() {
            curve.points.clone_from(&data.points);
            curve.half_widths.clone_from(&data.half_widths);
        }
        (vec![data.name.clone()], RunLines { curves, word: None })
    }

    /// Gives panels of one kind the same axes, as far as the lines of all of them go.
    fn align(&self, panels: &mut [ChartPanel]) {
        let frames = self.panels.iter().zip(panels.iter());
        let filled = frames.filter(|(_, panel)| !panel.lines.iter().all(|it| it.points.is_empty()));
        let axes: Vec<_> = filled
            .map(|(frame, panel)| (frame, panel.x, panel.y))
            .collect();
        for (frame, panel) in self.panels.iter().zip(panels) {
            let mut alike = axes
                .iter()
                .filter(|it| it.0.x == frame.x && it.0.y == frame.y);
            if let Some(&(_, mut x, mut y)) = alike.next() {
                for (_, other_x, other_y) in alike {
                    x = (x.0.min(other_x.0), x.1.max(other_x.1));
                    y = (y.0.min(other_y.0), y.1.max(other_y.1));
                }
                [panel.x, panel.y] = [x, y];
            }
        }
    }
}

/// The label of a time (s) in the units of a scene.
pub(super) fn in_units(label: &str, units: Units) -> String {
    match units {
        Units::OfSpheres if label.starts_with("time") => {
            label.replace("(s)", "over $τ$ = √($d$/$g$)")
        }
        Units::OfSpheres | Units::Si => label.to_owned(),
    }
}

/// Colours of guides.
pub(super) const GUIDES: [RGBColor; 2] = [RGBColor(0x50, 0x50, 0x50), palette::GUIDE];

/// Colour of a run by its number: of few they are as different as can be, of many in order.
pub(super) fn color(index: usize, count: usize) -> RGBColor {
    match palette::DISTINCT.get(index) {
        Some(color) if count <= palette::DISTINCT.len() => *color,
        _ => palette::mapped(
            ColorMap::Sequential,
            index as f64 / (count - 1).max(1) as f64,
        ),
    }
}

impl OverlayPanel {
    /// The panel of the curves of all runs, and of guides.
    fn panel<'c>(
        &self,
        curves: impl ExactSizeIterator<Item = &'c RunCurve>,
        guides: &[Guide],
    ) -> ChartPanel {
        let count = curves.len();
        let (mut lines, mut bars) = (Vec::new(), Vec::new());
        lines.extend(guides.iter().zip(GUIDES).map(|(guide, color)| ChartLine {
            points: guide.points.clone(),
            color,
        }));
        for (index, curve) in curves.enumerate() {
            let color = color(index, count);
            let points = curve.points.iter().copied();
            let drawable = |point: &(f64, f64)| {
                let is_positive = match self.y {
                    PanelScale::Free | PanelScale::FromZero => true,
                    PanelScale::Logarithmic => point.1 > 0.0,
                    PanelScale::Decades => point.0 > 0.0 && point.1 > 0.0,
                };
                point.1.is_finite() && is_positive
            };
            lines.push(ChartLine {
                points: points.clone().filter(drawable).collect(),
                color,
            });
            let intervals = points.zip(&curve.half_widths);
            let intervals = intervals.filter(|(at, _)| drawable(at));
            bars.extend(intervals.map(|(at, half)| Bar::about(at, *half, color)));
        }
        let places = lines.iter().flat_map(|line| &line.points);
        let (low, high) = chart::ends(places.map(|point| point.0));
        // Dots at the ends of an axis of their own would be cut in half.
        let is_dotted = !bars.is_empty() && self.y != PanelScale::Decades;
        let margin = if is_dotted { 0.02 * (high - low) } else { 0.0 };
        let x = self.x.unwrap_or(if low < high {
            (low - margin, high + margin)
        } else if low == high && low > 0.0 {
            // One place.
            (0.5 * low, 2.0 * low)
        } else {
            (0.0, 1.0)
        });
        let is_inside = |point: &(f64, f64)| (x.0..=x.1).contains(&point.0);
        for line in &mut lines {
            line.points.retain(is_inside);
        }
        bars.retain(|bar| is_inside(&bar.at));
        let head = Vec::from_iter((!self.head.is_empty()).then(|| self.head.to_owned()));
        let panel = ChartPanel::new(head, x, lines).with_bars(bars);
        match self.y {
            PanelScale::Free => panel,
            PanelScale::FromZero => panel.down_to_zero(),
            PanelScale::Logarithmic => panel.logarithmic(),
            PanelScale::Decades => panel.logarithmic_both(),
        }
    }
}
