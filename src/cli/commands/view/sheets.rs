//! The panels of one run, or of several side by side.

use super::{Arguments, Color, words};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use phase::measure::Layers;
use phase::observe::Snapshot;
use phase::record::RunRecord;
use phase::render::{ColorBy, Image, PictureSheet, Scenery, Sides, Stage};
use phase::sweep::work;

/// Greatest height of the view from the side, over its width.
const TALLEST: f64 = 8.0;

/// A run, and which of its states are shown.
pub(super) struct Run<'a> {
    pub(super) record: &'a RunRecord,
    pub(super) shown: Vec<&'a Snapshot>,
    /// Time of the run (s) from which times count.
    pub(super) origin: f64,
    /// Its name in the picture.
    pub(super) label: Option<String>,
    /// What distinguishes it from other runs, apart from title and place in a sweep.
    pub(super) differs: Vec<String>,
}

impl Run<'_> {
    /// Its name in the picture: its label, or title and place in a sweep.
    pub(super) fn names(&self) -> Vec<String> {
        if let Some(label) = &self.label {
            return vec![label.clone()];
        }
        let title = self.record.scene.title.iter().cloned();
        let names = title.chain([words::place(self.record)]);
        names.chain(self.differs.iter().cloned()).collect()
    }
}

/// What all panels have in common, and the sheet of each run.
pub(super) struct Sheets<'a> {
    runs: &'a [Run<'a>],
    sheets: Vec<PictureSheet>,
}

impl<'a> Sheets<'a> {
    /// Sheets whose panels have one scale, of length and of colour.
    ///
    /// # Errors
    /// If some runs are drawn flat and others are not.
    pub(super) fn new(runs: &'a [Run<'a>], arguments: &Arguments) -> Result<Self, Failure> {
        let window = window(&arguments.window)?;
        let sides = match (arguments.cut, window) {
            (true, _) => Sides::Cut,
            (false, Some(_)) => Sides::Side,
            (false, None) => Sides::Both,
        };
        let all = || runs.iter().flat_map(|run| run.shown.iter().copied());
        let color = match arguments.color {
            Color::Speed => ColorBy::speed_of(all()),
            Color::Height => ColorBy::height_of(all()),
            Color::Radius => ColorBy::radius_of(runs.iter().flat_map(|run| &run.record.radius)),
            Color::Index => ColorBy::Index,
            // Each run has its own.
            Color::Layer | Color::PackingFraction | Color::None => ColorBy::Nothing,
        };
        let color = |run| own_color(run, arguments.color).unwrap_or_else(|| color.clone());
        let mut sheets: Vec<PictureSheet> = runs.iter().map(|run| sheet(run, color(run))).collect();
        if sheets.iter().any(|it| it.flat.is_some()) && sheets.iter().any(|it| it.flat.is_none()) {
            return Err(Failure::refused(
                "discs are drawn flat, spheres from two sides: draw them in separate pictures",
            ));
        }
        if sheets.iter().any(|it| it.flat.is_some())
            && (sides != Sides::Both || arguments.color == Color::PackingFraction)
        {
            return Err(Failure::refused(
                "discs are drawn flat: --cut, --window and packing fractions do not apply",
            ));
        }
        if runs.len() == 1 {
            sheets[0].title = runs[0].names();
        }
        let stages = sheets.iter().map(|sheet| sheet.stage.seen);
        let mut seen = stages.reduce(union).unwrap_or_default();
        if let Some([x, z]) = window {
            for (corner, (x, z)) in seen.iter_mut().zip(x.into_iter().zip(z)) {
                [corner[0], corner[2]] = [x, z];
            }
        }
        for sheet in &mut sheets {
            sheet.stage.seen = seen;
            sheet.sides = sides;
        }
        Ok(Self { runs, sheets })
    }

    /// Whether the view is a flat one.
    pub(super) fn are_flat(&self) -> bool {
        self.sheets[0].flat.is_some()
    }

    /// Height of the top that is seen (m).
    pub(super) fn top(&self) -> f64 {
        self.sheets[0].stage.seen[1][2]
    }

    /// Shows nothing above that height (m).
    pub(super) fn show_up_to(&mut self, top: f64) {
        for sheet in &mut self.sheets {
            sheet.stage = sheet.stage.clone().up_to(top);
        }
    }

    /// Leaves out the upper part of a tall tank, and says so.
    pub(super) fn limit_height(&mut self, console: &Console) {
        let top = self.top();
        for sheet in &mut self.sheets {
            sheet.stage = sheet.stage.clone().no_taller(TALLEST);
        }
        let limit = self.top();
        if limit < top {
            console.note(format_args!(
                "shows up to z = {limit:.3} m; spheres above are not drawn"
            ));
        }
    }

    /// The largest width of panels, not above `width`, with which a picture of `count` panels is at
    /// most `most` pixels high.
    pub(super) fn fitted(&self, count: usize, width: usize, most: usize) -> usize {
        let lines = self.caption_lines();
        let height = |width| self.sheets[0].height(count, lines, width);
        let mut fitted = width;
        while height(fitted) > most && fitted > 1 {
            let shrunk = fitted * most / height(fitted);
            fitted = shrunk.clamp(1, fitted - 1);
        }
        fitted
    }

    /// A panel of every state, drawn on all cores.
    pub(super) fn panels(&self, width: usize) -> Result<Vec<Image>, Failure> {
        let numbered = self.runs.iter().enumerate();
        let panels: Vec<(usize, &Snapshot)> = numbered
            .flat_map(|(run, it)| it.shown.iter().map(move |state| (run, *state)))
            .collect();
        on_all_cores(&panels, |&(run, state)| self.panel(run, state, width))
    }

    /// A picture of one state of the first run.
    pub(super) fn picture_of(&self, state: &Snapshot, width: usize) -> Image {
        self.picture(&[self.panel(0, state, width)])
    }

    fn panel(&self, run: usize, state: &Snapshot, width: usize) -> Image {
        let caption = self.caption(&self.runs[run], state);
        self.sheets[run].panel(state, width, &caption)
    }

    /// Panels side by side, with all the words.
    pub(super) fn picture(&self, panels: &[Image]) -> Image {
        self.sheets[0].picture(panels)
    }

    /// A single run has its title above all panels; with several runs each panel names its own.
    fn caption(&self, run: &Run<'_>, state: &Snapshot) -> Vec<String> {
        let time = words::caption(run.record, state, run.origin);
        if self.runs.len() == 1 {
            return vec![time];
        }
        let mut lines = vec![String::new(); self.caption_lines() - 1];
        let names = run.names();
        let first = lines.len() - names.len();
        lines[first..].clone_from_slice(&names);
        lines.into_iter().chain([time]).collect()
    }

    /// Lines above each panel.
    fn caption_lines(&self) -> usize {
        match self.runs {
            [_] => 1,
            all => 1 + all.iter().map(|run| run.names().len()).max().unwrap_or(0),
        }
    }
}

