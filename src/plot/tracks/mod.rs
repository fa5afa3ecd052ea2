//! Tracks: the path of every sphere of one run, with circles that show its size now and then.
//!
//! Spheres are seen in the plane in which they move most; where all of them move along one line,
//! their place on it is drawn over time.

mod view;

use super::axes::Plot;
use super::canvas::{Drawn, FigureSheet};
use super::page::{FigurePage, PagePlan, PanelFrame};
use super::scale::AxisSpan;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, palette};
use crate::record::RunRecord;
use plotters::element::{Circle, PathElement, Polygon};
use plotters::style::{BLACK, Color, WHITE};
use view::{Sight, View};

/// Greatest height of the panel.
const HEIGHT: i32 = px(520);
/// Height of a panel over time.
const OVER_TIME: i32 = px(330);
/// Most instants at which circles are drawn.
const MOST_INSTANTS: f64 = 12.0;
/// With more spheres than this, circles are drawn at the start and at the end only.
const FEW_SPHERES: usize = 12;
/// A spin is marked if the surface it turns moves at least at this share of the fastest motion.
const NOTABLE_SPIN: f64 = 0.02;
/// Most spheres whose tracks are drawn: more of them hide each other.
const MOST_SPHERES: usize = 32;
/// Stroke of a path.
const STROKE: u32 = 18;

pub(super) fn figure() -> Figure {
    let description = "paths of the spheres, from the record of one run with its trajectory";
    Figure::of_record("tracks", description, draw)
}

fn draw(record: &RunRecord) -> Result<Svg, PlotError> {
    if record.trajectory.len() < 2 {
        return Err(PlotError::nothing(
            "the record holds no trajectory; add `trajectory = true` to [output] of the scene and \
             run it again",
        ));
    }
    let view = View::new(record);
    let mut tracks = Tracks {
        record,
        view,
        sight: Sight::new(record, view),
        instants: instants(record),
        notable: 0.0,
    };
    tracks.notable = NOTABLE_SPIN * tracks.fastest();
    let page = tracks.page();
    let body = page.draw(|sheet| {
        let axes = page.axes(sheet, 0)?;
        let plot = axes.plot();
        for line in &tracks.sight.outline {
            let ink = palette::HATCH.stroke_width(30);
            plot.draw(&PathElement::new(line.as_slice(), ink))?;
        }
        for sphere in tracks.shown() {
            tracks.draw_sphere(sheet, plot, sphere)?;
        }
        axes.draw()
    })?;
    Ok(Svg::of_record("tracks", record, &body))
}

/// Frames at which circles are drawn, and the time between them (s).
fn instants(record: &RunRecord) -> (Vec<usize>, f64) {
    let last = record.trajectory.len() - 1;
    let interval = record.scene.time.frame_interval;
    if record.radius.len() > FEW_SPHERES {
        return (vec![0, last], last as f64 * interval);
    }
    let least = last as f64 / MOST_INSTANTS;
    let mut decade = 1.0;
    let every = loop {
        let round = [1.0, 2.0, 5.0].map(|mantissa| mantissa * decade);
        if let Some(every) = round.into_iter().find(|every| *every >= least) {
            break every as usize;
        }
        decade *= 10.0;
    };
    ((0..=last).step_by(every).collect(), every as f64 * interval)
}

struct Tracks<'a> {
    record: &'a RunRecord,
    view: View,
    sight: Sight,
    instants: (Vec<usize>, f64),
    /// Speed of a surface from which on an arrow shows its spin (m/s).
    notable: f64,
}

