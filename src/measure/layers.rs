//! Horizontal layers that mark spheres.

use crate::simulation::Snapshot;

/// Layers of equal thickness, in two alternating colours. Spheres keep the layer in which they
/// start, so that its shape shows the flow, and its edge the mixing (Rycroft, Wong and Bazant,
/// 2010, figure 3, with layers of 10 d).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Where the lowest layer begins (m).
    pub floor: f64,
    /// Thickness of each (m).
    pub thickness: f64,
}

impl Layers {
    /// Layers of ten diameters above a floor.
    pub fn of_ten_diameters(floor: f64, diameter: f64) -> Self {
        Self {
            floor,
            thickness: 10.0 * diameter,
        }
    }

    /// The layer at a height (m), from 0 at the floor; heights below the floor belong to layer 0.
    pub fn layer(&self, height: f64) -> usize {
        ((height - self.floor) / self.thickness) as usize
    }

    /// The colour of a layer: 0 for the lowest, 1 for the next, and so on alternately.
    pub fn color(layer: usize) -> usize {
        layer % 2
    }

    /// The layer in which each sphere starts, for those that are in the first snapshot.
    pub fn of(&self, start: &Snapshot) -> Vec<Option<usize>> {
        let heights = start.position.column(2).into_iter();
        let layer = |height: &f64| (!height.is_nan()).then(|| self.layer(*height));
        heights.map(layer).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::snapshot;

    #[test]
    fn layers_begin_at_the_floor() {
        let layers = Layers {
            floor: 2.0,
            thickness: 10.0,
        };
        let heights = [2.0, 11.9, 12.0, 1.5, f64::NAN, 35.0];
        let start = snapshot(0.0, &heights.map(|it| [0.0, 0.0, it]));
        let expected = [Some(0), Some(0), Some(1), Some(0), None, Some(3)];
        assert_eq!(layers.of(&start), expected);
        assert_eq!([0, 1, 2, 3].map(Layers::color), [0, 1, 0, 1]);
    }
}
