//! Pictures of the states: spheres in the tank at the end of a run, from the side and from above
//! (Rice, 2012, figure 11).

use super::canvas::{self, Drawn, FigureSheet, SNAP};
use super::page::whole;
use super::runs::{Runs, ShownRun};
use super::style::{LABEL, MARGIN, SMALL, WIDTH, frame, letters, px};
use super::svg::{Placed, Svg};
use super::words::{FigureWords, LINE};
use super::{Figure, PlotError, chart, choice, numbers, palette, text};
use crate::classify::{Label, TANK};
use crate::observe::Snapshot;
use crate::record::Outcome;
use crate::render::{Camera, Rgb, Stage, picture, round_down};
use ndarray::Axis;
use plotters::element::PathElement;
use plotters::style::text_anchor::{HPos, VPos};

/// Name of the figure.
const NAME: &str = "states";

/// Most pictures side by side.
const MOST: usize = 5;
/// Largest width of a picture.
const WIDEST: i32 = px(200);
/// Room between pictures.
const GAP: i32 = px(12);
/// Room of a name above a picture.
const HEAD: i32 = px(20);
/// Greatest height that is shown, over the radius of the tank.
const HIGHEST: f64 = 4.0;
/// Heights that differ by this share are equal.
const ROUNDING: f64 = 1e-9;

pub(super) fn figure() -> Figure {
    Figure::of_runs(
        NAME,
        "pictures: the spheres at the end of a run, from the side and from above",
        &choice::STATES,
        draw,
    )
    .for_families([&TANK])
}

fn draw(runs: &Runs<'_>) -> Result<Svg, PlotError> {
    let ends = runs.shown.iter().map(End::new);
    let strip = PictureStrip::new(ends.collect::<Result<_, _>>()?, runs);
    let body = canvas::draw((WIDTH, strip.height), |sheet| {
        strip.words.draw(sheet)?;
        strip.draw_length(sheet)
    })?;
    let pictures = (0..strip.ends.len()).flat_map(|index| strip.pictures(index));
    Svg::new(NAME, &runs.origin, &body).with_pictures(pictures.collect())
}

/// The end of a run.
struct End {
    label: Label,
    /// Where it is in the sweep, line by line.
    place: Vec<String>,
    snapshot: Snapshot,
    radius: Vec<f64>,
    stage: Stage,
}

impl End {
    fn new(run: &ShownRun<'_>) -> Result<Self, PlotError> {
        let record = run.record()?;
        let mut snapshots = record.snapshots.iter().rev();
        // The numbers of the state that broke a guard mean nothing.
        let snapshot = match &record.outcome {
            Outcome::Unstable(broken) => snapshots.find(|state| state.time < broken.time),
            Outcome::Completed => snapshots.next(),
        };
        let snapshot =
            snapshot.ok_or_else(|| PlotError::needs(NAME, "snapshots in its records"))?;
        Ok(Self {
            label: run.verdict.label,
            place: run.name.clone(),
            stage: Stage::of_scene(&record.scene).around([snapshot], &record.radius),
            snapshot: snapshot.clone(),
            radius: record.radius.clone(),
        })
    }

    /// The spheres have the colour of the state in the phase diagram, a little paler: shadows need
    /// room below it.
    fn color(&self) -> Rgb {
        let color = palette::lightened(palette::state(self.label), 0.25);
        [color.0, color.1, color.2]
    }

    /// The spheres that are wholly below the top of a stage: the edge of a picture cuts none.
    fn below_top(&self, stage: &Stage) -> Vec<usize> {
        let top = stage.seen[1][2];
        let heights = self.snapshot.position.column(2);
        let tops = heights.iter().zip(&self.radius);
        let tops = tops.map(|(height, radius)| height + radius).enumerate();
        tops.filter(|(_, sphere)| *sphere <= top + ROUNDING * top.abs())
            .map(|(index, _)| index)
            .collect()
    }
}

/// Where pictures and words go. Corners of pictures fall on pixels of the PNG.
struct PictureStrip {
    ends: Vec<End>,
    /// The tanks, with what is seen of them.
    stages: Vec<Stage>,
    words: FigureWords,
    /// Pictures per row.
    columns: usize,
    /// Upper left corner of the first picture.
    origin: (i32, i32),
    /// Width of a picture, heights of that from the side and of that from above.
    picture: (i32, [i32; 2]),
    /// Height of a row with its words.
    row: i32,
    height: i32,
}

