//! Stagnant corners.

use crate::simulation::Snapshot;

/// Width of the strip along the side walls, in diameters.
const STRIP: f64 = 2.0;

/// Height (m) up to which the spheres along the side walls x = -half_width and half_width are
/// stagnant: the number of layers of one diameter, from `floor` up, in which at most half of the
/// spheres sank by more than a diameter between two snapshots. Spheres that were pushed aside or up
/// do not count as flowing.
///
/// * `diameter`: of the spheres (m)
///
/// Spheres that have left between the snapshots sank.
pub fn stagnant_height(
    before: &Snapshot,
    after: &Snapshot,
    diameter: f64,
    half_width: f64,
    floor: f64,
) -> f64 {
    let mut layers: Vec<[usize; 2]> = Vec::new();
    let rows = before
        .position
        .rows()
        .into_iter()
        .zip(after.position.rows());
    for (before, after) in rows {
        if before[0].is_nan() || before[0].abs() < half_width - STRIP * diameter {
            continue;
        }
        let layer = ((before[2] - floor) / diameter).max(0.0) as usize;
        if layers.len() <= layer {
            layers.resize(layer + 1, [0; 2]);
        }
        // Not a number where the sphere has left.
        let stays = before[2] - after[2] <= diameter;
        layers[layer][usize::from(!stays)] += 1;
    }
    let is_stagnant = |[stay, move_on]: &&[usize; 2]| *stay > 0 && stay >= move_on;
    layers.iter().take_while(is_stagnant).count() as f64 * diameter
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    #[test]
    fn layers_count_from_the_floor_up() {
        let count = 400;
        let position = Array2::from_shape_fn((count, 3), |(sphere, axis)| match axis {
            0 => -9.5 + (sphere % 20) as f64,
            1 => 0.0,
            _ => 2.5 + (sphere / 20) as f64,
        });
        let before = Snapshot {
            position,
            ..Snapshot::default()
        };
        let mut after = before.clone();
        // What is above 9 fell by two, and one sphere left.
        for mut row in after.position.rows_mut() {
            if row[2] > 9.0 {
                row[2] -= 2.0;
            }
        }
        let height = stagnant_height(&before, &after, 1.0, 10.0, 2.0);
        assert_eq!(height, 7.0);
        // Symptom: corners that spots had pushed up by more than a diameter counted as flowing.
        let mut pushed = before.clone();
        pushed
            .position
            .rows_mut()
            .into_iter()
            .for_each(|mut row| row[2] += 1.5);
        assert_eq!(stagnant_height(&before, &pushed, 1.0, 10.0, 2.0), 20.0);
        after.position.fill(f64::NAN);
        assert_eq!(stagnant_height(&before, &after, 1.0, 10.0, 2.0), 0.0);
        assert_eq!(stagnant_height(&before, &before, 1.0, 10.0, 2.0), 20.0);
    }
}
