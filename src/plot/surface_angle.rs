//! The angle of the free surface over time (Rycroft, Wong and Bazant, 2010, figure 7).

use super::chart::{Chart, Line, Panel};
use super::page::columns;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::{DRAINAGE, Family};
use crate::measure::{Centres, surface_angle};
use crate::record::RunRecord;

/// The angle of the free surface over time.
pub(super) struct SurfaceAngle;

impl Figure for SurfaceAngle {
    fn name(&self) -> &'static str {
        "surface-angle"
    }

    fn description(&self) -> String {
        "angle of the free surface over time, of snapshots".to_owned()
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
            height: if panels.len() == 1 { px(300) } else { px(190) },
            panels,
            x_label: "time (s)".to_owned(),
            y_label: "angle of the free surface (°)".to_owned(),
            notes: vec![
                "Regression of the highest centres in columns of 2.5 diameters (Rycroft, Wong and \
                 Bazant, 2010); positive if the surface rises to the walls."
                    .to_owned(),
            ],
            ..Chart::default()
        }
        .draw(source)
    }
}

fn panel(head: Vec<String>, record: &RunRecord) -> Panel {
    let diameter = 2.0 * record.scene.spheres.radius.mean();
    let tank = record.scene.tank.clone().unwrap_or_default();
    let half_width = tank.reach()[0].unwrap_or(0.0);
    let points = record.sound_states().iter().filter_map(|snapshot| {
        let angle = surface_angle(&Centres::of(snapshot), diameter, half_width)?;
        Some((snapshot.time, angle.to_degrees()))
    });
    let line = Line {
        points: points.collect(),
        color: palette::LINES[0],
    };
    Panel::new(head, (0.0, record.scene.time.duration), vec![line])
}
