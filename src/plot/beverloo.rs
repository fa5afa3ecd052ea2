//! The discharge rate of a silo over the width of its opening, with the law of Beverloo fitted to
//! it.

use super::chart::{Bar, Chart, ChartLine, ChartPanel, ends, samples};
use super::grid::GridAxis;
use super::numbers;
use super::series::{self, PointSeries};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source};
use crate::beverloo::{self, Discharge, Fit, GrainBed, Opening};
use crate::classify::{DRAINAGE, Family, Point, SILO, Verdict};
use crate::grid::variant_at;
use crate::scene::{Scene, Units};
use crate::statistics::Estimate;
use std::f64::consts::PI;

/// Name of the figure.
const NAME: &str = "beverloo";

/// What spheres leave through, and where the numbers of the law stand.
struct VariedOutlet {
    /// Key of the opening.
    key: &'static str,
    /// Width D of the opening over the value of the key.
    width: f64,
    opening: Opening,
    /// The family of such scenes.
    family: &'static Family,
    /// Measure of the discharge rate (spheres/s).
    rate: &'static str,
    /// Measure of the packing fraction at rest.
    packing: &'static str,
}

static OUTLETS: [VariedOutlet; 3] = [
    VariedOutlet {
        key: "geometry.opening",
        width: 1.0,
        opening: Opening::Flat,
        family: &SILO,
        rate: "discharge_rate",
        packing: "packing_fraction",
    },
    VariedOutlet {
        key: "tank.orifice_radius",
        width: 2.0,
        opening: Opening::Round,
        ..SLIT
    },
    SLIT,
];

/// A slit as long as its box is deep.
const SLIT: VariedOutlet = VariedOutlet {
    key: "tank.slit_width",
    width: 1.0,
    opening: Opening::Flat,
    family: &DRAINAGE,
    rate: "outflow_rate",
    packing: "start_packing_fraction",
};

impl VariedOutlet {
    /// The outlet that a sweep varies, and its axis.
    fn of(source: &Source<'_>) -> Result<(&'static Self, GridAxis), PlotError> {
        let own = || OUTLETS.iter().filter(|it| it.family == source.table.family);
        let axes = source.sweep.axes.iter().enumerate();
        let found = axes.flat_map(|(index, axis)| {
            own()
                .filter(|it| it.key == axis.key)
                .map(move |outlet| (outlet, index))
        });
        let (outlet, index) = found.last().ok_or_else(|| {
            let key = own().map(|it| it.key).next().unwrap_or_default();
            PlotError::request(format_args!(
                "the figure `{NAME}` needs a sweep over `{key}`"
            ))
        })?;
        let axis = GridAxis::new(index, source.sweep, source.table);
        Ok((outlet, axis))
    }

    /// Width of an opening over the value of the axis on a line, whose variant may scale it.
    fn width_of(&self, source: &Source<'_>, line: &PointSeries) -> f64 {
        let axes = &source.sweep.axes;
        let name = axes.iter().find(|axis| axis.key == self.key);
        let point = line.points.first();
        let factor = name.zip(point).and_then(|(axis, (_, point))| {
            Some(variant_at(axes, &point.values)?.factor(&axis.name))
        });
        factor.unwrap_or(1.0) * self.width
    }

    /// Number n of grains of a bed of that packing fraction: per area (1/m2) or volume (1/m3), as
    /// the law has it.
    fn number_density(&self, packing: f64, scene: &Scene) -> f64 {
        let radius = &scene.spheres.radius;
        let depth = scene.tank.as_ref().and_then(|tank| tank.depth);
        match (self.opening, depth) {
            (Opening::Flat, Some(depth)) => packing * depth / radius.mean_volume(),
            (Opening::Flat, None) => packing / (PI * radius.mean_square()),
            (Opening::Round, _) => packing / radius.mean_volume(),
        }
    }
}

