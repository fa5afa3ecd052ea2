//! Errors of all verification cases over what they may be.

use super::axes::Plot;
use super::canvas::{Drawn, FigureSheet};
use super::legend::{LegendEntry, LegendKey};
use super::page::{FigurePage, PagePlan, PanelFrame};
use super::scale::AxisSpan;
use super::style::px;
use super::svg::Svg;
use super::ticks::Ticks;
use super::{Figure, PlotError, StudyResult, palette};
use crate::record::Program;
use crate::scene::Integrator;
use plotters::element::{Circle, PathElement};
use plotters::style::Color;

/// What became of a case with one integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseError {
    /// The family and the name of the case.
    pub name: String,
    /// The integrator.
    pub integrator: Integrator,
    /// Largest error of its quantities, over the tolerance.
    pub ratio: f64,
}

/// Ends of the axis of ratios, as powers of ten; ratios beyond are drawn at its ends.
const DECADES: (i32, i32) = (-6, 1);
/// Height of a row.
const ROW: i32 = px(15);
/// Size of the letters of a row.
const LETTERS: i32 = px(10);
/// Title of the figure.
const TITLE: &str = "Verification";

pub(super) fn figure() -> Figure {
    let description = "errors of the cases of `phase verify` over their tolerances";
    Figure::of_study("verification", description, |study, program| match study {
        StudyResult::Verification(errors) => Some(draw(errors, program)),
        _ => None,
    })
}

/// Draws a dot for every case and integrator, at its error over the tolerance.
fn draw(errors: &[CaseError], program: &Program) -> Result<Svg, PlotError> {
    let mut rows: Vec<&str> = errors.iter().map(|error| error.name.as_str()).collect();
    rows.dedup();
    let is_used =
        |integrator: &Integrator| errors.iter().any(|error| error.integrator == *integrator);
    let entries = Integrator::ALL.into_iter().filter(is_used);
    let entries = entries.map(|it| LegendEntry::new(LegendKey::Dot(color(it)), it.name()));
    let page = FigurePage::new(PagePlan {
        title: Some(TITLE),
        frames: vec![frame(&rows)],
        columns: 1,
        height: ROW * (rows.len() as i32 + 1),
        labels: ["largest error over the tolerance".to_owned(), String::new()],
        legend: entries.collect(),
        ..PagePlan::default()
    });
    let body = page.draw(|sheet| {
        let axes = page.axes(sheet, 0)?;
        draw_guides(axes.plot(), rows.len())?;
        for error in errors {
            let row = rows.iter().position(|name| *name == error.name);
            draw_dot(sheet, axes.plot(), error, row.unwrap_or(0))?;
        }
        axes.draw()
    })?;
    Ok(Svg::of_program(
        "verification",
        TITLE.to_owned(),
        program,
        &body,
    ))
}

/// Powers of ten across, and the cases from above.
fn frame(rows: &[&str]) -> PanelFrame {
    let power = |power: i32| {
        let label = match power {
            low if low == DECADES.0 => format!("≤ 1e{low}"),
            0 => "1".to_owned(),
            1 => "≥ 10".to_owned(),
            power => format!("1e{power}"),
        };
        (f64::from(power), label)
    };
    let name = |(row, name): (usize, &&str)| (row as f64, (*name).to_owned());
    let x = (f64::from(DECADES.0), f64::from(DECADES.1));
    PanelFrame {
        head: Vec::new(),
        x: AxisSpan {
            ticks: Ticks::Given((DECADES.0..=DECADES.1).map(power).collect()),
            ..AxisSpan::linear(x)
        },
        y: AxisSpan {
            ticks: Ticks::Given(rows.iter().enumerate().map(name).collect()),
            letters: Some(LETTERS),
            ..AxisSpan::linear((rows.len() as f64, -1.0))
        },
    }
}

/// Draws a line for each row, and one where errors are as large as they may be.
fn draw_guides(plot: &Plot<'_>, rows: usize) -> Drawn {
    let (low, high) = (f64::from(DECADES.0), f64::from(DECADES.1));
    for row in 0..rows {
        let ends = [(low, row as f64), (high, row as f64)];
        let ink = palette::GUIDE.mix(0.5).stroke_width(4);
        plot.draw(&PathElement::new(ends, ink))?;
    }
    let limit = [(0.0, rows as f64), (0.0, -1.0)];
    plot.draw(&PathElement::new(limit, palette::GUIDE.stroke_width(16)))
}

fn draw_dot(sheet: &FigureSheet<'_>, plot: &Plot<'_>, error: &CaseError, row: usize) -> Drawn {
    // An error of zero has no logarithm, and belongs to the left end.
    let power = match error.ratio {
        ratio if ratio > 0.0 => libm::log10(ratio),
        _ => f64::from(DECADES.0),
    };
    let power = power.clamp(f64::from(DECADES.0), f64::from(DECADES.1));
    let (x, y) = plot.map_coordinate(&(power, row as f64));
    // One integrator above the other, or equal errors would hide each other.
    let middle = px(2) * (Integrator::ALL.len() as i32 - 1);
    let shift = px(4) * index_of(error.integrator) as i32 - middle;
    let dot = color(error.integrator).filled();
    sheet.draw(&Circle::new((x, y + shift), px(3), dot))
}

fn color(integrator: Integrator) -> plotters::style::RGBColor {
    palette::LINES[index_of(integrator) % palette::LINES.len()]
}

/// Place of an integrator among all.
fn index_of(integrator: Integrator) -> usize {
    let mut all = Integrator::ALL.into_iter();
    all.position(|it| it == integrator).unwrap_or(0)
}
