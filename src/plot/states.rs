//! Pictures of the states: spheres in the tank at the end of a run, from the side and from above
//! (Rice, 2012, figure 11).

use super::canvas::{Canvas, SNAP};
use super::choice::{self, Run};
use super::layout::{TITLE_LINE, title_height, title_lines, whole};
use super::style::{Drawn, LABEL, MARGIN, SMALL, Sheet, TITLE, WIDTH, frame, letters, px};
use super::svg::{Placed, Svg};
use super::{Figure, PlotError, Source, chart, palette, scale, text};
use crate::classify::{Family, Label, TANK};
use crate::observe::Snapshot;
use crate::record::{Outcome, RunRecord};
use crate::render::{Camera, Rgb, Stage, picture, round_down};
use ndarray::Axis;
use plotters::drawing::IntoDrawingArea;
use plotters::element::PathElement;
use plotters::style::text_anchor::{HPos, VPos};

/// Pictures of the states.
pub(super) struct States;

/// Most pictures side by side.
const MOST: usize = 5;
/// Largest width of a picture.
const WIDEST: i32 = px(200);
/// Room between pictures.
const GAP: i32 = px(12);
/// Room of a name above a picture, and of the lines below.
const HEAD: i32 = px(20);
const LINE: i32 = px(17);
/// Greatest height that is shown, over the radius of the tank.
const HIGHEST: f64 = 4.0;
/// Heights that differ by this share are equal.
const ROUNDING: f64 = 1e-9;

