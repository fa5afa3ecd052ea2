//! The discharge rate of a silo over the width of its opening, with the law of Beverloo fitted to
//! it.

use super::chart::{Bar, Chart, Line, Panel, ends, samples};
use super::grid::GridAxis;
use super::series::{self, Series};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::beverloo::{self, Bed, Discharge, Fit};
use crate::classify::{Family, Point, SILO, Verdict};
use crate::statistics::Estimate;
use std::f64::consts::PI;

/// The discharge rate over the opening.
pub(super) struct Beverloo;

const OPENING: &str = "geometry.opening";

/// The law fitted to the runs of one line of the figure.
#[derive(Clone, Debug)]
pub struct FittedLine {
    /// Values on the axes besides the opening, such as `μ = 0.2`; empty without such axes.
    pub name: String,
    /// The bed of these runs at rest, mean over all.
    pub bed: Bed,
    /// The fit to all runs that have a rate.
    pub fit: Fit,
    /// Number of runs without one: their outflow stopped, or did not end.
    pub without_rate: usize,
}

impl Figure for Beverloo {
    fn name(&self) -> &'static str {
        "beverloo"
    }

    fn description(&self) -> String {
        "discharge rate over the opening, with the law of Beverloo fitted (two dimensions)"
            .to_owned()
    }

    fn family(&self) -> Option<&'static Family> {
        Some(&SILO)
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let axis = axis(source)?;
        let (lines, left_out) = series::lines(source, &axis)?;
        let fitted = lines
            .iter()
            .map(|line| fitted(source, line))
            .collect::<Result<Vec<_>, _>>()?;
        let widest = axis.shown().last().copied().unwrap_or(1.0);
        let mut panel = Panel {
            x: (0.0, 1.05 * widest),
            ..Panel::default()
        };
        for (line, fitted) in lines.iter().zip(&fitted) {
            panel.lines.push(curve(fitted, line, &axis, panel.x.1));
            panel.bars.extend(bars(source, line, axis.factor));
        }
        let bars = panel.bars.iter().map(|bar| bar.ends()[1]);
        let curves = panel.lines.iter().flat_map(|line| &line.points);
        let tops = bars.chain(curves.map(|point| point.1));
        panel.y = (0.0, 1.03 * tops.fold(0.0, f64::max));
        let legend = lines.iter().zip(&fitted);
        Chart {
            name: self.name(),
            common: vec!["$W$ = $C$ √$g$ $n$ ($D$ − $k$ $d$)³⁄²".to_owned()],
            columns: 1,
            height: px(400),
            panels: vec![panel],
            x_label: axis.label(),
            y_label: "discharge rate $W$ (grains/s)".to_owned(),
            legend: legend
                .map(|(line, fitted)| (line.color, entry(&line.name, &fitted.fit)))
                .collect(),
            notes: notes(&fitted).into_iter().chain(left_out).collect(),
        }
        .draw(source)
    }
}

/// The law fitted to each line that the figure `beverloo` shows.
///
/// # Errors
/// Those of drawing the figure.
pub fn fitted_lines(source: &Source<'_>) -> Result<Vec<FittedLine>, PlotError> {
    let (lines, _) = series::lines(source, &axis(source)?)?;
    lines.iter().map(|line| fitted(source, line)).collect()
}

fn axis(source: &Source<'_>) -> Result<GridAxis, PlotError> {
    let mut axes = source.sweep.axes.iter();
    let index = axes.position(|axis| axis.key == OPENING);
    let index = index.ok_or(PlotError::NeedsAxis {
        figure: Beverloo.name(),
        key: OPENING,
    })?;
    Ok(GridAxis::new(index, source.sweep, source.table))
}

/// Verdicts on the runs of a line, each with its opening (m).
fn runs<'a>(source: &'a Source<'_>, line: &'a Series) -> impl Iterator<Item = (f64, &'a Verdict)> {
    line.points.iter().flat_map(|(opening, point)| {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        rows.map(|row| (*opening, &row.verdict))
    })
}