impl PictureStrip {
    fn new(ends: Vec<End>, runs: &Runs<'_>) -> Self {
        let stages = stages(&ends);
        let columns = ends.len().clamp(1, MOST);
        let count = columns as i32;
        let room = (WIDTH - 2 * MARGIN - GAP * (count - 1)) / count;
        let width = room.min(WIDEST) / SNAP * SNAP;
        let height_of = |camera: fn(&Stage) -> Camera| {
            let tallest = |stage| f64::from(width) / camera(stage).aspect();
            let height = stages.iter().map(tallest).fold(0.0, f64::max);
            (height / f64::from(SNAP)).ceil() as i32 * SNAP
        };
        let heights = [height_of(Camera::side), height_of(Camera::top)];
        let mut words = FigureWords::new(WIDTH);
        words.title(runs.origin.title, &[]);
        let places = ends.iter().zip(&stages);
        let places: Vec<Vec<String>> = places
            .map(|(end, stage)| place_lines(end, stage, width))
            .collect();
        let lines = places.iter().map(Vec::len).max().unwrap_or(0) as i32;
        let pictures = HEAD + heights[0] + GAP + heights[1] + px(6);
        let left = (WIDTH - count * width - (count - 1) * GAP) / 2;
        let mut strip = Self {
            origin: (left / SNAP * SNAP, (words.bottom + SNAP - 1) / SNAP * SNAP),
            ends,
            stages,
            words,
            columns,
            picture: (width, heights),
            row: (pictures + lines * LINE + GAP) / SNAP * SNAP,
            height: 0,
        };
        let head = letters(LABEL, HPos::Center, VPos::Bottom);
        for (index, place) in places.into_iter().enumerate() {
            let (left, top) = strip.corner(index);
            let middle = left + width / 2;
            let name = strip.ends[index].label.name.replace('-', " ");
            strip
                .words
                .put(name, head.clone(), (middle, top + HEAD - px(4)));
            strip.words.lines(place, (middle, top + pictures));
        }
        let rows = strip.ends.len().div_ceil(columns) as i32;
        strip.words.bottom = strip.origin.1 + rows * strip.row;
        let common = Some(runs.common.join(", ")).filter(|common| !common.is_empty());
        let notes: Vec<String> = common.into_iter().chain(runs.left_out.clone()).collect();
        strip.words.notes(&notes);
        strip.height = whole(strip.words.bottom + MARGIN + px(6));
        strip
    }

    /// Upper left corner of the pictures of a run.
    fn corner(&self, index: usize) -> (i32, i32) {
        let (column, row) = ((index % self.columns) as i32, (index / self.columns) as i32);
        (
            self.origin.0 + column * (self.picture.0 + GAP),
            self.origin.1 + row * self.row,
        )
    }

    fn pictures(&self, index: usize) -> [Placed; 2] {
        let (left, top) = self.corner(index);
        let (width, [side, above]) = self.picture;
        let (end, stage) = (&self.ends[index], &self.stages[index]);
        let drawn = end.below_top(stage);
        let snapshot = Snapshot {
            position: end.snapshot.position.select(Axis(0), &drawn),
            ..Snapshot::default()
        };
        let radius: Vec<f64> = drawn.iter().map(|&sphere| end.radius[sphere]).collect();
        let placed = |camera: Camera, top: i32, height: i32| Placed {
            image: picture(
                &snapshot,
                &radius,
                &vec![end.color(); drawn.len()],
                stage,
                &camera,
                (width / SNAP) as usize,
                (height / SNAP) as usize,
            ),
            corner: (left, top),
        };
        let first = top + HEAD;
        [
            placed(Camera::side(stage), first, side),
            placed(Camera::top(stage), first + side + GAP, above),
        ]
    }

    /// Draws a length to compare with: the radius of the tank, or what is seen, rounded.
    fn draw_length(&self, sheet: &FigureSheet<'_>) -> Drawn {
        let Some(stage) = self.stages.first() else {
            return Ok(());
        };
        let (width, [side, _]) = self.picture;
        let camera = Camera::side(stage);
        let per_metre = camera.scale(width as usize, side as usize);
        let length = round_down(0.5 * camera.view()[0]);
        let right = self.origin.0 + self.columns as i32 * (width + GAP) - GAP;
        let left = right - (length * per_metre).round() as i32;
        let y = self.height - MARGIN - px(4);
        let bar = [(left, y - px(3)), (left, y), (right, y), (right, y - px(3))];
        sheet.draw(&PathElement::new(bar, frame()))?;
        let text = format!("{} mm", numbers::number(length * 1e3));
        let style = letters(SMALL, HPos::Right, VPos::Bottom);
        sheet.draw_text(&text, &style, (left - px(6), y + px(3)))
    }
}

/// What is seen of the tanks: all equally high and wide, so that one length serves for all.
fn stages(ends: &[End]) -> Vec<Stage> {
    let top_of = |end: &End| {
        let [low, high] = end.stage.seen;
        let reach = end.stage.radius.unwrap_or(0.5 * (high[0] - low[0]));
        (high[2] - low[2]).clamp(reach, HIGHEST * reach)
    };
    let seen = ends.iter().map(top_of).fold(0.0, f64::max);
    let mut stages: Vec<Stage> = ends
        .iter()
        .map(|end| end.stage.clone().up_to(end.stage.seen[0][2] + seen))
        .collect();
    for axis in 0..2 {
        let seen = stages.iter().flat_map(|stage| stage.seen);
        let (low, high) = chart::ends(seen.map(|corner| corner[axis]));
        for stage in &mut stages {
            (stage.seen[0][axis], stage.seen[1][axis]) = (low, high);
        }
    }
    stages
}

/// Lines below the pictures of a run, none wider than they: where it is in the sweep, and how many
/// spheres are too high to be drawn.
fn place_lines(end: &End, stage: &Stage, width: i32) -> Vec<String> {
    let mut items = end.place.clone();
    let above = end.radius.len() - end.below_top(stage).len();
    if above > 0 {
        let spheres = if above == 1 { "sphere" } else { "spheres" };
        items.push(format!("{above} {spheres} above, not drawn"));
    }
    let items = items.iter();
    items
        .flat_map(|item| text::wrap(item, f64::from(SMALL), f64::from(width)))
        .collect()
}
