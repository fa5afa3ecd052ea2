//! The free surface of a drained box (Rycroft, Wong and Bazant, 2010, section 3).

use super::Centres;

/// Columns on each side.
const COLUMNS: usize = 10;
/// Width of a column, in diameters.
const WIDTH: f64 = 2.5;

/// Slope of the free surface (rad), positive if it rises from the middle to the walls: the
/// regression of the largest heights z_j in columns | |x| - x_j | < 1.25 d, at x_j = (2.5 j - 1.25)
/// d for j = 1 to 10, or as many as the half width (m) of the box has room for.
///
/// `None` if fewer than three columns have a sphere.
pub fn surface_angle(centres: &Centres, diameter: f64, half_width: f64) -> Option<f64> {
    let width = WIDTH * diameter;
    let columns = ((half_width / width + 1e-9) as usize).min(COLUMNS);
    let mut highest = vec![f64::NEG_INFINITY; columns];
    for place in &centres.place {
        if let Some(column) = highest.get_mut((place.x.abs() / width) as usize) {
            *column = column.max(place.z);
        }
    }
    let points = highest.iter().enumerate().filter(|(_, z)| z.is_finite());
    let points: Vec<[f64; 2]> = points
        .map(|(column, z)| [(column as f64 + 0.5) * width, *z])
        .collect();
    (points.len() >= 3).then(|| libm::atan(slope(&points)))
}

/// Slope of the line of least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|it| it[axis]).sum::<f64>() / count;
    let [x, z] = [mean(0), mean(1)];
    let products: f64 = points.iter().map(|it| (it[0] - x) * (it[1] - z)).sum();
    let squares: f64 = points.iter().map(|it| (it[0] - x) * (it[0] - x)).sum();
    products / squares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::ideal_gas;

    #[test]
    fn the_slope_of_a_wedge_is_found() {
        let mut gas = ideal_gas(200_000, 50.0, "wedge");
        for place in &mut gas.place {
            place.x -= 25.0;
            place.z = place.z * 0.4 + 0.3 * place.x.abs() - 20.0;
        }
        let angle = surface_angle(&gas, 1.0, 25.0).unwrap();
        assert!((libm::tan(angle) - 0.3).abs() < 0.01, "{angle}");
        assert_eq!(surface_angle(&Centres::default(), 1.0, 25.0), None);
    }
}