impl Tracks<'_> {
    fn place(&self, frame: usize, sphere: usize) -> (f64, f64) {
        let snapshot = &self.record.trajectory[frame];
        let centre = [0, 1, 2].map(|axis| snapshot.position[[sphere, axis]]);
        self.view.place(snapshot.time, centre)
    }

    /// Its spin about the line of sight.
    fn turning(&self, frame: usize, sphere: usize) -> f64 {
        let spin = &self.record.trajectory[frame].spin;
        if spin.is_empty() {
            return 0.0;
        }
        self.view
            .turning([0, 1, 2].map(|axis| spin[[sphere, axis]]))
    }

    /// Speed of its surface due to that spin (m/s).
    fn surface_speed(&self, frame: usize, sphere: usize) -> f64 {
        self.turning(frame, sphere).abs() * self.record.radius[sphere]
    }

    /// The fastest motion of a centre or of a surface (m/s).
    fn fastest(&self) -> f64 {
        let spheres = || 0..self.record.radius.len();
        let surfaces = [0, self.record.trajectory.len() - 1]
            .into_iter()
            .flat_map(|frame| spheres().map(move |sphere| self.surface_speed(frame, sphere)));
        let centres = self
            .record
            .trajectory
            .iter()
            .flat_map(|frame| frame.velocity.iter().map(|part| part.abs()));
        surfaces.chain(centres).fold(0.0, f64::max)
    }

    fn page(&self) -> FigurePage {
        let [across, up] = self.sight.ranges;
        let (height, aspect) = match self.view {
            View::Time { .. } => (OVER_TIME, None),
            View::Plane { .. } => (HEIGHT, Some((across.1 - across.0) / (up.1 - up.0))),
        };
        FigurePage::new(PagePlan {
            title: self.record.scene.title.as_deref(),
            frames: vec![PanelFrame {
                head: Vec::new(),
                x: AxisSpan::linear(across),
                y: AxisSpan::linear(up),
            }],
            columns: 1,
            height,
            aspect,
            labels: self.view.labels(),
            notes: &[self.caption()],
            ..PagePlan::default()
        })
    }

    fn draw_sphere(&self, sheet: &FigureSheet<'_>, plot: &Plot<'_>, sphere: usize) -> Drawn {
        let color = palette::DISTINCT[sphere % palette::DISTINCT.len()];
        let last = self.record.trajectory.len() - 1;
        let radius = 1e3 * self.record.radius[sphere];
        let at = |frame| plot.map_coordinate(&self.place(frame, sphere));
        let path = thinned((0..=last).map(at));
        if let View::Time { .. } = self.view {
            let edge = |shift: f64| {
                move |frame| {
                    let (time, place) = self.place(frame, sphere);
                    plot.map_coordinate(&(time, place + shift))
                }
            };
            let mut band = thinned((0..=last).map(edge(radius)));
            band.extend(thinned((0..=last).map(edge(-radius))).into_iter().rev());
            sheet.draw(&Polygon::new(band, color.mix(0.22)))?;
            return sheet.draw(&PathElement::new(path, color.stroke_width(STROKE)));
        }
        // Pictures of a plane are to scale.
        let size = plot.map_coordinate(&(radius, 0.0)).0 - plot.map_coordinate(&(0.0, 0.0)).0;
        for &frame in &self.instants.0 {
            let centre = at(frame);
            let fill = if frame == 0 { 0.55 } else { 0.08 };
            sheet.draw(&Circle::new(centre, size, color.mix(fill).filled()))?;
            sheet.draw(&Circle::new(centre, size, color.mix(0.6).stroke_width(6)))?;
        }
        let end = at(last);
        sheet.draw(&Circle::new(end, size, color.stroke_width(STROKE)))?;
        sheet.draw(&PathElement::new(path, color.stroke_width(STROKE)))?;
        for frame in [0, last] {
            if self.has_arrow(frame, sphere) {
                let centre = at(frame);
                let counter_clockwise = self.turning(frame, sphere) > 0.0;
                draw_turn(sheet, centre, 0.6 * f64::from(size), counter_clockwise)?;
            }
        }
        Ok(())
    }

    /// The spheres that are drawn.
    fn shown(&self) -> std::ops::Range<usize> {
        0..self.record.radius.len().min(MOST_SPHERES)
    }

    /// Whether an arrow shows the spin of a sphere in that frame.
    fn has_arrow(&self, frame: usize, sphere: usize) -> bool {
        self.surface_speed(frame, sphere) > self.notable
    }

    /// What the marks mean.
    fn caption(&self) -> String {
        let count = self.record.radius.len();
        let mut parts = Vec::new();
        if self.shown().len() < count {
            parts.push(format!("the first {MOST_SPHERES} of {count} spheres"));
        }
        if let View::Time { .. } = self.view {
            parts.push("bands: from edge to edge of a sphere".to_owned());
            return parts.join("; ");
        }
        if count <= FEW_SPHERES {
            let every = super::numbers::number(1e3 * self.instants.1);
            parts.push(format!("circles every {every} ms"));
        }
        parts.push("filled: start; bold: end".to_owned());
        let last = self.record.trajectory.len() - 1;
        let mut places = self
            .shown()
            .flat_map(|sphere| [(0, sphere), (last, sphere)]);
        if places.any(|(frame, sphere)| self.has_arrow(frame, sphere)) {
            parts.push("arrows: spin".to_owned());
        }
        parts.join("; ")
    }
}

