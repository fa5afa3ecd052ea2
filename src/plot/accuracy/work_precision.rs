//! Error against processor time, one line per method: a work-precision diagram.

use super::color;
use crate::plot::axes::Plot;
use crate::plot::canvas::{Drawn, FigureSheet};
use crate::plot::legend::{LegendEntry, LegendKey};
use crate::plot::page::{FigurePage, PagePlan, PanelFrame};
use crate::plot::scale::AxisSpan;
use crate::plot::spacing::AxisSpacing;
use crate::plot::style::{self, px};
use crate::plot::svg::Svg;
use crate::plot::{PlotError, palette};
use crate::record::Program;
use crate::study::accuracy::{AccuracyStudy, Errors, Evaluation, Order, Outcome};
use crate::study::comparison::{BASE, Interval};
use plotters::element::{Circle, ErrorBar, PathElement, Rectangle};
use plotters::style::{BLACK, Color, RGBColor};

/// Room beyond the data, as a factor.
const BEYOND: f64 = 1.6;

/// A setting on the figure.
struct Dot<'a> {
    outcome: &'a Outcome,
    /// Processor time of a run (s), and error.
    at: (f64, f64),
    /// Ends of the interval of the error, if it has one.
    ends: Option<[f64; 2]>,
    is_base: bool,
}

/// Draws it.
///
/// # Errors
/// [`PlotError`] if nothing can be drawn.
pub(super) fn draw(
    study: &AccuracyStudy,
    evaluation: &Evaluation,
    program: &Program,
) -> Result<Svg, PlotError> {
    let dots = dots(evaluation);
    if dots.is_empty() {
        return Err(PlotError::no_measures("work-precision"));
    }
    let mut methods: Vec<&str> = Vec::new();
    for dot in dots.iter().filter(|dot| !dot.is_base) {
        if !methods.contains(&dot.outcome.method.as_str()) {
            methods.push(&dot.outcome.method);
        }
    }
    let floor = floor(evaluation);
    let (x, y) = spans(evaluation, &dots, floor);
    let notes = notes(evaluation);
    let page = FigurePage::new(PagePlan {
        title: study.title.as_deref(),
        frames: vec![PanelFrame {
            head: Vec::new(),
            x: x.clone(),
            y: y.clone(),
        }],
        columns: 1,
        height: px(380),
        labels: [
            "processor time of a run (s)".to_owned(),
            error_label(evaluation),
        ],
        legend: legend(evaluation, &methods, floor),
        notes: &notes,
        ..PagePlan::default()
    });
    let body = page.draw(|sheet| {
        let axes = page.axes(sheet, 0)?;
        let plot = axes.plot();
        if let Some(floor) = floor {
            // Lighter where it may end.
            for (top, share) in [(floor.high, 0.15), (floor.value, 0.3)] {
                let corners = [(x.low, top.clamp(y.low, y.high)), (x.high, y.low)];
                plot.draw(&Rectangle::new(corners, palette::GUIDE.mix(share).filled()))?;
            }
        }
        let allowed = allowed(evaluation, floor);
        let ends = [(x.low, allowed), (x.high, allowed)];
        if (y.low..=y.high).contains(&allowed) {
            let pixels = ends.map(|end| plot.map_coordinate(&end));
            style::dashes(sheet, &pixels)?;
        }
        for (index, method) in methods.iter().enumerate() {
            let ink = color(index, methods.len());
            draw_method(sheet, plot, &dots, method, ink)?;
        }
        for dot in dots.iter().filter(|dot| dot.is_base) {
            draw_bar(plot, dot, BLACK)?;
            let ring = Circle::new(plot.map_coordinate(&dot.at), px(5), BLACK.stroke_width(15));
            sheet.draw(&ring)?;
        }
        axes.draw()
    })?;
    let title = study.title.clone().unwrap_or_default();
    Ok(Svg::of_program("work-precision", title, program, &body))
}

/// Settings with a cost and an error above zero. The reference has none.
fn dots(evaluation: &Evaluation) -> Vec<Dot<'_>> {
    let outcomes = evaluation.outcomes.iter().enumerate();
    let dot = |(place, outcome): (usize, &'_ Outcome)| {
        let (seconds, error) = (
            outcome.cost.cpu_seconds,
            outcome.error(evaluation.counted_time)?,
        );
        let is_reference =
            Some(place) == evaluation.reference && !matches!(outcome.errors, Errors::States(_));
        let is_shown = seconds > 0.0 && error > 0.0 && error.is_finite() && !is_reference;
        is_shown
            .then_some(place)
            .map(|place| (place, seconds, error))
    };
    let shown = outcomes.filter_map(dot);
    shown
        .map(|(place, seconds, error)| {
            let outcome = &evaluation.outcomes[place];
            let ends = match &outcome.errors {
                Errors::States(states) => states
                    .disagreement
                    .as_ref()
                    .map(|it| [it.chance.low, it.chance.high]),
                _ => None,
            };
            Dot {
                outcome,
                at: (seconds, error),
                ends,
                is_base: place == BASE,
            }
        })
        .collect()
}

