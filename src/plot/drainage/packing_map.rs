//! Maps of the local packing fraction (Rycroft, Wong and Bazant, 2010, figure 4).

use super::{MeasuredDrainage, each, of_drainages};
use crate::measure::{CellBounds, CellGrid, Centres, local_packing_fraction, voronoi_cells};
use crate::observe::Snapshot;
use crate::particles::vector::Vector;
use crate::plot::canvas::SNAP;
use crate::plot::color_bar::ColorBar;
use crate::plot::page::{FigurePage, PagePlan, PanelFrame};
use crate::plot::runs::Runs;
use crate::plot::scale::AxisSpan;
use crate::plot::style::px;
use crate::plot::svg::{Placed, Svg};
use crate::plot::{Figure, PlotError, numbers};
use crate::render::Image;

/// Name of the figure.
const NAME: &str = "packing-map";

/// Distance of the spheres that count at a place, in diameters.
const DISTANCE: f64 = 2.2;
/// Cells of the map in a diameter.
const FINENESS: f64 = 2.0;
/// How far cells reach from centres at the free surface, in diameters.
const FARTHEST: f64 = 0.75;
/// Ends of the colours: a looser place has the first one.
const RANGE: [f64; 2] = [0.5, 0.66];
/// Times that are shown if none are asked for, as shares of the run: 20 and 120 of 180.
const SHOWN: [f64; 2] = [0.11, 0.67];
/// Maps beside each other.
const COLUMNS: usize = 4;

pub(super) fn figure() -> Figure {
    of_drainages(
        NAME,
        "maps of the local packing fraction in the middle of the depth, at two times",
        false,
        draw,
    )
}

fn draw(runs: &Runs<'_>) -> Result<Svg, PlotError> {
    let maps = each(runs, NAME, |place, drainage| {
        let duration = drainage.record.scene.time.duration;
        let shown = runs.times.unwrap_or(SHOWN.map(|share| share * duration));
        shown.map(|time| PackingPicture::new(drainage, time, place.clone()))
    })?;
    draw_maps(runs, maps.as_flattened())
}

/// Packing fractions of a state in the plane y = 0.
struct PackingPicture {
    head: Vec<String>,
    /// Half of the width, and the height (diameters).
    extent: [f64; 2],
    /// Cells along the width and the height.
    cells: [usize; 2],
    /// Row by row from below; `None` where there are no spheres.
    values: Vec<Option<f64>>,
}

impl PackingPicture {
    /// Of the state nearest to a time.
    fn new(drainage: &MeasuredDrainage<'_>, time: f64, mut head: Vec<String>) -> Self {
        let away = |state: &&Snapshot| (drainage.since_opening(state.time) - time).abs();
        let states = drainage.states().iter();
        let nearest = states.min_by(|one, other| away(one).total_cmp(&away(other)));
        let state = nearest.unwrap_or(drainage.start());
        let times = drainage.states().iter();
        let times: Vec<f64> = times.map(|it| drainage.since_opening(it.time)).collect();
        let shown = numbers::among(drainage.since_opening(state.time), &times);
        head.push(format!("$t$ = {shown} {}", drainage.units().of_time()));
        let diameter = drainage.filled_box.diameter;
        let [width, depth, floor] = [
            drainage.filled_box.half_width,
            drainage.filled_box.half_depth,
            drainage.filled_box.floor,
        ];
        let walls = CellBounds {
            low: [-width, -depth, floor],
            high: [width, depth, floor + drainage.filled_box.filled + diameter],
            farthest: FARTHEST * diameter,
        };
        let centres = Centres::of(state);
        let voronoi = voronoi_cells(&centres, &walls);
        let grid = CellGrid::new(&centres.place, DISTANCE * diameter);
        let step = diameter / FINENESS;
        let cells = [2.0 * width, drainage.filled_box.filled + diameter]
            .map(|it| (it / step).ceil() as usize);
        let value = |cell: usize| {
            let [column, row] = [cell % cells[0], cell / cells[0]];
            let x = (column as f64 + 0.5) * step - width;
            let z = floor + (row as f64 + 0.5) * step;
            let place = Vector::new(x, 0.0, z);
            local_packing_fraction(&grid, &voronoi, diameter, place, DISTANCE * diameter)
        };
        Self {
            head,
            extent: [width / diameter, cells[1] as f64 / FINENESS],
            cells,
            values: (0..cells[0] * cells[1]).map(value).collect(),
        }
    }

    /// Its picture; white where there are no spheres.
    fn image(&self, colors: &ColorBar, [width, height]: [usize; 2]) -> Image {
        let mut image = Image::white(width, height);
        for (index, pixel) in image.rgba.chunks_exact_mut(4).enumerate() {
            let column = index % width * self.cells[0] / width;
            let row = (height - 1 - index / width) * self.cells[1] / height;
            if let Some(value) = self.values[row * self.cells[0] + column] {
                let color = colors.color(value.clamp(RANGE[0], RANGE[1]));
                pixel[..3].copy_from_slice(&[color.0, color.1, color.2]);
            }
        }
        image
    }
}

fn draw_maps(runs: &Runs<'_>, maps: &[PackingPicture]) -> Result<Svg, PlotError> {
    let extent = maps.iter().fold([0.0; 2], |most: [f64; 2], map| {
        [0, 1].map(|axis| most[axis].max(map.extent[axis]))
    });
    let frame = |map: &PackingPicture| PanelFrame {
        head: map.head.clone(),
        x: AxisSpan::linear((-map.extent[0], map.extent[0])),
        y: AxisSpan::linear((0.0, map.extent[1])),
    };
    let label = "local packing fraction".to_owned();
    let bar = ColorBar::new(RANGE.into_iter(), false, label);
    let bar = bar.ok_or_else(|| PlotError::no_measures(NAME))?;
    let height = px(420);
    let notes = [format!(
        "Volume over that of the Voronoi cells, of the spheres within {DISTANCE} diameters of a \
         place at $y$ = 0."
    )];
    let page_beside = |bar: &ColorBar| {
        FigurePage::new(PagePlan {
            title: runs.origin.title,
            common: &runs.common,
            frames: maps.iter().map(frame).collect(),
            columns: maps.len().min(COLUMNS),
            height,
            aspect: Some(2.0 * extent[0] / extent[1].max(1e-9)),
            aside: bar.width(),
            labels: ["$x$ / $d$", "height $z$ / $d$"].map(str::to_owned),
            notes: &notes,
            ..PagePlan::default()
        })
    };
    let tall = bar.clone().fitted(height / 2);
    // Low maps leave less room.
    let room = page_beside(&tall).panel.1;
    let bar = if room < height / 2 {
        bar.fitted(room)
    } else {
        tall
    };
    let page = page_beside(&bar);
    let body = page.draw(|sheet| {
        for index in 0..maps.len() {
            page.axes(sheet, index)?.draw()?;
        }
        bar.draw(sheet, page.aside)
    })?;
    // Inside of the frame, on whole pixels.
    let inner = |length: i32| length / SNAP * SNAP;
    let pictures = maps.iter().enumerate().map(|(index, map)| {
        let (left, top) = page.corner(index);
        let (width, height) = page.panel;
        let corner = (inner(left + SNAP), inner(top + SNAP));
        let size = [left + width - corner.0, top + height - corner.1];
        Placed {
            image: map.image(&bar, size.map(|it| (inner(it - 1) / SNAP).max(1) as usize)),
            corner,
        }
    });
    Svg::new(NAME, &runs.origin, &body).with_pictures(pictures.collect())
}
