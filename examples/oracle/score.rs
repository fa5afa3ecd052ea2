//! How good a map of probabilities is, beside the full map.

use super::maps::PublishedMap;
use phase::refine::{Borders, Code, Crossing, Observations, ProbabilityMap, RefineError, Rounds};

/// The probability of the most probable label below which a place is in the bands of 68 and 95 %.
const BOUNDS: [f64; 2] = [0.84, 0.975];

/// Shares of places and of borders that a map of probabilities has right. Borders are those
/// between merged labels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Score {
    /// Share of places with the right label.
    pub(crate) right: f64,
    /// The same with merged labels.
    pub(crate) right_merged: f64,
    /// Share of the pairs of neighbouring places with different labels between which the map has a
    /// border too, or of which one lies in the bands: of 68 and 95 %.
    pub(crate) covered: [f64; 2],
    /// Share of the places that lie in the bands: the price of `covered`.
    pub(crate) area: [f64; 2],
    /// Share of the borders along an axis that lie in the interval of a crossing: of 68 and
    /// 95 %. Places that differ from all neighbours make no border.
    pub(crate) held: [f64; 2],
    /// Mean length of the intervals of 95 % along that axis, as a share of it.
    pub(crate) width: f64,
}

/// Puts the label `fluid` of tanks (2) together with `settled` (1).
pub(crate) fn merged(code: Code) -> Code {
    if code == 2 { 1 } else { code }
}

/// Scores what rounds have found. Places that have been run show the label of most of their runs,
/// others the most probable one. `axis` is that of the intervals.
///
/// # Errors
/// If a run does not lie on the axes, or if there is no such axis.
pub(crate) fn score(
    truth: &PublishedMap,
    found: &mut Rounds,
    axis: usize,
) -> Result<Score, RefineError> {
    let places = truth.lattice().places();
    let map = found.map()?.clone();
    let merged_map = map.merged(merged);
    let seen = seen(truth, found.runs())?;
    let right = share(places, |place| {
        shown(&map, place, seen[place].clone()) == truth.label(place)
    });
    let right_merged = share(places, |place| {
        let seen = seen[place].iter().map(|code| merged(*code)).collect();
        shown(&merged_map, place, seen) == merged(truth.label(place))
    });
    let borders = Borders::new(truth.lattice(), &merged_map, axis)?;
    let widths = borders.crossings.iter().map(|crossing| crossing.width);
    Ok(Score {
        right,
        right_merged,
        covered: covered(truth, &merged_map),
        area: BOUNDS.map(|bound| share(places, |place| merged_map.certainty(place) < bound)),
        held: held(truth, &borders),
        width: widths.sum::<f64>() / borders.crossings.len().max(1) as f64,
    })
}

/// Share of the places of which something is true.
fn share(places: usize, is: impl Fn(usize) -> bool) -> f64 {
    (0..places).filter(|place| is(*place)).count() as f64 / places as f64
}

/// Share of a list of yes and no; 1 of none.
fn share_of(list: impl Iterator<Item = bool>) -> f64 {
    let list: Vec<bool> = list.collect();
    if list.is_empty() {
        return 1.0;
    }
    share(list.len(), |index| list[index])
}

/// Labels that runs have shown at each place.
fn seen(truth: &PublishedMap, runs: &Observations) -> Result<Vec<Vec<Code>>, RefineError> {
    let mut seen = vec![Vec::new(); truth.lattice().places()];
    for (run, code) in runs.iter() {
        truth.lattice().unit_of(&run.values)?;
        seen[truth.place(&run.values)].push(code);
    }
    Ok(seen)
}

/// The label of most runs of a place; without a single one, the most probable.
fn shown(map: &ProbabilityMap, place: usize, mut seen: Vec<Code>) -> Code {
    seen.sort_unstable();
    let count = |code: Code| seen.iter().filter(|other| **other == code).count();
    let most = seen.iter().map(|code| count(*code)).max().unwrap_or(0);
    let mut best = seen.clone();
    best.retain(|code| count(*code) == most);
    best.dedup();
    match best.as_slice() {
        [one] => *one,
        _ => map.label(place),
    }
}

fn covered(truth: &PublishedMap, map: &ProbabilityMap) -> [f64; 2] {
    let lattice = truth.lattice();
    let label = |place: usize| merged(truth.label(place));
    let pairs = (0..lattice.places()).flat_map(|one| {
        let others = lattice.neighbours(one).filter(move |other| *other > one);
        others.map(move |other| (one, other))
    });
    let pairs: Vec<(usize, usize)> = pairs
        .filter(|(one, other)| label(*one) != label(*other))
        .collect();
    BOUNDS.map(|bound| {
        share_of(pairs.iter().map(|(one, other)| {
            map.best(*one) != map.best(*other)
                || map.certainty(*one).min(map.certainty(*other)) < bound
        }))
    })
}

fn held(truth: &PublishedMap, borders: &Borders) -> [f64; 2] {
    let lattice = truth.lattice();
    let axis = borders.axis;
    let values = lattice.axes()[axis].values();
    let label = |place: usize| merged(truth.label(place));
    let is_alone = |place: usize| {
        let mut others = lattice.neighbours(place);
        others.all(|other| label(other) != label(place))
    };
    let above = |place: usize| {
        let mut indices = lattice.indices(place);
        indices[axis] += 1;
        (indices[axis] < values.len()).then(|| lattice.place(&indices))
    };
    let pairs = (0..lattice.places()).filter_map(|one| Some((one, above(one)?)));
    let pairs: Vec<(usize, usize)> = pairs
        .filter(|&(one, other)| label(one) != label(other) && !is_alone(one) && !is_alone(other))
        .collect();
    let bands: [fn(&Crossing) -> [f64; 2]; 2] = [|it| it.band68, |it| it.band95];
    bands.map(|band| {
        share_of(pairs.iter().map(|(one, other)| {
            let (from, to) = (lattice.values(*one), lattice.values(*other));
            borders.crossings.iter().any(|crossing| {
                let [low, high] = band(crossing);
                let mut others = (0..from.len()).filter(|it| *it != axis);
                others.all(|it| crossing.values[it] == from[it])
                    && low <= to[axis]
                    && high >= from[axis]
            })
        }))
    })
}
