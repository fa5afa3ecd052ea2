//! Contours: where values on a grid of nodes pass zero (marching squares).

use std::collections::HashMap;

/// A piece of a curve: points in shown values.
pub(super) type Piece = Vec<(f64, f64)>;

/// Values at the nodes of a grid; `None` where there is no value.
pub(super) struct Nodes<'a> {
    /// Places of the nodes, ascending.
    pub(super) x: &'a [f64],
    pub(super) y: &'a [f64],
    /// Value of the node at the indices of x and y.
    pub(super) value: &'a dyn Fn(usize, usize) -> Option<f64>,
    /// Along which of x and y a value is taken for a power of the place less 1, rather than for
    /// linear in it.
    pub(super) logarithmic: [bool; 2],
}

/// An edge between two nodes: from the node of these indices along x (0) or y (1).
type Edge = (usize, usize, usize);

impl Nodes<'_> {
    /// The pieces of the contour.
    pub(super) fn contour(&self) -> Vec<Piece> {
        let mut next: HashMap<Edge, Vec<Edge>> = HashMap::new();
        let mut order = Vec::new();
        for i in 1..self.x.len() {
            for j in 1..self.y.len() {
                let edges = [
                    (i - 1, j - 1, 0),
                    (i, j - 1, 1),
                    (i - 1, j, 0),
                    (i - 1, j - 1, 1),
                ];
                let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
                if corners.iter().any(|&(i, j)| (self.value)(i, j).is_none()) {
                    continue;
                }
                // Two or four; at a saddle the crossings are joined in this order.
                let crossed: Vec<Edge> = edges
                    .into_iter()
                    .filter(|&edge| self.crossing(edge).is_some())
                    .collect();
                for pair in crossed.chunks_exact(2) {
                    next.entry(pair[0]).or_default().push(pair[1]);
                    next.entry(pair[1]).or_default().push(pair[0]);
                    order.extend_from_slice(pair);
                }
            }
        }
        self.join(next, order)
    }

    /// Joins pairs of neighbouring crossings to pieces, those with an end first.
    fn join(&self, mut next: HashMap<Edge, Vec<Edge>>, order: Vec<Edge>) -> Vec<Piece> {
        let (ends, others): (Vec<Edge>, Vec<Edge>) =
            order.into_iter().partition(|edge| next[edge].len() == 1);
        let mut pieces = Vec::new();
        for start in ends.into_iter().chain(others) {
            let mut piece = Vec::new();
            let mut here = start;
            while let Some(there) = next.get_mut(&here).and_then(Vec::pop) {
                if piece.is_empty() {
                    piece.extend(self.crossing(here));
                }
                piece.extend(self.crossing(there));
                if let Some(back) = next.get_mut(&there) {
                    back.retain(|edge| *edge != here);
                }
                here = there;
            }
            if !piece.is_empty() {
                pieces.push(piece);
            }
        }
        pieces
    }

    /// Where the contour crosses an edge.
    fn crossing(&self, (i, j, along): Edge) -> Option<(f64, f64)> {
        let (places, index, other) = match along {
            0 => (self.x, i, (i + 1, j)),
            _ => (self.y, j, (i, j + 1)),
        };
        let values = [(self.value)(i, j)?, (self.value)(other.0, other.1)?];
        if (values[0] < 0.0) == (values[1] < 0.0) {
            return None;
        }
        let place = zero(
            self.logarithmic[along],
            [places[index], places[index + 1]],
            values,
        );
        Some(match along {
            0 => (place, self.y[j]),
            _ => (self.x[i], place),
        })
    }
}

/// Where a value that is `values` at two places passes zero between them.
fn zero(logarithmic: bool, places: [f64; 2], values: [f64; 2]) -> f64 {
    let share = |[one, other]: [f64; 2]| one / (one - other);
    let [from, to] = places;
    if logarithmic {
        let share = share(values.map(libm::log1p));
        from * libm::pow(to / from, share)
    } else {
        from + (to - from) * share(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contour(value: &dyn Fn(f64, f64) -> Option<f64>) -> Vec<Piece> {
        let places: Vec<f64> = (-10..=10).map(|place| f64::from(place) / 5.0).collect();
        Nodes {
            x: &places,
            y: &places,
            value: &|i, j| value(places[i], places[j]),
            logarithmic: [false, false],
        }
        .contour()
    }

    #[test]
    fn a_straight_contour_is_one_piece_from_edge_to_edge() {
        let pieces = contour(&|x, y| Some(x + 2.0 * y - 0.3));
        assert_eq!(pieces.len(), 1);
        for (x, y) in &pieces[0] {
            assert!((x + 2.0 * y - 0.3).abs() < 1e-12);
        }
        let mut ends = [pieces[0][0].0, pieces[0][pieces[0].len() - 1].0];
        ends.sort_by(f64::total_cmp);
        assert_eq!(ends, [-2.0, 2.0]);
    }

    #[test]
    fn a_circle_closes() {
        let pieces = contour(&|x, y| Some(x * x + y * y - 1.1));
        assert_eq!(pieces.len(), 1);
        assert_eq!(pieces[0].first(), pieces[0].last());
        assert!(pieces[0].len() > 20);
    }

    #[test]
    fn nothing_is_drawn_where_there_is_no_value() {
        let pieces = contour(&|x, y| (x < 0.1).then_some(y - 0.1));
        assert!(pieces.iter().flatten().all(|point| point.0 < 0.1));
        assert!(!pieces.is_empty());
        assert!(contour(&|_, _| Some(1.0)).is_empty());
    }

    #[test]
    fn powers_pass_their_limit_where_they_are_one() {
        // (x / 3)^0.4 between 1 and 10.
        let ratio = |x: f64| libm::pow(x / 3.0, 0.4) - 1.0;
        let found = zero(true, [1.0, 10.0], [ratio(1.0), ratio(10.0)]);
        assert!((found - 3.0).abs() < 1e-9, "{found}");
        assert_eq!(zero(false, [1.0, 3.0], [-0.5, 0.5]), 2.0);
    }
}
