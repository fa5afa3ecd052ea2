//! Borders of several labels, as curves and as a table.
//!
//! Symptom: the curves crossed and stuck out where three labels meet, and the table had borders of
//! two labels between which a third one was the most probable. Cause: a curve was drawn wherever
//! its two labels were equally probable, in every square with a corner of each; the table looked at
//! places alone.

use phase::refine::model::Fitted;
use phase::refine::{
    AxisScale, BorderCurve, Borders, Code, Lattice, LatticeAxis, LatticePlane, ProbabilityMap,
};
use proptest::prelude::*;

/// Made-up logarithms of probabilities: for each label a constant, slopes and a curvature.
struct MadeUp(Vec<[f64; 4]>);

impl Fitted for MadeUp {
    fn predict(&self, units: &[&[f64]]) -> Vec<Vec<f64>> {
        let at = |unit: &&[f64]| {
            let log = |[constant, x, y, both]: &[f64; 4]| {
                constant + x * unit[0] + y * unit[1] + both * (unit[0] - 0.5) * (unit[1] - 0.4)
            };
            let odds: Vec<f64> = self.0.iter().map(|it| libm::exp(log(it))).collect();
            let sum: f64 = odds.iter().sum();
            odds.iter().map(|it| it / sum).collect()
        };
        units.iter().map(at).collect()
    }
}

fn map(labels: Vec<[f64; 4]>) -> (Lattice, ProbabilityMap) {
    let values = |count: usize| (0..count).map(|k| (k * k) as f64);
    let across = LatticeAxis::new("x", values(8).collect(), AxisScale::Rank).unwrap();
    let up =
        LatticeAxis::new("y", values(11).map(|it| 1.0 + it).collect(), AxisScale::Log).unwrap();
    let lattice = Lattice::new(vec![across, up]).unwrap();
    let codes: Vec<Code> = (0..labels.len() as Code).collect();
    let map = ProbabilityMap::new(&lattice, &codes, &MadeUp(labels));
    (lattice, map)
}

/// Borders of all pairs of labels.
fn curves(lattice: &Lattice, map: &ProbabilityMap) -> Vec<([Code; 2], BorderCurve)> {
    let panel = LatticePlane {
        lattice,
        map,
        x: 0,
        y: 1,
        place: 0,
    };
    let codes = map.codes();
    let pairs = codes
        .iter()
        .flat_map(|one| codes.iter().map(move |other| [*one, *other]));
    let pairs = pairs.filter(|[one, other]| one < other);
    pairs
        .flat_map(|pair| {
            let curves = panel.border(pair[0], pair[1]).into_iter();
            curves.map(move |curve| (pair, curve))
        })
        .collect()
}

fn is_near(one: f64, other: f64) -> bool {
    (one - other).abs() < 1e-9 * (1.0 + other.abs())
}

/// Whether a point is at a side of the plane.
fn is_at_side(lattice: &Lattice, point: [f64; 2]) -> bool {
    (0..2).any(|axis| {
        let values = lattice.axes()[axis].values();
        is_near(point[axis], values[0]) || is_near(point[axis], values[values.len() - 1])
    })
}

fn made_up() -> impl Strategy<Value = Vec<[f64; 4]>> {
    let slopes = -8.0..8.0_f64;
    let label = (-3.0..3.0_f64, slopes.clone(), slopes, -9.0..9.0_f64);
    let label = label.prop_map(|(constant, x, y, both)| [constant, x, y, both]);
    prop::collection::vec(label, 2..6)
}

proptest! {
    #[test]
    fn borders_end_at_a_side_or_where_three_meet(labels in made_up()) {
        let (lattice, map) = map(labels);
        let curves = curves(&lattice, &map);
        let ends: Vec<([Code; 2], [f64; 2])> = curves
            .iter()
            .filter(|(_, curve)| curve[0] != curve[curve.len() - 1])
            .flat_map(|(pair, curve)| [(*pair, curve[0]), (*pair, curve[curve.len() - 1])])
            .collect();
        for (pair, end) in ends.iter().filter(|(_, end)| !is_at_side(&lattice, *end)) {
            let mut here: Vec<[Code; 2]> = ends
                .iter()
                .filter(|(_, other)| other == end)
                .map(|(pair, _)| *pair)
                .collect();
            here.sort_unstable();
            prop_assert_eq!(here.len(), 3, "{:?} ends at {:?}", pair, end);
            let [[a, b], [c, d], [e, f]] = [here[0], here[1], here[2]];
            prop_assert!(a == c && b == e && d == f, "{here:?}");
        }
    }

    #[test]
    fn the_table_and_the_curves_say_the_same(labels in made_up()) {
        let (lattice, map) = map(labels);
        let curves = curves(&lattice, &map);
        for axis in 0..2 {
            let other = 1 - axis;
            let lines = lattice.axes()[other].values();
            // A closed curve ends at its first point.
            let points = curves.iter().flat_map(|(pair, curve)| {
                let is_closed = curve.len() > 2 && curve[0] == curve[curve.len() - 1];
                let points = &curve[usize::from(is_closed)..];
                points.iter().map(move |point| (*pair, *point))
            });
            let on_lines = points.filter(|(_, point)| {
                lines.iter().any(|line| is_near(point[other], *line))
            });
            let on_lines: Vec<([Code; 2], [f64; 2])> = on_lines.collect();
            let table = Borders::new(&lattice, &map, axis).unwrap();
            for crossing in &table.crossings {
                let mut pair = crossing.labels;
                pair.sort_unstable();
                let is_here = |(of, point): &([Code; 2], [f64; 2])| {
                    *of == pair
                        && (0..2).all(|axis| is_near(point[axis], crossing.values[axis]))
                };
                prop_assert!(on_lines.iter().any(is_here), "{crossing:?}");
            }
            prop_assert_eq!(on_lines.len(), table.crossings.len());
        }
    }
}
