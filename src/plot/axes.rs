//! The frame of a panel with the ticks of its scales.

use super::canvas::{Canvas, Drawn, Failed, FigureSheet};
use super::scale::AxisScale;
use super::style::{self, TICK, frame, letters};
use plotters::chart::{ChartBuilder, ChartContext, LabelAreaPosition};
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;
use plotters::style::text_anchor::{HPos, VPos};

/// A panel with its coordinates.
pub(super) type Plot<'a> = DrawingArea<Canvas<'a>, Cartesian2d<AxisScale, AxisScale>>;

pub(super) struct Axes<'s, 'c> {
    sheet: &'s FigureSheet<'c>,
    chart: ChartContext<'s, Canvas<'c>, Cartesian2d<AxisScale, AxisScale>>,
    corners: style::Corners,
    /// Sizes of the letters of the labels of both scales.
    letters: (i32, i32),
}

impl<'s, 'c> Axes<'s, 'c> {
    /// A panel with its upper left corner at `corner`, `ticks` being the room for tick labels left
    /// of it and below; zero for no labels.
    pub(super) fn new(
        sheet: &'s FigureSheet<'c>,
        (left, top): (i32, i32),
        (width, height): (i32, i32),
        ticks: (i32, i32),
        scales: (AxisScale, AxisScale),
    ) -> Result<Self, Failed> {
        let area = sheet
            .clone()
            .shrink((left - ticks.0, top), (width + ticks.0, height + ticks.1));
        let letters = (scales.0.letters, scales.1.letters);
        let chart = ChartBuilder::on(&area)
            .set_label_area_size(LabelAreaPosition::Left, ticks.0)
            .set_label_area_size(LabelAreaPosition::Bottom, ticks.1)
            .build_cartesian_2d(scales.0, scales.1)?;
        Ok(Self {
            sheet,
            chart,
            corners: [(left, top), (left + width, top + height)],
            letters,
        })
    }

    /// The inside of the frame, to draw on before the frame is drawn.
    pub(super) fn plot(&self) -> &Plot<'c> {
        self.chart.plotting_area()
    }

    /// Draws frame and ticks.
    pub(super) fn draw(mut self) -> Drawn {
        style::outline(self.sheet, self.corners, frame())?;
        self.chart
            .configure_mesh()
            .disable_mesh()
            .axis_style(frame())
            .x_label_style(letters(self.letters.0, HPos::Center, VPos::Center))
            .y_label_style(letters(self.letters.1, HPos::Center, VPos::Center))
            .set_tick_mark_size(LabelAreaPosition::Left, TICK)
            .set_tick_mark_size(LabelAreaPosition::Bottom, TICK)
            .draw()
    }
}