impl Figure for States {
    fn name(&self) -> &'static str {
        "states"
    }

    fn description(&self) -> String {
        "pictures: the spheres at the end of a run, from the side and from above".to_owned()
    }

    fn default_runs(&self) -> Option<&'static str> {
        Some("a typical run of every state")
    }

    fn family(&self) -> Option<&'static Family> {
        Some(&TANK)
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let runs = choice::runs(source, choice::states)?;
        let (common, places) = choice::places(&runs);
        let ends = runs
            .iter()
            .zip(places)
            .map(|(run, place)| End::new(run, place, run.record()?, self.name()))
            .collect::<Result<Vec<_>, PlotError>>()?;
        let mut notes: Vec<String> = choice::left_out(source).into_iter().collect();
        if !common.is_empty() {
            notes.insert(0, common.join(", "));
        }
        let strip = Strip::new(&ends, source.sweep.title.as_deref(), &notes);
        let size = (WIDTH as u32, strip.height as u32);
        let mut body = String::new();
        {
            let sheet = Canvas::new(&mut body, size).into_drawing_area();
            strip.draw_words(&sheet, &ends)?;
        }
        let pictures = (0..ends.len()).flat_map(|index| strip.pictures(&ends, index));
        Svg::new(self.name(), source, size, &body).with_pictures(pictures.collect())
    }
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
    fn new(
        run: &Run<'_>,
        place: Vec<String>,
        record: RunRecord,
        figure: &'static str,
    ) -> Result<Self, PlotError> {
        let stage = Stage::of_scene(&record.scene);
        let mut snapshots = record.snapshots.into_iter().rev();
        // The numbers of the state that broke a guard mean nothing.
        let snapshot = match &record.outcome {
            Outcome::Unstable(broken) => snapshots.find(|state| state.time < broken.time),
            Outcome::Completed => snapshots.next(),
        };
        let snapshot = snapshot.ok_or(PlotError::Scene {
            figure,
            needs: "snapshots in its records",
        })?;
        Ok(Self {
            label: run.row.verdict.label,
            place,
            stage: stage.around([&snapshot], &record.radius),
            snapshot,
            radius: record.radius,
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
struct Strip {
    title: Vec<String>,
    /// Lines below each pair of pictures, and below all.
    places: Vec<Vec<String>>,
    notes: Vec<String>,
    /// The tanks, with what is seen of them.
    stages: Vec<Stage>,
    /// Pictures per row.
    columns: usize,
    /// Left end of the first picture.
    left: i32,
    /// Upper end of the first row.
    top: i32,
    /// Width of a picture, heights of that from the side and of that from above.
    picture: (i32, [i32; 2]),
    /// Height of a row with its words.
    row: i32,
    height: i32,
}

impl Strip {
    fn new(ends: &[End], title: Option<&str>, notes: &[String]) -> Self {
        let top_of = |end: &End| {
            let [low, high] = end.stage.seen;
            let reach = end.stage.radius.unwrap_or(0.5 * (high[0] - low[0]));
            (high[2] - low[2]).clamp(reach, HIGHEST * reach)
        };
        let seen = ends.iter().map(top_of).fold(0.0, f64::max);
        // All are seen equally high and wide, so that one length serves for all.
        let mut stages: Vec<Stage> = ends
            .iter()
            .map(|end| end.stage.up_to(end.stage.seen[0][2] + seen))
            .collect();
        for axis in 0..2 {
            let least = |low: f64, stage: &Stage| stage.seen[0][axis].min(low);
            let most = |high: f64, stage: &Stage| stage.seen[1][axis].max(high);
            let low = stages.iter().fold(f64::INFINITY, least);
            let high = stages.iter().fold(f64::NEG_INFINITY, most);
            for stage in &mut stages {
                (stage.seen[0][axis], stage.seen[1][axis]) = (low, high);
            }
        }
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
        let places: Vec<Vec<String>> = ends
            .iter()
            .zip(&stages)
            .map(|(end, stage)| place_lines(end, stage, width))
            .collect();
        let lines = places.iter().map(Vec::len).max().unwrap_or(0) as i32;
        let notes = chart::note_lines(notes);
        let row = HEAD + heights[0] + GAP + heights[1] + px(6) + lines * LINE;
        let title = title_lines(title);
        let top = title_height(&title);
        let rows = ends.len().div_ceil(columns) as i32;
        Self {
            left: (WIDTH - count * width - (count - 1) * GAP) / 2 / SNAP * SNAP,
            top: (top + SNAP - 1) / SNAP * SNAP,
            height: whole(top + rows * (row + GAP) + notes.len() as i32 * LINE + MARGIN + px(6)),
            title,
            places,
            notes,
            stages,
            columns,
            picture: (width, heights),
            row: row / SNAP * SNAP,
        }
    }

    /// Upper left corner of the pictures of a run.
    fn corner(&self, index: usize) -> (i32, i32) {
        let (column, row) = ((index % self.columns) as i32, (index / self.columns) as i32);
        (
            self.left + column * (self.picture.0 + GAP),
            self.top + row * (self.row + GAP),
        )
    }

    fn pictures(&self, ends: &[End], index: usize) -> [Placed; 2] {
        let (left, top) = self.corner(index);
        let (width, [side, above]) = self.picture;
        let (end, stage) = (&ends[index], &self.stages[index]);
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

    fn draw_words(&self, sheet: &Sheet<'_>, ends: &[End]) -> Drawn {
        for (index, line) in self.title.iter().enumerate() {
            let style = letters(TITLE, HPos::Center, VPos::Top);
            let y = MARGIN + index as i32 * TITLE_LINE;
            sheet.draw_text(line, &style, (WIDTH / 2, y))?;
        }
        let (width, [side, above]) = self.picture;
        for (index, end) in ends.iter().enumerate() {
            let (left, top) = self.corner(index);
            let middle = left + width / 2;
            let name = end.label.name.replace('-', " ");
            let head = letters(LABEL, HPos::Center, VPos::Bottom);
            sheet.draw_text(&name, &head, (middle, top + HEAD - px(4)))?;
            let below = top + HEAD + side + GAP + above + px(6);
            for (index, line) in self.places[index].iter().enumerate() {
                let style = letters(SMALL, HPos::Center, VPos::Top);
                sheet.draw_text(line, &style, (middle, below + index as i32 * LINE))?;
            }
        }
        let rows = ends.len().div_ceil(self.columns) as i32;
        let below = self.top + rows * (self.row + GAP);
        for (index, line) in self.notes.iter().enumerate() {
            let style = letters(SMALL, HPos::Center, VPos::Top);
            sheet.draw_text(line, &style, (WIDTH / 2, below + index as i32 * LINE))?;
        }
        self.draw_length(sheet)
    }

    /// Draws a length to compare with: the radius of the tank, or what is seen, rounded.
    fn draw_length(&self, sheet: &Sheet<'_>) -> Drawn {
        let Some(stage) = self.stages.first() else {
            return Ok(());
        };
        let (width, [side, _]) = self.picture;
        let camera = Camera::side(stage);
        let per_metre = camera.scale(width as usize, side as usize);
        let length = round_down(0.5 * camera.view()[0]);
        let right = self.left + self.columns as i32 * (width + GAP) - GAP;
        let left = right - (length * per_metre).round() as i32;
        let y = self.height - MARGIN - px(4);
        let bar = [(left, y - px(3)), (left, y), (right, y), (right, y - px(3))];
        sheet.draw(&PathElement::new(bar, frame()))?;
        let text = format!("{} mm", scale::number(length * 1e3));
        let style = letters(SMALL, HPos::Right, VPos::Bottom);
        sheet.draw_text(&text, &style, (left - px(6), y + px(3)))
    }
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