/// What `draw` makes of every item.
pub(super) fn on_all_cores<T: Sync, U: Send + Sync>(
    items: &[T],
    draw: impl Fn(&T) -> U + Sync,
) -> Result<Vec<U>, Failure> {
    Ok(work::map(work::default_workers(), items, draw)?)
}

/// Ends of the visible region along x and z (m), if the command line gives them.
fn window(numbers: &[f64]) -> Result<Option<[[f64; 2]; 2]>, Failure> {
    match *numbers {
        [] => Ok(None),
        [left, right, low, high] if left < right && low < high => {
            Ok(Some([[left, right], [low, high]]))
        }
        _ => Err(Failure::refused(
            "--window takes four numbers: least and largest x, least and largest z, such as \
             -15,15,0,40",
        )),
    }
}

/// Colours that differ from run to run.
fn own_color(run: &Run<'_>, color: Color) -> Option<ColorBy> {
    let scene = &run.record.scene;
    let diameter = 2.0 * scene.spheres.radius.mean();
    let tank = scene.tank.clone().unwrap_or_default();
    match color {
        Color::Layer => {
            let start = run.record.sound_states().first()?;
            let floor = tank.floor.unwrap_or(0.0);
            let layers = Layers::of_ten_diameters(floor, diameter);
            Some(ColorBy::layers_of(start, &layers))
        }
        Color::PackingFraction => {
            let reach = tank.reach();
            Some(ColorBy::packing_fraction(reach, tank.floor, diameter))
        }
        _ => None,
    }
}

/// The sheet of a run, without a title.
fn sheet(run: &Run<'_>, color: ColorBy) -> PictureSheet {
    let record = run.record;
    let flat = Scenery::if_flat(&record.scene, &record.milestones);
    let stage = Stage::of_scene(&record.scene).around(run.shown.iter().copied(), &record.radius);
    PictureSheet {
        title: Vec::new(),
        radius: record.radius.clone(),
        stage: match &flat {
            Some(scenery) => scenery.on(stage),
            None => stage,
        },
        color,
        sides: Sides::default(),
        flat,
        units: record.scene.units(),
    }
}

/// The box that holds two others.
fn union(one: [[f64; 3]; 2], other: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let of = |corner: usize, pick: fn(f64, f64) -> f64| {
        std::array::from_fn(|axis| pick(one[corner][axis], other[corner][axis]))
    };
    [of(0, f64::min), of(1, f64::max)]
}
