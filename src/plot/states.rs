//! Pictures of the states: spheres in the tank at the end of a run, from the side and from above
//! (Rice, 2012, figure 11).

use super::canvas::{Canvas, SNAP};
use super::choice::{self, Run};
use super::layout::{TITLE_LINE, title_height, title_lines, whole};
use super::style::{Drawn, LABEL, MARGIN, SMALL, Sheet, TITLE, WIDTH, frame, letters, px};
use super::svg::{Placed, Svg};
use super::{Figure, PlotError, Source, palette, scale};
use crate::classify::Label;
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::render::{Camera, Rgb, Stage, picture};
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

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let runs = choice::runs(source, choice::states)?;
        let ends = runs
            .iter()
            .map(|run| End::new(run, run.record()?, self.name()))
            .collect::<Result<Vec<_>, PlotError>>()?;
        let strip = Strip::new(&ends, source.sweep.title.as_deref());
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
    fn new(run: &Run<'_>, record: RunRecord, figure: &'static str) -> Result<Self, PlotError> {
        let stage = Stage::of_scene(&record.scene);
        let snapshot = record.snapshots.into_iter().last();
        let snapshot = snapshot.ok_or(PlotError::Scene {
            figure,
            needs: "snapshots in its records",
        })?;
        Ok(Self {
            label: run.row.verdict.label,
            place: run.head().split(", ").map(str::to_owned).collect(),
            stage: stage.around([&snapshot], &record.radius),
            snapshot,
            radius: record.radius,
        })
    }

    /// The spheres have the colour of the state in the phase diagram, a little paler: shadows need
    /// room below it.
    fn colors(&self) -> Vec<Rgb> {
        let color = palette::lightened(palette::state(self.label), 0.25);
        vec![[color.0, color.1, color.2]; self.radius.len()]
    }
}

/// Where pictures and words go. Corners of pictures fall on pixels of the PNG.
struct Strip {
    title: Vec<String>,
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
    fn new(ends: &[End], title: Option<&str>) -> Self {
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
        let lines = ends.iter().map(|end| end.place.len()).max().unwrap_or(0) as i32;
        let row = HEAD + heights[0] + GAP + heights[1] + px(6) + lines * LINE;
        let title = title_lines(title);
        let top = title_height(&title);
        let rows = ends.len().div_ceil(columns) as i32;
        Self {
            left: (WIDTH - count * width - (count - 1) * GAP) / 2 / SNAP * SNAP,
            top: (top + SNAP - 1) / SNAP * SNAP,
            height: whole(top + rows * (row + GAP) + MARGIN + px(6)),
            title,
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
        let placed = |camera: Camera, top: i32, height: i32| Placed {
            image: picture(
                &end.snapshot,
                &end.radius,
                &end.colors(),
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
            let name = end.label.name().replace('-', " ");
            let head = letters(LABEL, HPos::Center, VPos::Bottom);
            sheet.draw_text(&name, &head, (middle, top + HEAD - px(4)))?;
            let below = top + HEAD + side + GAP + above + px(6);
            for (index, line) in end.place.iter().enumerate() {
                let style = letters(SMALL, HPos::Center, VPos::Top);
                sheet.draw_text(line, &style, (middle, below + index as i32 * LINE))?;
            }
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

/// The largest of 1, 2 and 5 times a power of ten that is not above a positive number.
fn round_down(value: f64) -> f64 {
    let decade = libm::exp10(libm::log10(value).floor());
    let fits = |mantissa: &&f64| *mantissa * decade <= value;
    [5.0, 2.0, 1.0]
        .iter()
        .find(fits)
        .map_or(decade, |mantissa| mantissa * decade)
}
