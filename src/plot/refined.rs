//! What a refined sweep has learnt: the most probable label at every point, how sure it is, borders
//! as curves, and the runs.

use super::critical;
use super::diagram::{Diagram, Look};
use super::grid::{self, GridAxis, GridPanel, PanelGrid};
use super::legend::{LegendEntry, LegendKey};
use super::panel_curve::{PanelCurve, Stroke};
use super::phase;
use super::style::Fill;
use super::svg::Svg;
use super::{Figure, PlotError, Source, palette};
use crate::refine::{self, Code};
use crate::sweep::{FAILED, Learnt};
use plotters::style::{BLACK, RGBColor, WHITE};
use std::collections::{BTreeMap, BTreeSet, HashSet};

/// Most panels along one axis.
const MOST_PANELS: usize = 4;

/// Probability of the most probable label below which a point is in the bands of 68 and 95 %.
const BOUNDS: [f64; 2] = [0.84, 0.975];

/// Share of a colour that is left in the bands, as for seeds of which this share agrees.
const SHADES: [f64; 2] = [0.45, 0.75];

/// Name of the figure.
const NAME: &str = "refined";

/// A point of the grid.
#[derive(Clone, Copy, Debug)]
struct RefinedCell {
    code: Code,
    certainty: f64,
    /// The label of most runs that were made there.
    of_runs: Option<Code>,
    /// Whether one was still not steady when its time was up.
    is_unsteady: bool,
}

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "of a refined sweep: the most probable label at every point, paler in the bands of its \
         borders; the borders, and the runs",
        draw,
    )
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    grid::check(source.sweep, source.table)?;
    let learnt = Learnt::of(source.sweep, source.refining, source.table)?;
    let learnt = learnt.ok_or_else(|| {
        PlotError::request(
            "the figure `refined` needs a refined sweep: a table [refine] in its file, or `phase \
             sweep --refine`",
        )
    })?;
    let (grid, places) = grid_of(source, &learnt)?;
    let curves = curves(source, &learnt, &grid, &places);
    let cells = || grid.panels.iter().flat_map(|it| it.cells.iter().flatten());
    // Borders between places of one column are no curves.
    let is_plane = grid.x.values.len() > 1 && grid.cells().1 > 1;
    let diagram = Diagram {
        name: NAME,
        grid: &grid,
        look: &|cell: &RefinedCell| Some(look(source, *cell, is_plane)),
        empty: "no value".to_owned(),
        failed: HashSet::new(),
        legend: legend(source, &cells().copied().collect::<Vec<_>>()),
        bar: None,
    };
    let mut entries = PanelCurve::entries(&curves, critical::WORDS);
    let mut all = curves.iter().flatten();
    if all.any(|curve| curve.stroke == Stroke::Border && !curve.pieces.is_empty()) {
        entries.push(LegendEntry::new(LegendKey::Border, "border"));
    }
    let title = source.sweep.title.as_deref();
    let body = diagram.body(title, &curves, entries)?;
    Ok(Svg::new(NAME, &source.origin(), &body))
}

/// The grid of the figure, and a place of the lattice in each panel.
fn grid_of(
    source: &Source<'_>,
    learnt: &Learnt,
) -> Result<(PanelGrid<RefinedCell>, Vec<usize>), PlotError> {
    let sweep = source.sweep;
    let places = grid::places(sweep)?;
    let axis = |place: usize| {
        let index = places[place]?;
        let more = std::iter::empty();
        Some(GridAxis::over(index, &sweep.axes, &sweep.scene, more).with(&sweep.plot))
    };
    let panels_of = |place: usize| {
        let mut axis = axis(place)?;
        axis.values = shown_values(&axis.values);
        Some(axis)
    };
    let mut grid = PanelGrid {
        x: axis(0).ok_or_else(PlotError::no_axis)?,
        y: axis(1),
        columns: panels_of(2),
        rows: panels_of(3),
        panels: Vec::new(),
    };
    let values = |axis: &Option<GridAxis>| match axis {
        Some(axis) => axis.values.iter().copied().map(Some).collect(),
        None => vec![None],
    };
    let lattice = &learnt.lattice;
    let index_of = |axis: &GridAxis, value: f64| {
        let mut known = lattice.axes()[axis.index].values().iter();
        known.position(|other| *other == value).unwrap_or(0)
    };
    let cells = RefinedCells::new(source, learnt);
    let (columns, rows) = (values(&grid.columns), values(&grid.rows));
    let mut of_panels = Vec::new();
    for row in rows {
        for &column in &columns {
            let mut indices = vec![0; lattice.axes().len()];
            for (axis, value) in [(&grid.columns, column), (&grid.rows, row)] {
                if let Some((axis, value)) = axis.as_ref().zip(value) {
                    indices[axis.index] = index_of(axis, value);
                }
            }
            of_panels.push(lattice.place(&indices));
            let head = grid.columns.as_ref().zip(column);
            grid.panels.push(GridPanel {
                head: head.map(|(axis, value)| axis.at(value)),
                column,
                row,
                own: [None, None],
                cells: cells.of_panel(&grid.x, grid.y.as_ref(), indices),
            });
        }
    }
    Ok((grid, of_panels))
}