/// The law fitted to the runs of one line of the figure.
#[derive(Clone, Debug)]
pub struct FittedLaw {
    /// Values on the axes besides the opening, such as `μ = 0.2`; empty without such axes.
    pub name: String,
    /// The bed of these runs at rest, mean over all.
    pub bed: GrainBed,
    /// The fit to all runs that have a rate.
    pub fit: Fit,
    /// Number of runs without one: their outflow stopped, or did not end.
    pub without_rate: usize,
}

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "discharge rate over the opening, with the law of Beverloo fitted",
        draw,
    )
    .for_families([&SILO, &DRAINAGE])
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    let (outlet, axis) = VariedOutlet::of(source)?;
    let (lines, left_out) = series::lines(source, &axis)?;
    let fitted = lines
        .iter()
        .map(|line| fitted(source, outlet, line))
        .collect::<Result<Vec<_>, _>>()?;
    let widest = axis.shown().last().copied().unwrap_or(1.0);
    let mut panel = ChartPanel {
        x: (0.0, 1.05 * widest),
        ..ChartPanel::default()
    };
    for (line, fitted) in lines.iter().zip(&fitted) {
        let width = outlet.width_of(source, line) / axis.factor;
        panel.lines.push(curve(fitted, line, width, panel.x.1));
        panel.bars.extend(bars(source, outlet, line, axis.factor));
    }
    let bars = panel.bars.iter().map(|bar| bar.ends()[1]);
    let curves = panel.lines.iter().flat_map(|line| &line.points);
    let tops = bars.chain(curves.map(|point| point.1));
    panel.y = (0.0, 1.03 * tops.fold(0.0, f64::max));
    let legend = lines.iter().zip(&fitted);
    let units = source.sweep.units();
    Chart {
        name: NAME,
        common: vec![law(outlet)],
        columns: 1,
        height: px(400),
        panels: vec![panel],
        x_label: axis.label(),
        y_label: format!("discharge rate $W$ (grains/{})", units.of_time()),
        legend: legend
            .map(|(line, fitted)| (line.color, entry(&line.name, &fitted.fit)))
            .collect(),
        notes: notes(&fitted, outlet, units)
            .into_iter()
            .chain(left_out)
            .collect(),
    }
    .draw(&source.origin())
}

/// The law fitted to each line that the figure `beverloo` shows.
///
/// # Errors
/// Those of drawing the figure.
pub fn fitted_lines(source: &Source<'_>) -> Result<Vec<FittedLaw>, PlotError> {
    let (outlet, axis) = VariedOutlet::of(source)?;
    let (lines, _) = series::lines(source, &axis)?;
    lines
        .iter()
        .map(|line| fitted(source, outlet, line))
        .collect()
}

/// The law, with markup.
fn law(outlet: &VariedOutlet) -> String {
    let (exponent, width) = match outlet.opening {
        Opening::Flat => ("³⁄²", ""),
        Opening::Round => ("⁵⁄²", ", $D$ = 2 $R_o$"),
    };
    format!("$W$ = $C$ √$g$ $n$ ($D$ − $k$ $d$){exponent}{width}")
}

/// Verdicts on the runs of a line, each with the value of the opening's key.
fn runs<'a>(
    source: &'a Source<'_>,
    line: &'a PointSeries,
) -> impl Iterator<Item = (f64, &'a Verdict)> {
    line.points.iter().flat_map(|(opening, point)| {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        rows.map(|row| (*opening, &row.verdict))
    })
}

