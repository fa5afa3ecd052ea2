//! Borders with their bands, and theory, on the map of a page.

use super::SweepResults;
use super::axes::AxisWithPlaces;
use crate::plot;
use crate::refine::{Crossing, LatticePlane};
use crate::report::document::CurveEntry;
use crate::sweep::label_name;
use std::collections::BTreeMap;

/// The curves over two axes of a sweep, for each slice of the others.
pub(super) fn curves(
    results: &SweepResults<'_>,
    axes: &[AxisWithPlaces],
    view: [usize; 2],
) -> Vec<CurveEntry> {
    let mut curves = borders(results, axes, view);
    // A diagram without theory is one all the same.
    let theory = plot::theory_curves(results.sweep, results.table);
    let theory = theory.into_iter().flatten();
    curves.extend(theory.map(|curve| {
        let slice = curve.slice.iter();
        let pieces = curve.pieces.into_iter();
        CurveEntry {
            kind: if curve.is_advice { "advice" } else { "theory" },
            name: curve.name.to_owned(),
            level: None,
            x: curve.axes[0],
            y: curve.axes[1],
            slice: slice
                .map(|(axis, value)| (*axis, axes[*axis].place(*value)))
                .collect(),
            pieces: pieces
                .map(|piece| piece.into_iter().flat_map(|(x, y)| [x, y]).collect())
                .collect(),
        }
    }));
    curves
}

/// Borders and bands of a refined sweep.
fn borders(
    results: &SweepResults<'_>,
    axes: &[AxisWithPlaces],
    view: [usize; 2],
) -> Vec<CurveEntry> {
    let Some(learnt) = results.learnt else {
        return Vec::new();
    };
    let name = |code| label_name(results.table.family, code);
    let others: Vec<usize> = (0..axes.len()).filter(|it| !view.contains(it)).collect();
    let mut curves = Vec::new();
    for indices in slices(axes, &others) {
        let slice = others.iter().map(|axis| (*axis, indices[*axis]));
        let slice: BTreeMap<usize, usize> = slice.collect();
        let entry = |kind, level, name: String, pieces| CurveEntry {
            kind,
            name,
            level,
            x: view[0],
            y: view[1],
            slice: slice.clone(),
            pieces,
        };
        let plane = LatticePlane {
            lattice: &learnt.lattice,
            map: &learnt.map,
            x: view[0],
            y: view[1],
            place: learnt.lattice.place(&indices),
        };
        let codes = learnt.map.codes();
        for (index, above) in codes.iter().enumerate() {
            for below in &codes[..index] {
                let pieces = plane.border(*below, *above).into_iter();
                let pieces: Vec<Vec<f64>> = pieces.map(|it| it.concat()).collect();
                let name = format!("{} to {}", name(*below), name(*above));
                curves.extend((!pieces.is_empty()).then(|| entry("border", None, name, pieces)));
            }
        }
        for (along, other) in [(view[0], view[1]), (view[1], view[0])] {
            let crossings = learnt.borders(along).map(|it| it.crossings);
            let crossings = crossings.into_iter().flatten();
            let here: Vec<Crossing> = crossings
                .filter(|it| {
                    others
                        .iter()
                        .all(|axis| axes[*axis].place(it.values[*axis]) == indices[*axis])
                })
                .collect();
            for (level, ends) in LEVELS {
                let bands = bands(&here, &axes[other].entry.values, (along, other), ends);
                curves.extend(bands.into_iter().map(|(codes, outline)| {
                    let outline = outline.into_iter();
                    let outline = outline.flat_map(|(across, at)| match along == view[1] {
                        true => [across, at],
                        false => [at, across],
                    });
                    let [below, above] = codes.map(name);
                    let name = format!("{below} to {above}");
                    entry("band", Some(level), name, vec![outline.collect()])
                }));
            }
        }
    }
    curves
}

/// Indices on all axes of one place in each slice.
fn slices(axes: &[AxisWithPlaces], others: &[usize]) -> Vec<Vec<usize>> {
    let mut all = vec![vec![0; axes.len()]];
    for axis in others {
        let values = 0..axes[*axis].entry.values.len();
        let with = |indices: &Vec<usize>, index| {
            let mut indices = indices.clone();
            indices[*axis] = index;
            indices
        };
        let each = all
            .iter()
            .flat_map(|indices| values.clone().map(move |it| with(indices, it)));
        all = each.collect();
    }
    all
}

/// The ends of an interval of a crossing.
type Ends = fn(&Crossing) -> [f64; 2];

/// The levels of bands (%), and the ends of their intervals.
const LEVELS: [(u8, Ends); 2] = [(95, |it| it.band95), (68, |it| it.band68)];

/// Labels below and above a border, and the points around its band.
type Outline = ([i8; 2], Vec<(f64, f64)>);

/// A band as it grows from column to column.
struct Band {
    labels: [i8; 2],
    /// The column that it has reached, and the value of its border there.
    column: usize,
    at: f64,
    low: Vec<(f64, f64)>,
    high: Vec<(f64, f64)>,
}

/// Outlines around the intervals of crossings along an axis: those of neighbouring columns on the
/// `other` axis belong together, each to the nearest border of the same labels.
fn bands(
    crossings: &[Crossing],
    columns: &[f64],
    (along, other): (usize, usize),
    ends: Ends,
) -> Vec<Outline> {
    let mut bands: Vec<Band> = Vec::new();
    for (column, value) in columns.iter().enumerate() {
        for crossing in crossings.iter().filter(|it| it.values[other] == *value) {
            let at = crossing.values[along];
            let before = bands
                .iter_mut()
                .filter(|band| band.labels == crossing.labels && band.column + 1 == column);
            let distance = |band: &&mut Band| (band.at - at).abs();
            let nearest = before.min_by(|one, two| distance(one).total_cmp(&distance(two)));
            let [low, high] = ends(crossing);
            let (low, high) = ((*value, low), (*value, high));
            match nearest {
                Some(band) => {
                    (band.column, band.at) = (column, at);
                    band.low.push(low);
                    band.high.push(high);
                }
                None => bands.push(Band {
                    labels: crossing.labels,
                    column,
                    at,
                    low: vec![low],
                    high: vec![high],
                }),
            }
        }
    }
    let outline = |band: Band| {
        let back = band.high.into_iter().rev();
        (band.labels, band.low.into_iter().chain(back).collect())
    };
    bands.into_iter().map(outline).collect()
}
