//! Borders and bands as curves in a plane of two axes.
//!
//! A square of four places is cut into four triangles by its centre, where logarithms have the mean
//! of its corners; in a triangle they are linear. So the regions in which a label is the most
//! probable fill the plane without gaps: their borders end at the sides of the plane or where three
//! of them meet, and they cross the lines between places where [`Borders`](super::Borders) do.

use super::between::{equal, is_ahead};
use super::{Code, Lattice, ProbabilityMap};
use std::collections::BTreeMap;

/// Points (x, y) of a curve, in the units of the axes; a closed one ends where it starts.
pub type BorderCurve = Vec<[f64; 2]>;

/// A plane of two axes through a lattice.
#[derive(Clone, Copy, Debug)]
pub struct LatticePlane<'a> {
    /// The axes and places.
    pub lattice: &'a Lattice,
    /// Probabilities at all places.
    pub map: &'a ProbabilityMap,
    /// Axis to the right.
    pub x: usize,
    /// Axis upwards, different from `x`.
    pub y: usize,
    /// A place in the plane: its indices on the other axes define the plane.
    pub place: usize,
}

/// A corner of triangles: twice its indices along x and y, which are odd at centres of squares.
type Node = [usize; 2];

/// Identity of a point of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Vertex {
    /// On the edge between two nodes, the smaller first.
    Edge(Node, Node),
    /// In the triangle of these nodes, where a third label is equally probable.
    Junction([Node; 3], usize),
}

/// A point of a curve, in the scales of the axes.
type CurvePoint = (Vertex, [f64; 2]);

/// A triangle: its nodes, and the values there of functions that are linear in it.
struct Triangle<'a> {
    nodes: [Node; 3],
    /// Places of the nodes, in the scales of the axes.
    units: [[f64; 2]; 3],
    values: [&'a [f64]; 3],
}

