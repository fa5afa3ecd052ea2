//! Progress of a refined sweep: its runs, and how well its borders are known.

use super::{format, job};
use phase::refine::{Finish, Gap, Settings, Width};
use phase::sweep::{Refining, Sweep, label_name};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// The `--json` result of a refined sweep.
#[derive(Serialize)]
pub(super) struct Answer {
    runs: usize,
    budget: usize,
    /// Why refining ended; `None` while it continues.
    end: Option<Finish>,
    borders: Vec<Border>,
}

/// How well a border is known.
#[derive(Serialize)]
struct Border {
    labels: [&'static str; 2],
    axis: String,
    crossings: usize,
    mean: f64,
    widest: f64,
}

impl Answer {
    /// For a sweep with this number of runs; `None` if it is not refined.
    pub(super) fn new(sweep: &Sweep, refining: Option<&Refining>, runs: usize) -> Option<Self> {
        let (settings, refining) = (sweep.refine.as_ref()?, refining?);
        let family = sweep.family();
        let border = |width: &Width| Border {
            labels: width.labels.map(|code| label_name(family, code)),
            axis: sweep.axes[width.axis].name.clone(),
            crossings: width.crossings,
            mean: width.mean,
            widest: width.widest,
        };
        Some(Self {
            runs,
            budget: settings.budget,
            end: refining.end,
            borders: refining.widths.iter().map(border).collect(),
        })
    }
}

/// A part of an axis, as per cent: a small one to two digits.
fn share(share: f64) -> String {
    let percent = 100.0 * share;
    let decimals = match percent {
        percent if percent >= 1.0 || percent <= 0.0 => 1,
        percent => 1 + libm::ceil(-libm::log10(percent)) as usize,
    };
    format!("{percent:.decimals$} %")
}

/// Names the two labels of a border.
fn labels(sweep: &Sweep, width: &Width) -> String {
    let family = sweep.family();
    let [one, other] = width.labels.map(|code| label_name(family, code));
    format!("{one} to {other}")
}

/// The number of borders, and how wide the band of the worst one is.
pub(super) fn describe_widest(sweep: &Sweep, refining: &Refining) -> String {
    match refining.widest() {
        None => "no border yet".to_owned(),
        Some(width) => format!(
            "{}; the widest band ({}) covers {} of {}",
            format::count(refining.widths.len(), "border"),
            labels(sweep, width),
            share(width.mean),
            sweep.axes[width.axis].name
        ),
    }
}

/// One line for each border.
pub(super) fn describe_borders(sweep: &Sweep, refining: &Refining) -> Vec<String> {
    let line = |width: &Width| {
        format!(
            "{}: 95 % band covers {} of {} on average, {} at most ({})",
            labels(sweep, width),
            share(width.mean),
            sweep.axes[width.axis].name,
            share(width.widest),
            format::count(width.crossings, "crossing")
        )
    };
    refining.widths.iter().map(line).collect()
}

/// Why no more runs are made.
pub(super) fn describe_end(settings: &Settings, end: Finish) -> String {
    match (end, settings.width) {
        (Finish::Budget, None) => format!("the budget of {} runs is spent", settings.budget),
        (Finish::Budget, Some(width)) => format!(
            "the budget of {} runs is spent before all bands are as narrow as requested ({})",
            settings.budget,
            share(width)
        ),
        (Finish::Width, width) => format!(
            "the bands of all borders are as narrow as requested ({})",
            share(width.unwrap_or(1.0))
        ),
        (Finish::Complete, _) => "every point has been run with all its seeds".to_owned(),
    }
}

/// The regions that the runs may have missed.
pub(super) fn describe_gap(sweep: &Sweep, gap: &Gap) -> String {
    let point: BTreeMap<String, Value> = job::point(&sweep.axes, &gap.values);
    let point = point
        .iter()
        .map(|(name, value)| format!("{name} = {value}"));
    format!(
        "a region smaller than {} of the axes may have been missed, for example at {}",
        share(2.0 * gap.radius),
        point.collect::<Vec<_>>().join(", ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symptom: "a region less than 0.0 % of the axes across". Cause: one decimal, whatever the
    /// share is.
    #[test]
    fn small_shares_have_two_digits() {
        let shares = [0.5, 0.0123, 0.0049, 0.000_31, 2.5e-7, 0.0].map(share);
        assert_eq!(
            shares,
            [
                "50.0 %",
                "1.2 %",
                "0.49 %",
                "0.031 %",
                "0.000025 %",
                "0.0 %"
            ]
        );
    }
}