/// What is known of the places of a lattice.
struct RefinedCells<'a> {
    learnt: &'a Learnt,
    /// The labels of the runs at places.
    runs: BTreeMap<usize, Vec<Code>>,
    /// Places with runs that were not steady.
    unsteady: BTreeSet<usize>,
}

impl<'a> RefinedCells<'a> {
    fn new(source: &Source<'_>, learnt: &'a Learnt) -> Self {
        let (lattice, table) = (&learnt.lattice, source.table);
        let mut runs: BTreeMap<usize, Vec<Code>> = BTreeMap::new();
        for (run, code) in learnt.runs.iter() {
            if let Some(place) = lattice.place_of(&run.values) {
                runs.entry(place).or_default().push(code);
            }
        }
        let points = table.points().into_iter();
        let unsteady = points
            .filter(|point| table.is_unsteady(point))
            .filter_map(|point| lattice.place_of(&point.values));
        Self {
            learnt,
            runs,
            unsteady: unsteady.collect(),
        }
    }

    /// The cells of a panel over two axes, row by row; `indices` are those of the panel on others.
    fn of_panel(
        &self,
        x: &GridAxis,
        y: Option<&GridAxis>,
        mut indices: Vec<usize>,
    ) -> Vec<Option<RefinedCell>> {
        let mut cells = Vec::new();
        for height in 0..y.map_or(1, |axis| axis.values.len()) {
            for across in 0..x.values.len() {
                indices[x.index] = across;
                if let Some(y) = y {
                    indices[y.index] = height;
                }
                cells.push(Some(self.at(self.learnt.lattice.place(&indices))));
            }
        }
        cells
    }

    fn at(&self, place: usize) -> RefinedCell {
        let map = &self.learnt.map;
        let codes = self.runs.get(&place);
        RefinedCell {
            code: map.label(place),
            certainty: map.certainty(place),
            of_runs: codes.map(|codes| most(codes, map.label(place))),
            is_unsteady: self.unsteady.contains(&place),
        }
    }
}

/// The label that most of some runs have: of several that one, or else the least.
fn most(codes: &[Code], preferred: Code) -> Code {
    let count = |code: Code| codes.iter().filter(|it| **it == code).count();
    let best = codes.iter().map(|it| count(*it)).max().unwrap_or(0);
    let first = codes.iter().copied().filter(|it| count(*it) == best).min();
    match count(preferred) == best {
        true => preferred,
        false => first.unwrap_or(preferred),
    }
}

/// The values of an axis that have panels: all, or some at equal steps of the list with both ends.
pub(super) fn shown_values(values: &[f64]) -> Vec<f64> {
    if values.len() <= MOST_PANELS {
        return values.to_vec();
    }
    let (last, steps) = (values.len() - 1, MOST_PANELS - 1);
    let index = |step: usize| (2 * step * last + steps) / (2 * steps);
    (0..=steps).map(|step| values[index(step)]).collect()
}

/// The curves of each panel: borders, and the critical rotation over them.
fn curves(
    source: &Source<'_>,
    learnt: &Learnt,
    grid: &PanelGrid<RefinedCell>,
    places: &[usize],
) -> Vec<Vec<PanelCurve>> {
    let codes = learnt.map.codes();
    let pairs = || {
        let all = codes.iter().enumerate();
        all.flat_map(|(index, one)| codes[..index].iter().map(move |other| (*other, *one)))
    };
    let panels = grid.panels.iter().zip(places);
    let of_panel = |(panel, place): (&GridPanel<RefinedCell>, &usize)| {
        let mut curves = Vec::new();
        if let Some(y) = &grid.y {
            let plane = refine::LatticePlane {
                lattice: &learnt.lattice,
                map: &learnt.map,
                x: grid.x.index,
                y: y.index,
                place: *place,
            };
            let shown = |curve: refine::BorderCurve| {
                let points = curve.into_iter();
                points
                    .map(|[at, height]| (grid.x.show(at), y.show(height)))
                    .collect()
            };
            let pieces = pairs().flat_map(|(one, other)| plane.border(one, other));
            curves.push(PanelCurve {
                pieces: pieces.map(shown).collect(),
                stroke: Stroke::Border,
            });
        }
        curves.extend(critical::curves(source.sweep, grid, panel));
        curves
    };
    panels.map(of_panel).collect()
}

