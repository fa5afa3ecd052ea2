//! How well layers of two colours are mixed.

use super::bins::Bins;
use super::{Centres, Layers, Region};

/// Lacey's index of mixing (Lacey, Journal of Applied Chemistry 4, 257 (1954)) of layers of two
/// colours, from the shares of one colour in cells of a region:
///
/// M = (S0^2 - S^2) / (S0^2 - Sr^2), S0^2 = p q, Sr^2 = p q / n
///
/// p and q = 1 - p are the shares of the colours in the whole region, S0^2 the variance over cells
/// of unmixed layers, and Sr^2 the variance of random spheres, n in a cell. S^2 is the measured
/// variance, weighted by the number of spheres in a cell: the index of random spheres is then 1 on
/// average even if the numbers differ (n is their mean over the cells that are not empty), and
/// cells with few spheres count little.
///
/// The index is 0 for layers that no cell straddles, however they are bent: only mixing below the
/// scale of a cell counts. For random spheres it may exceed 1 by chance.
///
/// * `layers`: the layer of each sphere of the scene; spheres without one do not count
/// * `cells`: number of cells along each axis, one or more
///
/// `None` if the region holds only one colour, or one sphere per cell.
pub fn lacey_index(
    centres: &Centres,
    layers: &[Option<usize>],
    region: &Region,
    cells: [usize; 3],
) -> Option<f64> {
    let bins = Bins {
        region: *region,
        counts: cells,
    };
    // Numbers of all spheres and of the second colour in each cell.
    let mut counts = vec![[0.0; 2]; bins.len()];
    for (place, number) in centres.place.iter().zip(&centres.number) {
        let layer = layers.get(*number).copied().flatten();
        if let (Some(cell), Some(layer)) = (bins.index(*place), layer) {
            counts[cell][0] += 1.0;
            counts[cell][1] += Layers::color(layer) as f64;
        }
    }
    counts.retain(|[spheres, _]| *spheres > 0.0);
    let spheres: f64 = counts.iter().map(|it| it[0]).sum();
    let share = counts.iter().map(|it| it[1]).sum::<f64>() / spheres;
    let square = |[spheres, colored]: &[f64; 2]| {
        let deviation = colored / spheres - share;
        spheres * deviation * deviation
    };
    let variance = counts.iter().map(square).sum::<f64>() / spheres;
    let unmixed = share * (1.0 - share);
    let random = unmixed * counts.len() as f64 / spheres;
    (unmixed > random).then(|| (unmixed - variance) / (unmixed - random))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{Random, ideal_gas, of};
    use crate::particles::vector::Vector;

    const LAYERS: Layers = Layers {
        floor: 0.0,
        thickness: 10.0,
    };
    const REGION: Region = Region {
        low: [0.0; 3],
        high: [40.0, 40.0, 40.0],
    };

    fn layers(centres: &Centres) -> Vec<Option<usize>> {
        let heights = centres.place.iter().map(|it| it.z);
        heights.map(|it| Some(LAYERS.layer(it))).collect()
    }

    #[test]
    fn layers_are_unmixed_and_shuffled_ones_mixed() {
        let gas = ideal_gas(12_000, 40.0, "mixing");
        let mut layers = layers(&gas);
        let index = |layers: &[Option<usize>]| lacey_index(&gas, layers, &REGION, [8; 3]).unwrap();
        assert!(index(&layers).abs() < 1e-12);
        // Half of the spheres are shuffled among themselves: the deviations halve, and S^2 falls to
        // a quarter of its way.
        let mut random = Random::new("shuffle");
        shuffle(&mut layers[..6000], &mut random);
        let half = index(&layers);
        assert!((half - 0.75).abs() < 0.02, "{half}");
        shuffle(&mut layers, &mut random);
        let mixed = index(&layers);
        // 512 cells: the relative scatter of S^2 is sqrt(2 / 512), and S^2 is 1/23 of S0^2.
        assert!((mixed - 1.0).abs() < 0.01, "{mixed}");
    }

    fn shuffle(layers: &mut [Option<usize>], random: &mut Random) {
        for last in (1..layers.len()).rev() {
            layers.swap(last, (random.uniform() * (last + 1) as f64) as usize);
        }
    }

    /// Cells halved by an edge count as mixed.
    #[test]
    fn cells_that_straddle_an_edge_are_mixed() {
        let gas = ideal_gas(12_000, 40.0, "straddled edges");
        let half = Region {
            low: [0.0, 0.0, 5.0],
            high: [40.0, 40.0, 35.0],
        };
        let index = lacey_index(&gas, &layers(&gas), &half, [4, 4, 3]).unwrap();
        assert!((index - 1.0).abs() < 0.02, "{index}");
    }

    #[test]
    fn one_color_or_one_sphere_has_no_index() {
        let gas = ideal_gas(1000, 40.0, "one colour");
        let layers = layers(&gas);
        let lowest = Region {
            high: [40.0, 40.0, 10.0],
            ..REGION
        };
        assert_eq!(lacey_index(&gas, &layers, &lowest, [2; 3]), None);
        let two = of(vec![
            Vector::new(1.0, 1.0, 1.0),
            Vector::new(1.0, 1.0, 11.0),
        ]);
        let colors = [Some(0), Some(1)];
        assert_eq!(lacey_index(&two, &colors, &REGION, [1, 1, 4]), None);
        assert_eq!(lacey_index(&gas, &[], &REGION, [2; 3]), None);
        assert_eq!(
            lacey_index(&Centres::default(), &layers, &REGION, [2; 3]),
            None
        );
    }
}
