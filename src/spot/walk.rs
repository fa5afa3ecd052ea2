//! The random walk of a spot.

use super::arrangement::Arrangement;
use super::model::{Scratch, SpotRules};
use super::parameters::Walk;
use crate::particles::vector::Vector;

/// A spot of free volume.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MovingSpot {
    /// Its centre (m).
    pub position: Vector,
    /// Number of moves it has made.
    pub moves: u32,
}

impl SpotRules {
    /// The step of a spot to one of its four places, chosen by a random number 0 <= u < 1. `None`
    /// if a biased walk finds no sphere at any of them.
    pub(crate) fn step(
        &self,
        arrangement: &Arrangement,
        position: &[Vector],
        scratch: &mut Scratch,
        (spot, random): (Vector, f64),
    ) -> Option<Vector> {
        let Walk::Biased { exponent } = self.parameters.walk else {
            return Some(self.way(spot, (random * 4.0) as usize));
        };
        let ways: [Vector; 4] = std::array::from_fn(|place| self.way(spot, place));
        let weights = ways.map(|way| {
            let range = (spot + way * 0.5, self.parameters.spot_radius);
            fearless_simd::dispatch!(self.level, simd => {
                self.find(simd, arrangement, position, range, scratch);
            });
            scratch.moved.len() as f64
        });
        choose(weights, exponent, random).map(|place| ways[place])
    }

    /// The middle of a spot's step, if spheres have no influence on it; else the spot's place.
    #[inline(always)]
    pub(crate) fn expected_centre(&self, spot: Vector, random: f64) -> Vector {
        match self.parameters.walk {
            Walk::Unbiased => spot + self.way(spot, (random * 4.0) as usize) * 0.5,
            Walk::Biased { .. } => spot,
        }
    }

    /// The step of a spot to one of its four places, cut off at the distance from walls.
    #[inline(always)]
    fn way(&self, spot: Vector, place: usize) -> Vector {
        let parameters = &self.parameters;
        let [x, y, z] = parameters.step;
        let along = |at: f64, step: f64, half: f64| {
            let most = half - parameters.wall_distance;
            if at + step > most {
                most - at
            } else if at + step < -most {
                -most - at
            } else {
                step
            }
        };
        let x = if place & 1 == 0 { x } else { -x };
        let y = if place & 2 == 0 { y } else { -y };
        Vector::new(
            along(spot.x, x, parameters.half_width),
            along(spot.y, y, parameters.half_depth),
            z,
        )
    }
}

/// Index of a place with probability p_i^beta / sum of p_j^beta (Rycroft, Wong and Bazant (2010),
/// section 3), chosen by a random number 0 <= u < 1. `None` if all p are zero.
fn choose(counts: [f64; 4], exponent: f64, random: f64) -> Option<usize> {
    let most = counts.into_iter().fold(0.0, f64::max);
    if most == 0.0 {
        return None;
    }
    // Relative to the greatest, so that no exponent overflows.
    let weights = counts.map(|count| match count > 0.0 {
        true if exponent == 1.0 => count / most,
        true => libm::pow(count / most, exponent),
        false => 0.0,
    });
    let mut rest = random * weights.iter().sum::<f64>();
    let mut last = None;
    for (place, weight) in weights.into_iter().enumerate() {
        if weight > 0.0 {
            last = Some(place);
            if rest < weight {
                break;
            }
            rest -= weight;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::parameters::Parameters;
    use crate::spot::random::RandomStream;

    #[test]
    fn a_free_walk_spreads_by_the_squares_of_its_steps() {
        let model = SpotRules::new(Parameters::figure_2(1.0));
        let mut random = RandomStream::new("free walk", 1);
        let (walkers, steps) = (4000, 100);
        let mut squares = 0.0;
        for _ in 0..walkers {
            let mut spot = Vector::ZERO;
            for _ in 0..steps {
                spot += model.way(spot, random.below(4));
            }
            squares += spot.x * spot.x;
            assert!((spot.z - 10.0).abs() < 1e-9);
            assert!(spot.y.abs() <= 3.0);
        }
        // 2 b z with b = 2.28 d at z = 10 d; the spread of a variance is sqrt(2/n).
        let variance = squares / f64::from(walkers);
        assert!(
            (variance / (2.0 * 2.28 * 10.0) - 1.0).abs() < 0.08,
            "{variance}"
        );
    }

    #[test]
    fn steps_are_cut_off_at_the_walls() {
        let model = SpotRules::new(Parameters::figure_2(1.0));
        let way = model.way(Vector::new(-23.8, 2.9, 1.0), 1);
        assert!((way.x + 0.2).abs() < 1e-12);
        assert!((way.y - 0.1).abs() < 1e-12);
        assert_eq!(way.z, 0.1);
    }

    #[test]
    fn places_are_chosen_by_powers_of_their_counts() {
        let mut random = RandomStream::new("choices", 2);
        for (exponent, sum) in [(1.0, 10.0), (3.0, 100.0)] {
            let mut chosen = [0.0; 4];
            for _ in 0..40_000 {
                let place = choose([1.0, 2.0, 3.0, 4.0], exponent, random.uniform());
                chosen[place.expect("some are near")] += 1.0 / 40_000.0;
            }
            for (place, share) in chosen.into_iter().enumerate() {
                let expected = libm::pow(place as f64 + 1.0, exponent) / sum;
                assert!(
                    (share - expected).abs() < 0.01,
                    "{exponent}: {share} of {expected}"
                );
            }
        }
        assert_eq!(choose([0.0; 4], 1.0, 0.5), None);
        assert_eq!(choose([0.0, 0.0, 5.0, 0.0], 10.0, 0.99), Some(2));
    }
}