/// The fill of a label with this certainty.
fn fill(source: &Source<'_>, code: Code, certainty: f64) -> Fill {
    let mut labels = source.table.family.labels().into_iter();
    let Some(label) = labels.find(|label| label.code == code) else {
        return Fill::Stipple;
    };
    match phase::fill(label) {
        Fill::Color(color) => {
            let mut bounds = BOUNDS.iter().zip(SHADES);
            let shade = bounds.find(|(bound, _)| certainty < **bound);
            Fill::Color(palette::faded(color, shade.map_or(1.0, |(_, shade)| shade)))
        }
        pattern => pattern,
    }
}

fn look(source: &Source<'_>, cell: RefinedCell, is_plane: bool) -> Look {
    let fill = match fill(source, cell.code, cell.certainty) {
        Fill::Color(color) if cell.is_unsteady => Fill::Falling(color),
        fill => fill,
    };
    Look {
        // Of a plane, borders are curves.
        group: (!is_plane).then_some(cell.code),
        mark: cell.of_runs.map(|code| mark(source, cell, code)),
        ..Look::new(fill, None)
    }
}

/// The colour of the dot of a run: its own where another label is more probable.
fn mark(source: &Source<'_>, cell: RefinedCell, code: Code) -> RGBColor {
    match fill(source, code, 1.0) {
        _ if code == cell.code => BLACK,
        Fill::Color(color) => color,
        _ => WHITE,
    }
}

/// Entries of the legend but for curves.
fn legend(source: &Source<'_>, cells: &[RefinedCell]) -> Vec<LegendEntry> {
    let labels = source.table.family.labels().into_iter();
    let occurs = |code: Code| cells.iter().any(|cell| cell.code == code);
    let names = labels.map(|label| (label.code, label.name.replace('-', " ")));
    let names: Vec<(Code, String)> = names
        .chain([(FAILED, "failed".to_owned())])
        .filter(|(code, _)| occurs(*code))
        .collect();
    let entry = |(code, name): &(Code, String)| {
        LegendEntry::new(LegendKey::Fill(fill(source, *code, 1.0)), name)
    };
    let mut entries: Vec<LegendEntry> = names.iter().map(entry).collect();
    // Bands in the colour that is seen most.
    let colored = names.iter().map(|(code, _)| *code);
    let colored = colored.filter(|code| matches!(fill(source, *code, 1.0), Fill::Color(_)));
    let number = |code: &Code| cells.iter().filter(|cell| cell.code == *code).count();
    if let Some(code) = colored.max_by_key(number) {
        let words = ["in the 68 % band of a border", "in its 95 % band"];
        let bands = words.into_iter().zip([[0.0, BOUNDS[0]], BOUNDS]);
        for (words, [low, high]) in bands {
            let mut cells = cells.iter();
            if cells.any(|cell| (low..high).contains(&cell.certainty)) {
                entries.push(LegendEntry::new(
                    LegendKey::Fill(fill(source, code, low)),
                    words,
                ));
            }
        }
    }
    if cells.iter().any(|cell| cell.is_unsteady) {
        let key = LegendKey::Fill(Fill::Falling(WHITE));
        entries.push(LegendEntry::new(key, "run that was not steady"));
    }
    entries.push(LegendEntry::new(LegendKey::Mark(BLACK), "run"));
    let marks = cells
        .iter()
        .filter_map(|cell| Some(mark(source, *cell, cell.of_runs?)));
    if let Some(color) = marks.into_iter().find(|it| *it != BLACK) {
        entries.push(LegendEntry::new(
            LegendKey::Mark(color),
            "run of another label",
        ));
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_values_have_panels_the_ends_among_them() {
        let values: Vec<f64> = (0..9).map(f64::from).collect();
        assert_eq!(shown_values(&values), [0.0, 3.0, 5.0, 8.0]);
        assert_eq!(shown_values(&values[..4]), values[..4]);
        assert_eq!(shown_values(&values[..5]), [0.0, 1.0, 3.0, 4.0]);
    }
}