impl LatticePlane<'_> {
    /// The border of two labels: where they are the most probable labels, equally so.
    pub fn border(&self, one: Code, other: Code) -> Vec<BorderCurve> {
        let (Some(one), Some(other)) = (self.label(one), self.label(other)) else {
            return Vec::new();
        };
        let labels = [one.min(other), one.max(other)];
        let logs = |place: usize| self.map.logs(place);
        self.contour(logs, |triangle| triangle.border(labels))
    }

    /// Where a label has this probability (between 0 and 1). For a band of 95 % between two labels
    /// the levels are 0.025 and 0.975, for one of 68 % 0.16 and 0.84.
    pub fn level(&self, label: Code, probability: f64) -> Vec<BorderCurve> {
        let Some(label) = self.label(label) else {
            return Vec::new();
        };
        let log = |p: f64| libm::log(p.max(1e-15));
        let log_odds = |p: f64| log(p) - log(1.0 - p);
        let wanted = log_odds(probability);
        let above = |place: usize| vec![log_odds(self.map.at(place)[label]) - wanted, 0.0];
        self.contour(above, |triangle| triangle.line([0, 1]))
    }

    fn label(&self, code: Code) -> Option<usize> {
        self.map.codes().iter().position(|other| *other == code)
    }

    /// The curves whose piece in each triangle is given by the values at the places.
    fn contour(
        &self,
        values: impl Fn(usize) -> Vec<f64>,
        piece: impl Fn(&Triangle<'_>) -> Option<[CurvePoint; 2]>,
    ) -> Vec<BorderCurve> {
        let [across, up] = [self.x, self.y].map(|axis| {
            let axis = &self.lattice.axes()[axis];
            let units = axis.values().iter().map(|value| axis.unit(*value));
            units.collect::<Vec<f64>>()
        });
        let nodes = |(j, i)| values(self.place_of(i, j));
        let rows = (0..up.len()).flat_map(|j| (0..across.len()).map(move |i| (j, i)));
        let at: Vec<Vec<f64>> = rows.map(nodes).collect();
        let mut joined: BTreeMap<Vertex, Vec<Vertex>> = BTreeMap::new();
        let mut points: BTreeMap<Vertex, [f64; 2]> = BTreeMap::new();
        for i in 1..across.len() {
            for j in 1..up.len() {
                let corners = [[i - 1, j - 1], [i, j - 1], [i, j], [i - 1, j]];
                let of_corners = corners.map(|[i, j]| at[i + j * across.len()].as_slice());
                let sums = (0..of_corners[0].len()).map(|index| {
                    let four = of_corners.map(|values| values[index]);
                    0.25 * ((four[0] + four[2]) + (four[1] + four[3]))
                });
                let of_centre: Vec<f64> = sums.collect();
                let centre = [i - 1, i].map(|i| across[i]).iter().sum::<f64>() * 0.5;
                let centre = [centre, 0.5 * (up[j - 1] + up[j])];
                for side in 0..4 {
                    let ends = [side, (side + 1) % 4];
                    let [one, other] = ends.map(|end| corners[end]);
                    let unit = |[i, j]: Node| [across[i], up[j]];
                    let triangle = Triangle {
                        nodes: [
                            one.map(|it| 2 * it),
                            other.map(|it| 2 * it),
                            [2 * i - 1, 2 * j - 1],
                        ],
                        units: [unit(one), unit(other), centre],
                        values: [of_corners[ends[0]], of_corners[ends[1]], &of_centre],
                    };
                    let Some([from, to]) = piece(&triangle) else {
                        continue;
                    };
                    points.extend([from, to]);
                    joined.entry(from.0).or_default().push(to.0);
                    joined.entry(to.0).or_default().push(from.0);
                }
            }
        }
        let value = |vertex: Vertex| {
            let [x, y] = points[&vertex];
            let axes = self.lattice.axes();
            [axes[self.x].value(x), axes[self.y].value(y)]
        };
        let chains = chains(joined).into_iter();
        chains
            .map(|chain| chain.into_iter().map(value).collect())
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

impl Triangle<'_> {
    /// Where two functions, the smaller index first, are equal: from edge to edge.
    fn line(&self, labels: [usize; 2]) -> Option<[CurvePoint; 2]> {
        let [from, to] = self.ends(labels)?;
        Some([self.on(from, labels), self.on(to, labels)])
    }

    /// The part of the line on which no other function is greater.
    fn border(&self, labels: [usize; 2]) -> Option<[CurvePoint; 2]> {
        let [one, other] = labels;
        let edges = self.ends(labels)?;
        let mut ends = edges.map(|edge| self.on(edge, labels));
        let mut shares = [0.0, 1.0];
        for third in (0..self.values[0].len()).filter(|it| !labels.contains(it)) {
            let [from, to] = edges.map(|edge| {
                let [low, high] =
                    edge.map(|node| self.values[node][one] - self.values[node][third]);
                low + self.share(edge, labels) * (high - low)
            });
            let share = from / (from - to);
            let end = match (from < 0.0, to < 0.0) {
                (false, false) => continue,
                (true, true) => return None,
                (true, false) if share > shares[0] => 0,
                (false, true) if share < shares[1] => 1,
                _ => continue,
            };
            shares[end] = share;
            let mut three = [one, other, third];
            three.sort_unstable();
            ends[end] = (
                Vertex::Junction(self.nodes, third),
                self.meeting(three).unwrap_or(ends[end].1),
            );
        }
        (shares[0] < shares[1]).then_some(ends)
    }

    /// The two edges, by indices of their nodes, on which the order of two functions changes.
    fn ends(&self, [one, other]: [usize; 2]) -> Option<[[usize; 2]; 2]> {
        let is_ahead = self.values.map(|values| is_ahead(values, one, other));
        let alone =
            (0..3).find(|&node| (0..3).all(|it| it == node || is_ahead[it] != is_ahead[node]))?;
        // From the smaller node, so that both triangles of an edge find the same point.
        let edge = |other: usize| match self.nodes[alone] < self.nodes[other] {
            true => [alone, other],
            false => [other, alone],
        };
        Some([edge((alone + 1) % 3), edge((alone + 2) % 3)])
    }

    /// Where two functions are equal on an edge, as a fraction of it.
    fn share(&self, edge: [usize; 2], [one, other]: [usize; 2]) -> f64 {
        equal(edge.map(|node| self.values[node]), one, other)
    }

    /// The point of an edge where two functions are equal.
    fn on(&self, edge: [usize; 2], labels: [usize; 2]) -> CurvePoint {
        let share = self.share(edge, labels);
        let [from, to] = edge.map(|node| self.units[node]);
        let unit = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        let [one, other] = edge.map(|node| self.nodes[node]);
        (Vertex::Edge(one, other), unit)
    }

    /// Where three functions are equal: a sum of the nodes with the weights that solve both
    /// equations.
    fn meeting(&self, [one, other, third]: [usize; 3]) -> Option<[f64; 2]> {
        let first = self.values.map(|values| values[one] - values[other]);
        let second = self.values.map(|values| values[other] - values[third]);
        let weights =
            [(1, 2), (2, 0), (0, 1)].map(|(a, b)| first[a] * second[b] - first[b] * second[a]);
        let sum: f64 = weights.iter().sum();
        let unit = [0, 1].map(|axis| {
            let parts = [0, 1, 2].map(|node| weights[node] * self.units[node][axis]);
            parts.iter().sum::<f64>() / sum
        });
        unit.iter().all(|it| it.is_finite()).then_some(unit)
    }
}

/// Vertices in the order in which they are joined, open chains first.
fn chains(mut joined: BTreeMap<Vertex, Vec<Vertex>>) -> Vec<Vec<Vertex>> {
    let ends = joined.iter().filter(|(_, next)| next.len() == 1);
    let ends: Vec<Vertex> = ends.map(|(vertex, _)| *vertex).collect();
    let all: Vec<Vertex> = joined.keys().copied().collect();
    let mut chains = Vec::new();
    for start in ends.into_iter().chain(all) {
        let mut chain = vec![start];
        let mut vertex = start;
        while let Some(next) = joined.get_mut(&vertex).and_then(|next| next.pop()) {
            if let Some(back) = joined.get_mut(&next)
                && let Some(place) = back.iter().position(|other| *other == vertex)
            {
                back.remove(place);
            }
            chain.push(next);
            vertex = next;
        }
        if chain.len() > 1 {
            chains.push(chain);
        }
    }
    chains
}