fn fitted(source: &Source<'_>, line: &Series) -> Result<FittedLine, PlotError> {
    let name = super::text::plain(&line.name);
    let fail = |reason: String| PlotError::Fit {
        line: if name.is_empty() {
            "the fit".to_owned()
        } else {
            name.clone()
        },
        reason,
    };
    let bed = bed(source, line).ok_or_else(|| {
        let reason = "the law needs gravity and runs with a packing fraction at rest, in a scene \
                      with [rest] and snapshots";
        fail(reason.to_owned())
    })?;
    let measured = runs(source, line).filter_map(|(opening, verdict)| {
        let rate = verdict.value("discharge_rate")?;
        Some(Discharge { opening, rate })
    });
    let measured: Vec<Discharge> = measured.collect();
    let fit = beverloo::fit(&measured, &bed).map_err(|error| fail(error.to_string()))?;
    Ok(FittedLine {
        without_rate: runs(source, line).count() - measured.len(),
        name,
        bed,
        fit,
    })
}

/// The bed of a line: its packing fraction at rest, mean over all runs, over the mean area of a
/// grain.
fn bed(source: &Source<'_>, line: &Series) -> Option<Bed> {
    // Other axes may change the grains or gravity from line to line.
    let (_, point) = line.points.first()?;
    let scene = source.sweep.scene_at(&point.values).ok()?;
    let fractions: Vec<f64> = runs(source, line)
        .filter_map(|(_, verdict)| verdict.value("packing_fraction"))
        .collect();
    let fraction = Estimate::of_mean(&fractions)?.value;
    Some(Bed {
        gravity: scene.dem.effects.gravity.as_ref()?.acceleration,
        number_density: fraction / (PI * scene.spheres.radius.mean_square()),
        diameter: 2.0 * scene.spheres.radius.mean(),
    })
}

fn curve(fitted: &FittedLine, line: &Series, axis: &GridAxis, end: f64) -> Line {
    let constants = [fitted.fit.c.value, fitted.fit.k.value];
    // From the width at which the rate is zero, as the axis shows it.
    let from = axis.factor * fitted.bed.diameter * constants[1].max(0.0);
    let rate = |shown: f64| {
        let opening = shown / axis.factor;
        (shown, fitted.bed.discharge_rate(opening, constants))
    };
    Line {
        points: samples(from, end).map(rate).collect(),
        color: line.color,
    }
}

/// Means over the seeds.
fn bars(source: &Source<'_>, line: &Series, factor: f64) -> Vec<Bar> {
    let bar = |(opening, point): &(f64, Point)| {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        let rates = rows.filter_map(|row| row.verdict.value("discharge_rate"));
        let mean = Estimate::of_mean(&rates.collect::<Vec<_>>())?;
        let at = (opening * factor, mean.value);
        Some(Bar::about(at, mean.half_width, line.color))
    };
    line.points.iter().filter_map(bar).collect()
}

/// `value ± half`, to the digits that the interval leaves.
fn interval(estimate: Estimate) -> String {
    let Estimate { value, half_width } = estimate;
    let decimals = match half_width {
        half if half > 0.0 && half < 1.0 => 1 - libm::floor(libm::log10(half)) as i32,
        _ => 1,
    };
    let decimals = decimals.clamp(1, 9) as usize;
    let number = format!("{value:.decimals$} ± {half_width:.decimals$}");
    number.replace('-', "−")
}

/// Entry of the legend for a line with its fit.
fn entry(name: &str, fit: &Fit) -> String {
    let constants = format!("$C$ = {}, $k$ = {}", interval(fit.c), interval(fit.k));
    match name {
        "" => constants,
        name => format!("{name}: {constants}"),
    }
}

fn notes(lines: &[FittedLine]) -> Vec<String> {
    let fitted: usize = lines.iter().map(|line| line.fit.discharges).sum();
    let without: usize = lines.iter().map(|line| line.without_rate).sum();
    let left_out = match without {
        0 => String::new(),
        without => format!(" {without} runs whose outflow stopped or did not end have no rate."),
    };
    let (least, most) = ends(lines.iter().map(|line| line.bed.number_density));
    let range = match (format!("{least:.0}"), format!("{most:.0}")) {
        (least, most) if least == most => most,
        (least, most) => format!("{least} to {most}"),
    };
    vec![
        format!(
            "Points: means over the seeds with 95 % intervals. Lines: fitted by least squares to \
             the rates of {fitted} runs.{left_out} ±: 95 % intervals of the linearised fit \
             (Student's t)."
        ),
        format!(
            "$n$: grains per area of the bed at rest, {range} /m²; $d$: mean diameter of the \
             grains. Law: Beverloo et al. (1961); exponent: Franklin and Johanson (1955)."
        ),
    ]
}