/// The chance that two seeds of the reference disagree.
fn floor(evaluation: &Evaluation) -> Option<Interval> {
    let reference = evaluation.outcomes.get(evaluation.reference?)?;
    match &reference.errors {
        Errors::States(states) => Some(states.disagreement.as_ref()?.floor),
        _ => None,
    }
}

/// The error that is allowed: of labels above the floor.
fn allowed(evaluation: &Evaluation, floor: Option<Interval>) -> f64 {
    match floor {
        Some(floor) => floor.value + evaluation.tolerance.labels,
        None => evaluation.tolerance.error,
    }
}

fn spans(
    evaluation: &Evaluation,
    dots: &[Dot<'_>],
    floor: Option<Interval>,
) -> (AxisSpan, AxisSpan) {
    let logarithmic = |values: &mut dyn Iterator<Item = f64>| {
        let positive = values.filter(|value| *value > 0.0);
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        AxisSpan {
            low: low / BEYOND,
            high: high * BEYOND,
            spacing: AxisSpacing::Logarithmic,
            ..AxisSpan::default()
        }
    };
    let x = logarithmic(&mut dots.iter().map(|dot| dot.at.0));
    let errors = dots.iter().map(|dot| dot.at.1);
    let floors = floor.into_iter().map(|floor| floor.value);
    let y = logarithmic(&mut errors.chain(floors).chain([allowed(evaluation, floor)]));
    (x, y)
}

fn error_label(evaluation: &Evaluation) -> String {
    match &evaluation.outcomes[BASE].errors {
        Errors::States(_) => "chance that labels disagree with the reference".to_owned(),
        Errors::Motion(_) => {
            let at = evaluation
                .counted_time
                .and_then(|time| evaluation.times.get(time));
            match at {
                Some(time) => format!("relative error of the motion at $t$ = {time} s"),
                None => "relative error of the motion".to_owned(),
            }
        }
        Errors::Case(_) => "largest error of the known numbers".to_owned(),
    }
}

fn legend(evaluation: &Evaluation, methods: &[&str], floor: Option<Interval>) -> Vec<LegendEntry> {
    let mut entries = Vec::new();
    for (index, method) in methods.iter().enumerate() {
        let mut orders = evaluation.orders.iter();
        let order = orders.find(|order| order.method == *method && order.is_clear());
        let text = match order {
            Some(it) => match it.order {
                Order::Below(_) => format!("{method} (no measurable influence)"),
                order => format!("{method} (order {})", order.in_words(1)),
            },
            None => (*method).to_owned(),
        };
        entries.push(LegendEntry::new(
            LegendKey::Line(color(index, methods.len())),
            &text,
        ));
    }
    entries.push(LegendEntry::new(
        LegendKey::Ring(BLACK),
        "the scene as it is",
    ));
    entries.push(LegendEntry::new(LegendKey::Dashes, "allowed"));
    if floor.is_some() {
        let fill = style::Fill::Color(palette::lightened(palette::GUIDE, 0.65));
        entries.push(LegendEntry::new(LegendKey::Fill(fill), "noise of seeds"));
    }
    entries
}

fn notes(evaluation: &Evaluation) -> Vec<String> {
    let mut notes = vec![evaluation.finding.sentence.clone()];
    if let Some(time) = evaluation.chaotic_from {
        notes.push(format!(
            "From {time} s on the motion is chaotic: no setting is near the \
                            reference there."
        ));
    }
    notes
}

fn draw_method(
    sheet: &FigureSheet<'_>,
    plot: &Plot<'_>,
    dots: &[Dot<'_>],
    method: &str,
    ink: RGBColor,
) -> Drawn {
    let own = dots
        .iter()
        .filter(|dot| dot.outcome.method == method && !dot.is_base);
    let mut own: Vec<&Dot<'_>> = own.collect();
    own.sort_by(|one, other| {
        let rung = |dot: &Dot<'_>| dot.outcome.rung.as_ref().map_or(0.0, |(_, value)| *value);
        rung(one).total_cmp(&rung(other))
    });
    let pixels: Vec<(i32, i32)> = own.iter().map(|dot| plot.map_coordinate(&dot.at)).collect();
    sheet.draw(&PathElement::new(pixels.clone(), style::line(ink)))?;
    for (dot, pixel) in own.iter().zip(pixels) {
        draw_bar(plot, dot, ink)?;
        sheet.draw(&Circle::new(pixel, px(3), ink.filled()))?;
    }
    Ok(())
}

fn draw_bar(plot: &Plot<'_>, dot: &Dot<'_>, ink: RGBColor) -> Drawn {
    let Some([low, high]) = dot.ends else {
        return Ok(());
    };
    let (x, y) = dot.at;
    // A logarithmic axis has no zero: an interval that reaches it ends where the panel does.
    let low = low.max(1e-3 * y);
    let ink = ink.filled().stroke_width(10);
    plot.draw(&ErrorBar::new_vertical(x, low, y, high, ink, px(6) as u32))
}
