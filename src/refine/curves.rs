//! Borders and bands as curves in a plane of two axes.

use super::{Code, Lattice, ProbabilityMap};
use std::collections::BTreeMap;

/// Points (x, y) of a curve, in the units of the axes; a closed one ends where it starts.
pub type Curve = Vec<[f64; 2]>;

/// A plane of two axes through a lattice.
#[derive(Clone, Copy, Debug)]
pub struct Panel<'a> {
    /// The axes and places.
    pub lattice: &'a Lattice,
    /// Probabilities at all places.
    pub map: &'a ProbabilityMap,
    /// Axis to the right.
    pub x: usize,
    /// Axis upwards, another than `x`.
    pub y: usize,
    /// A place in the plane: its indices on the other axes are those of the plane.
    pub place: usize,
}

/// An edge between two nodes: from that of these indices along x (0) or y (1).
type Edge = (usize, usize, usize);

impl Panel<'_> {
    /// The border of two labels: where their probabilities are equal, beside places of which they
    /// are the most probable ones.
    pub fn border(&self, one: Code, other: Code) -> Vec<Curve> {
        let (Some(one), Some(other)) = (self.label(one), self.label(other)) else {
            return Vec::new();
        };
        let value = |at: &[f64]| log(at[one]) - log(at[other]);
        self.contour(value, |corners| {
            let best = corners.map(|place| self.map.best(place));
            best.contains(&one) && best.contains(&other)
        })
    }

    /// Where a label has this probability (between 0 and 1). For a band of 95 % between two labels
    /// the levels are 0.025 and 0.975, for one of 68 % 0.16 and 0.84.
    pub fn level(&self, label: Code, probability: f64) -> Vec<Curve> {
        let Some(label) = self.label(label) else {
            return Vec::new();
        };
        let log_odds = |p: f64| log(p) - log(1.0 - p);
        let wanted = log_odds(probability);
        self.contour(|at| log_odds(at[label]) - wanted, |_| true)
    }

    fn label(&self, code: Code) -> Option<usize> {
        self.map.codes().iter().position(|other| *other == code)
    }

    /// Where a function of the probabilities passes zero in the squares that are asked for
    /// (marching squares); it is taken as linear in the scales of the axes.
    fn contour(
        &self,
        value: impl Fn(&[f64]) -> f64,
        is_asked: impl Fn([usize; 4]) -> bool,
    ) -> Vec<Curve> {
        let [columns, rows] = [self.x, self.y].map(|axis| self.lattice.axes()[axis].values().len());
        let node = |i: usize, j: usize| value(self.map.at(self.place_of(i, j)));
        let is_above = |i: usize, j: usize| node(i, j) >= 0.0;
        let ends = |(i, j, along): Edge| [(i, j), (i + 1 - along, j + along)];
        let mut joined: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
        for i in 1..columns {
            for j in 1..rows {
                let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
                if !is_asked(corners.map(|(i, j)| self.place_of(i, j))) {
                    continue;
                }
                let edges = [
                    (i - 1, j - 1, 0),
                    (i, j - 1, 1),
                    (i - 1, j, 0),
                    (i - 1, j - 1, 1),
                ];
                let crossed: Vec<Edge> = edges
                    .into_iter()
                    .filter(|edge| {
                        let [one, other] = ends(*edge);
                        is_above(one.0, one.1) != is_above(other.0, other.1)
                    })
                    .collect();
                // Two or four; at a saddle they are joined in this order.
                for pair in crossed.chunks_exact(2) {
                    joined.entry(pair[0]).or_default().push(pair[1]);
                    joined.entry(pair[1]).or_default().push(pair[0]);
                }
            }
        }
        let point = |edge: Edge| {
            let [one, other] = ends(edge);
            let [a, b] = [one, other].map(|(i, j)| node(i, j));
            let share = a / (a - b);
            let on = |axis: usize, from: usize, to: usize| {
                let axis = &self.lattice.axes()[axis];
                let [from, to] = [from, to].map(|index| axis.unit(axis.values()[index]));
                axis.value(from + share * (to - from))
            };
            [on(self.x, one.0, other.0), on(self.y, one.1, other.1)]
        };
        let chains = chains(joined).into_iter();
        chains
            .map(|chain| chain.into_iter().map(point).collect())
            .collect()
    }

    /// The place of the panel with these indices along x and y.
    fn place_of(&self, i: usize, j: usize) -> usize {
        let mut indices = self.lattice.indices(self.place);
        indices[self.x] = i;
        indices[self.y] = j;
        self.lattice.place(&indices)
    }
}

/// Logarithm, finite for 0 too.
fn log(p: f64) -> f64 {
    libm::log(p.max(1e-15))
}

/// Edges one after the other as they are joined, open chains first.
fn chains(mut joined: BTreeMap<Edge, Vec<Edge>>) -> Vec<Vec<Edge>> {
    let ends = joined.iter().filter(|(_, next)| next.len() == 1);
    let ends: Vec<Edge> = ends.map(|(edge, _)| *edge).collect();
    let all: Vec<Edge> = joined.keys().copied().collect();
    let mut chains = Vec::new();
    for start in ends.into_iter().chain(all) {
        let mut chain = vec![start];
        let mut edge = start;
        while let Some(next) = joined.get_mut(&edge).and_then(|next| next.pop()) {
            if let Some(back) = joined.get_mut(&next)
                && let Some(place) = back.iter().position(|other| *other == edge)
            {
                back.remove(place);
            }
            chain.push(next);
            edge = next;
        }
        if chain.len() > 1 {
            chains.push(chain);
        }
    }
    chains
}
