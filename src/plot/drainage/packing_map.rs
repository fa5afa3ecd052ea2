//! Maps of the local packing fraction (Rycroft, Wong and Bazant, 2010, figure 4).

use super::{Drainage, each};
use crate::classify::{DRAINAGE, Family};
use crate::measure::{CellBounds, CellGrid, Centres, local_packing_fraction, voronoi_cells};
use crate::observe::Snapshot;
use crate::particles::vector::Vector;
use crate::plot::canvas::SNAP;
use crate::plot::color_bar::ColorBar;
use crate::plot::page::{Frame, Page, Plan};
use crate::plot::scale::Span;
use crate::plot::style::px;
use crate::plot::svg::{Placed, Svg};
use crate::plot::{Figure, PlotError, Source, numbers};
use crate::render::Image;

/// Maps of the local packing fraction at two times.
pub(super) struct PackingMap;

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

impl Figure for PackingMap {
    fn name(&self) -> &'static str {
        "packing-map"
    }

    fn description(&self) -> String {
        "maps of the local packing fraction in the middle of the depth, at two times".to_owned()
    }

    fn default_runs(&self) -> Option<&'static str> {
        Some("a typical run of every state")
    }

    fn families(&self) -> Vec<&'static Family> {
        vec![&DRAINAGE]
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let (common, maps) = each(source, self.name(), |place, drainage| {
            let duration = drainage.record.scene.time.duration;
            let shown = source.times.unwrap_or(SHOWN.map(|share| share * duration));
            shown.map(|time| Map::new(drainage, time, place.clone()))
        })?;
        draw(self.name(), source, &common, maps.as_flattened())
    }
}

/// Packing fractions of a state in the plane y = 0.
struct Map {
    head: Vec<String>,
    /// Half of the width, and the height (diameters).
    extent: [f64; 2],
    /// Cells along the width and the height.
    cells: [usize; 2],
    /// Row by row from below; none where there are no spheres.
    values: Vec<Option<f64>>,
}

impl Map {
    /// Of the state nearest to a time.
    fn new(drainage: &Drainage<'_>, time: f64, mut head: Vec<String>) -> Self {
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

fn draw(
    name: &'static str,
    source: &Source<'_>,
    common: &[String],
    maps: &[Map],
) -> Result<Svg, PlotError> {
    let extent = maps.iter().fold([0.0; 2], |most: [f64; 2], map| {
        [0, 1].map(|axis| most[axis].max(map.extent[axis]))
    });
    let frame = |map: &Map| Frame {
        head: map.head.clone(),
        x: Span::linear((-map.extent[0], map.extent[0])),
        y: Span::linear((0.0, map.extent[1])),
    };
    let label = "local packing fraction".to_owned();
    let bar = ColorBar::new(RANGE.into_iter(), false, label);
    let bar = bar.ok_or(PlotError::NoMeasures { figure: name })?;
    let height = px(420);
    let notes = [format!(
        "Volume over that of the Voronoi cells, of the spheres within {DISTANCE} diameters of a \
         place at $y$ = 0."
    )];
    let page_beside = |bar: &ColorBar| {
        Page::new(Plan {
            title: source.sweep.title.as_deref(),
            common,
            frames: maps.iter().map(frame).collect(),
            columns: maps.len().min(COLUMNS),
            height,
            aspect: Some(2.0 * extent[0] / extent[1].max(1e-9)),
            aside: bar.width(),
            labels: ["$x$ / $d$", "height $z$ / $d$"].map(str::to_owned),
            notes: &notes,
            ..Plan::default()
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
    Svg::new(name, source, &body).with_pictures(pictures.collect())
}