fn fitted(
    source: &Source<'_>,
    outlet: &VariedOutlet,
    line: &PointSeries,
) -> Result<FittedLaw, PlotError> {
    let name = super::text::plain(&line.name);
    let fail = |reason: String| {
        let line = if name.is_empty() { "the fit" } else { &name };
        PlotError::file(format_args!("{line}: {reason}"))
    };
    let bed = bed(source, outlet, line).ok_or_else(|| {
        let reason = "the law needs gravity and runs with a packing fraction at rest, in a scene \
                      with [rest], if it is a silo, and snapshots";
        fail(reason.to_owned())
    })?;
    let width_of_value = outlet.width_of(source, line);
    let measured = runs(source, line).filter_map(|(opening, verdict)| {
        let rate = verdict.value(outlet.rate)?;
        let width = width_of_value * opening;
        Some(Discharge { width, rate })
    });
    let measured: Vec<Discharge> = measured.collect();
    let fit = beverloo::fit(&measured, &bed).map_err(|error| fail(error.to_string()))?;
    Ok(FittedLaw {
        without_rate: runs(source, line).count() - measured.len(),
        name,
        bed,
        fit,
    })
}

/// The bed of a line, with the packing fraction at rest as the mean over all runs.
fn bed(source: &Source<'_>, outlet: &VariedOutlet, line: &PointSeries) -> Option<GrainBed> {
    // Other axes may change the grains or gravity from line to line.
    let (_, point) = line.points.first()?;
    let scene = source.sweep.scene_at(&point.values).ok()?;
    let fractions: Vec<f64> = runs(source, line)
        .filter_map(|(_, verdict)| verdict.value(outlet.packing))
        .collect();
    let fraction = Estimate::of_mean(&fractions)?.value;
    Some(GrainBed {
        gravity: scene.dem.effects.gravity.as_ref()?.acceleration,
        number_density: outlet.number_density(fraction, &scene),
        diameter: 2.0 * scene.spheres.radius.mean(),
        opening: outlet.opening,
    })
}

/// The fitted law up to `end` of the axis; `width`: width of an opening over its value there.
fn curve(fitted: &FittedLaw, line: &PointSeries, width: f64, end: f64) -> ChartLine {
    let constants = [fitted.fit.c.value, fitted.fit.k.value];
    // From the width at which the rate is zero, as the axis shows it.
    let from = fitted.bed.diameter * constants[1].max(0.0) / width;
    let rate = |shown: f64| {
        let rate = fitted.bed.discharge_rate(shown * width, constants);
        (shown, rate)
    };
    ChartLine {
        points: samples(from, end).map(rate).collect(),
        color: line.color,
    }
}

/// Means over the seeds.
fn bars(source: &Source<'_>, outlet: &VariedOutlet, line: &PointSeries, factor: f64) -> Vec<Bar> {
    let bar = |(opening, point): &(f64, Point)| {
        let rows = point.rows.iter().map(|&row| &source.table.rows[row]);
        let rates = rows.filter_map(|row| row.verdict.value(outlet.rate));
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

fn notes(lines: &[FittedLaw], outlet: &VariedOutlet, units: Units) -> Vec<String> {
    let fitted: usize = lines.iter().map(|line| line.fit.discharges).sum();
    let without: usize = lines.iter().map(|line| line.without_rate).sum();
    let left_out = match without {
        0 => String::new(),
        1 => " One run whose outflow stopped or did not end has no rate.".to_owned(),
        without => format!(" {without} runs whose outflow stopped or did not end have no rate."),
    };
    let (least, most) = ends(lines.iter().map(|line| line.bed.number_density));
    let range = match [least, most].map(|it| numbers::rounded(it, 3)) {
        [least, most] if least == most => most,
        [least, most] => format!("{least} to {most}"),
    };
    let (per, power, exponent) = match outlet.opening {
        Opening::Flat => ("area", '²', "; exponent: Franklin and Johanson (1955)"),
        Opening::Round => ("volume", '³', ""),
    };
    let unit = units.shown("m");
    vec![
        format!(
            "Points: means over the seeds with 95 % intervals. Lines: fitted by least squares to \
             the rates of {fitted} runs.{left_out} ±: 95 % intervals of the linearised fit \
             (Student's t)."
        ),
        format!(
            "$n$: grains per {per} of the bed at rest, {range} /{unit}{power}; $d$: mean diameter \
             of the grains. Law: Beverloo et al. (1961){exponent}."
        ),
    ]
}