/// The points of a path that its picture needs: the others lie within a hair of the lines between
/// them (Douglas and Peucker, 1973).
fn thinned(points: impl Iterator<Item = (i32, i32)>) -> Vec<(i32, i32)> {
    const HAIR: f64 = 1.5;
    let mut points: Vec<(i32, i32)> = points.collect();
    points.dedup();
    let mut needed = vec![false; points.len()];
    let mut spans = vec![(0, points.len() - 1)];
    while let Some((first, last)) = spans.pop() {
        (needed[first], needed[last]) = (true, true);
        let from_line = |&index: &usize| distance(points[index], points[first], points[last]);
        let farthest = (first + 1..last).max_by(|a, b| from_line(a).total_cmp(&from_line(b)));
        if let Some(middle) = farthest.filter(|index| from_line(index) > HAIR) {
            spans.extend([(first, middle), (middle, last)]);
        }
    }
    let mut needed = needed.into_iter();
    points.retain(|_| needed.next() == Some(true));
    points
}

/// Distance of a point from the straight piece between two others.
fn distance(point: (i32, i32), from: (i32, i32), to: (i32, i32)) -> f64 {
    let (x, y) = (f64::from(point.0 - from.0), f64::from(point.1 - from.1));
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let squared = dx * dx + dy * dy;
    let along = if squared > 0.0 {
        ((x * dx + y * dy) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    libm::hypot(x - along * dx, y - along * dy)
}

/// An arrow around a centre, counter-clockwise or clockwise.
fn draw_turn(
    sheet: &FigureSheet<'_>,
    centre: (i32, i32),
    radius: f64,
    counter_clockwise: bool,
) -> Drawn {
    const PARTS: i32 = 40;
    let sense = if counter_clockwise { 1.0 } else { -1.0 };
    let at = |degrees: f64, radius: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        // Heights of the canvas grow downward.
        let offset = ((radius * cosine).round(), (radius * sine).round());
        (centre.0 + offset.0 as i32, centre.1 - offset.1 as i32)
    };
    let (start, turn, head) = (60.0, sense * 250.0, sense * 38.0);
    let arc: Vec<(i32, i32)> = (0..=PARTS)
        .map(|part| at(start + turn * f64::from(part) / f64::from(PARTS), radius))
        .collect();
    let end = start + turn;
    let triangle = vec![
        at(end, 0.68 * radius),
        at(end + head, radius),
        at(end, 1.32 * radius),
    ];
    sheet.draw(&PathElement::new(arc.clone(), WHITE.stroke_width(30)))?;
    sheet.draw(&PathElement::new(arc, BLACK.mix(0.8).stroke_width(12)))?;
    sheet.draw(&Polygon::new(triangle, BLACK.mix(0.8)))
}
