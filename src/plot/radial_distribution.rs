//! The radial distribution function (Rycroft, Wong and Bazant, 2010, figure 11).

use super::chart::{Chart, Line, Panel};
use super::page::columns;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::{DRAINAGE, Family};
use crate::measure::{Centres, RadialDistribution, Region};
use crate::observe::Snapshot;
use crate::record::RunRecord;

/// The radial distribution function at the start and while spheres leave.
pub(super) struct RadialDistributionFigure;

/// Farthest distance, in diameters, and bins up to it.
const FARTHEST: f64 = 4.0;
const BINS: usize = 160;
/// The region of the paper, over the half width of its box and the height of its packing: the
/// middle, -15 d < x < 15 d and 15 d < z < 45 d.
const ACROSS: f64 = 0.6;
const HEIGHTS: [f64; 2] = [0.14, 0.41];

impl Figure for RadialDistributionFigure {
    fn name(&self) -> &'static str {
        "radial-distribution"
    }

    fn description(&self) -> String {
        "radial distribution function in the middle, at the start and while spheres leave"
            .to_owned()
    }

    fn default_runs(&self) -> Option<&'static str> {
        Some("a typical run of every state")
    }

    fn family(&self) -> Option<&'static Family> {
        Some(&DRAINAGE)
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let runs = choice::runs(source, choice::states)?;
        let (common, places) = choice::places(&runs);
        let panels = runs
            .iter()
            .zip(places)
            .map(|(run, place)| Ok(panel(place, &run.record()?)))
            .collect::<Result<Vec<_>, PlotError>>()?;
        Chart {
            name: self.name(),
            common,
            columns: columns(panels.len()),
            height: if panels.len() == 1 { px(360) } else { px(190) },
            panels,
            x_label: "distance over diameter $r$ / $d$".to_owned(),
            y_label: "$g$($r$)".to_owned(),
            legend: vec![
                (START, "at the start".to_owned()),
                (FLOW, "while spheres leave".to_owned()),
            ],
            notes: vec![
                "Of the spheres in the middle of the lower half: 60 % of the width, 14 to 41 % of \
                 the height at the start."
                    .to_owned(),
            ],
        }
        .draw(source)
    }
}

const START: plotters::style::RGBColor = palette::LINES[2];
const FLOW: plotters::style::RGBColor = palette::LINES[0];

fn panel(head: Vec<String>, record: &RunRecord) -> Panel {
    let (first, later) = match record.sound_states() {
        [first, later @ ..] => (std::slice::from_ref(first), later),
        [] => (&[][..], &[][..]),
    };
    let diameter = 2.0 * record.scene.spheres.radius.mean();
    let Some(region) = region(record, first) else {
        return Panel::new(head, (0.0, FARTHEST), Vec::new());
    };
    let lines = [(first, START), (later, FLOW)].into_iter();
    let lines = lines.map(|(snapshots, color)| {
        let mut distribution = RadialDistribution::new(FARTHEST * diameter, BINS);
        for snapshot in snapshots {
            distribution.add(&Centres::of(snapshot), &region);
        }
        let values = distribution.values().into_iter();
        Line {
            points: values.map(|[r, g]| (r / diameter, g)).collect(),
            color,
        }
    });
    Panel::new(head, (0.0, FARTHEST), lines.collect()).down_to_zero()
}

/// The middle of the lower half of what is there at the start.
fn region(record: &RunRecord, first: &[Snapshot]) -> Option<Region> {
    let tank = record.scene.tank.as_ref()?;
    let [Some(x), Some(y)] = tank.reach() else {
        return None;
    };
    let floor = tank.floor?;
    let heights = first.first()?.position.column(2).to_vec();
    let top = heights.into_iter().fold(floor, f64::max);
    let height = |share: f64| floor + share * (top - floor);
    Some(Region {
        low: [-ACROSS * x, -y, height(HEIGHTS[0])],
        high: [ACROSS * x, y, height(HEIGHTS[1])],
    })
}
