//! Which effects a scene needs: how many labels change without each, and what that saves.

use super::axes::Plot;
use super::canvas::Drawn;
use super::legend::{LegendEntry, LegendKey};
use super::page::{FigurePage, PagePlan, PanelFrame};
use super::scale::AxisSpan;
use super::style::px;
use super::svg::Svg;
use super::ticks::Ticks;
use super::{Figure, PlotError, StudyResult, palette};
use crate::record::Program;
use crate::study::ablation::{Ablated, Verdict};
use crate::study::comparison::Cost;
use crate::sweep::Sweep;
use plotters::element::{Circle, ErrorBar, PathElement, Rectangle};
use plotters::style::{Color, RGBColor};

/// Height of a row.
const ROW: i32 = px(20);
/// Half the width of a bar, in rows.
const HALF: f64 = 0.3;

pub(super) fn figure() -> Figure {
    let description = "labels that change without each effect, and the time that this saves";
    Figure::of_study("ablation", description, |study, program| match study {
        StudyResult::Ablation(ablation, ablated, cost) => {
            Some(draw(ablated, cost, &ablation.comparison.sweep, program))
        }
        _ => None,
    })
}

/// Draws a row for each simplification: the share of labels that it changes beyond the noise of
/// seeds with its interval, and its time over that of the scene as it is, whose cost is `cost`.
fn draw(
    ablated: &[Ablated],
    cost: &Cost,
    sweep: &Sweep,
    program: &Program,
) -> Result<Svg, PlotError> {
    if ablated.is_empty() {
        return Err(PlotError::no_measures("ablation"));
    }
    let title = sweep
        .title
        .clone()
        .or_else(|| sweep.scene.title.clone())
        .unwrap_or_default();
    let title = match title.as_str() {
        "" => "Which effects decide".to_owned(),
        title => format!("{title}: which effects decide"),
    };
    let occurs = |verdict: &Verdict| ablated.iter().any(|it| it.verdict == *verdict);
    let verdicts = [Verdict::Needed, Verdict::NotNeeded, Verdict::Undecided];
    let legend = verdicts.into_iter().filter(occurs);
    let legend = legend.map(|it| LegendEntry::new(LegendKey::Dot(color(it)), it.words()));
    let frames = frames(ablated, cost);
    let page = FigurePage::new(PagePlan {
        title: Some(&title),
        frames: frames.clone(),
        columns: 2,
        height: ROW * (ablated.len() as i32 + 1),
        legend: legend.collect(),
        ..PagePlan::default()
    });
    let body = page.draw(|sheet| {
        let changed = page.axes(sheet, 0)?;
        let time = page.axes(sheet, 1)?;
        let rows = ablated.len() as f64;
        guide(changed.plot(), [(0.0, rows), (0.0, -1.0)])?;
        guide(time.plot(), [(1.0, rows), (1.0, -1.0)])?;
        for (row, it) in ablated.iter().enumerate() {
            let (row, ink) = (row as f64, color(it.verdict));
            if let Some(labels) = &it.states.disagreement {
                let [low, value, high] =
                    [labels.excess.low, labels.excess.value, labels.excess.high]
                        .map(|share| 100.0 * share);
                let bar = ink.filled().stroke_width(12);
                let plot = changed.plot();
                plot.draw(&ErrorBar::new_horizontal(
                    row,
                    low,
                    value,
                    high,
                    bar,
                    px(6) as u32,
                ))?;
                sheet.draw(&Circle::new(
                    plot.map_coordinate(&(value, row)),
                    px(4),
                    ink.filled(),
                ))?;
            }
            let ratio = ratio(it, cost);
            let corners = [(0.0, row - HALF), (ratio, row + HALF)];
            time.plot()
                .draw(&Rectangle::new(corners, ink.mix(0.7).filled()))?;
        }
        changed.draw()?;
        time.draw()
    })?;
    Ok(Svg::of_program("ablation", title, program, &body))
}

/// Time over that of the scene as it is.
fn ratio(it: &Ablated, cost: &Cost) -> f64 {
    match cost.cpu_seconds {
        base if base > 0.0 => it.cost.cpu_seconds / base,
        _ => 0.0,
    }
}

/// The panel of labels, and that of times.
fn frames(ablated: &[Ablated], cost: &Cost) -> Vec<PanelFrame> {
    let names = ablated.iter().enumerate();
    let names = names
        .map(|(row, it)| (row as f64, it.name.clone()))
        .collect();
    let y = AxisSpan {
        ticks: Ticks::Given(names),
        ..AxisSpan::linear((ablated.len() as f64, -1.0))
    };
    let labels = ablated
        .iter()
        .filter_map(|it| it.states.disagreement.as_ref());
    let (low, high) = labels.fold((0.0_f64, 1.0_f64), |(low, high), it| {
        (
            low.min(100.0 * it.excess.low),
            high.max(100.0 * it.excess.high),
        )
    });
    let most = ablated.iter().map(|it| ratio(it, cost)).fold(1.0, f64::max);
    vec![
        PanelFrame {
            head: vec!["labels changed beyond the noise of seeds (%)".to_owned()],
            x: AxisSpan::linear((low - 2.0, 1.05 * high)),
            y: y.clone(),
        },
        PanelFrame {
            head: vec!["processor time / that of the scene as it is".to_owned()],
            x: AxisSpan::linear((0.0, 1.05 * most)),
            y,
        },
    ]
}

fn guide(plot: &Plot<'_>, ends: [(f64, f64); 2]) -> Drawn {
    plot.draw(&PathElement::new(ends, palette::GUIDE.stroke_width(12)))
}

/// Dark where a scene needs an effect.
fn color(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Needed => palette::LINES[0],
        Verdict::NotNeeded => palette::LINES[2],
        Verdict::Undecided => palette::LINES[3],
    }
}
