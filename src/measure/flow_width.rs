//! The width of a flow, and how fast it grows upwards.

use super::VelocityProfile;
use super::blocks::Blocks;
use crate::statistics::Estimate;

/// Number of widths that are tried before the best is refined.
const TRIALS: u32 = 48;

/// Largest width that is distinguished from a flat profile, over the farthest place.
const WIDEST: f64 = 4.0;

/// The same between reflecting walls, over their distance from the middle: the profile is flat
/// within .2 %.
const WIDEST_BETWEEN_WALLS: f64 = 1.2;

/// Relative accuracy of a refined width.
const PRECISION: f64 = 1e-8;

/// Images farther away than this many widths are left out: they add less than 1e-10.
const REACH: f64 = 7.0;

/// The profile v = A exp(-x^2 / (2 sigma^2)) of the downward velocity in a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowWidth {
    /// Height of the middle of the layer (m).
    pub height: f64,
    /// Velocity A in the middle (m/s).
    pub amplitude: Estimate,
    /// Width sigma (m).
    pub width: Estimate,
}

impl FlowWidth {
    /// The velocity (m/s) of the fit at a place (m), with images in the same walls as in the fit.
    pub fn velocity(&self, place: f64, half_width: Option<f64>) -> f64 {
        let width = self.width.value;
        self.amplitude.value * GaussianShape { width, half_width }.at(place)
    }
}

/// The law sigma^2 = 2 b (z - z0) of the widths of a flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowSpread {
    /// Diffusion length b (m).
    pub diffusion_length: Estimate,
    /// Height z0 from which the flow spreads (m).
    pub origin: Estimate,
}

/// Fits a Gaussian around x = 0 to a profile over x by least squares; all bins count the same.
///
/// * `half_width`: side walls at x = -half_width and half_width (m) that reflect what spreads, so
///   that the images of the Gaussian in both walls are added to it. A Gaussian without images
///   (`None`) is too wide if the flow reaches the walls: in sigma^2 by 2 % at a sigma of .38
///   half_width, and by 30 % at .54.
///
/// Bins of width h show the profile as wider by h^2 / 12 in sigma^2, which is subtracted (Sheppard,
/// Proceedings of the London Mathematical Society 29, 353 (1898)). Intervals come, as for the
/// profile, from a jackknife over blocks of pairs of snapshots.
///
/// `None` if the profile has no width: if it is flat, or narrower than a bin.
pub fn flow_width(profile: &VelocityProfile, half_width: Option<f64>) -> Option<FlowWidth> {
    let blocks = Blocks::of(profile.rows());
    let [amplitude, width] = blocks.estimates(|sums| {
        let gaussian = fit(profile, half_width, sums)?;
        Some([gaussian.amplitude, gaussian.width_squared.sqrt()])
    })?;
    Some(FlowWidth {
        height: height(profile),
        amplitude,
        width,
    })
}

/// Fits b and z0 to the profiles over x of layers at several heights, each by [`flow_width`]: the
/// law of the kinematic model, Nedderman and Tüzün, Powder Technology 22, 243 (1979). The
/// regression has the weights 1 / sigma^4, for widths with equal relative errors.
///
/// A fluctuation of the flow rises through all layers. The jackknife therefore leaves out a block
/// of pairs of snapshots in all of them at once, and needs the same pairs in each.
///
/// `None` without two layers of different height, or if a layer has no width.
pub fn flow_spread(layers: &[VelocityProfile], half_width: Option<f64>) -> Option<FlowSpread> {
    let pairs = layers.first()?.rows().len();
    if layers.iter().any(|it| it.rows().len() != pairs) {
        return None;
    }
    let row = |pair: usize| layers.iter().flat_map(move |it| it.rows()[pair].clone());
    let rows: Vec<Vec<f64>> = (0..pairs).map(|pair| row(pair).collect()).collect();
    let blocks = Blocks::of(&rows);
    let [diffusion_length, origin] =
        blocks.estimates(|sums| regression(layers, half_width, sums))?;
    Some(FlowSpread {
        diffusion_length,
        origin,
    })
}

/// b and z0 from the sums of all layers.
fn regression(
    layers: &[VelocityProfile],
    half_width: Option<f64>,
    sums: &[f64],
) -> Option<[f64; 2]> {
    let mut rest = sums;
    let mut points = Vec::new();
    for layer in layers {
        let (own, others) = rest.split_at(2 * layer.bins());
        points.push((height(layer), fit(layer, half_width, own)?.width_squared));
        rest = others;
    }
    let weight = |square: f64| 1.0 / (square * square);
    let mean = |value: &dyn Fn(&(f64, f64)) -> f64| {
        let weighted = points.iter().map(|it| weight(it.1) * value(it));
        weighted.sum::<f64>() / points.iter().map(|it| weight(it.1)).sum::<f64>()
    };
    let (height, square) = (mean(&|it| it.0), mean(&|it| it.1));
    let variance = mean(&|it| (it.0 - height) * (it.0 - height));
    let slope = mean(&|it| (it.0 - height) * (it.1 - square)) / variance;
    (variance > 0.0 && slope != 0.0).then(|| [0.5 * slope, height - square / slope])
}

fn height(layer: &VelocityProfile) -> f64 {
    let region = layer.region();
    0.5 * (region.low[2] + region.high[2])
}

struct Gaussian {
    amplitude: f64,
    /// sigma^2 (m2).
    width_squared: f64,
}

/// The Gaussian of least squares. For a given width the best amplitude follows, so only the width
/// is searched for: over a wide range in equal ratios, then around the best by golden section.
fn fit(profile: &VelocityProfile, half_width: Option<f64>, sums: &[f64]) -> Option<Gaussian> {
    let point = |bin| Some([profile.place(bin), profile.velocity(sums, bin)?]);
    let points: Vec<[f64; 2]> = (0..profile.bins()).filter_map(point).collect();
    let farthest = points.iter().map(|it| it[0].abs()).fold(0.0, f64::max);
    let least = profile.width();
    let most = half_width.map_or(WIDEST * farthest, |it| WIDEST_BETWEEN_WALLS * it);
    let ratio = libm::pow(most / least, 1.0 / f64::from(TRIALS));
    let width = |trial: u32| least * libm::pow(ratio, f64::from(trial));
    let project = |width: f64| Projection::of(&points, &GaussianShape { width, half_width });
    let explained = |trial: &u32| project(width(*trial)).explained();
    let best = (0..=TRIALS).max_by(|one, other| explained(one).total_cmp(&explained(other)))?;
    if best == 0 || best == TRIALS {
        return None;
    }
    let width = golden_section([width(best - 1), width(best + 1)], |width| {
        project(width).explained()
    });
    let amplitude = project(width).amplitude();
    let bin = profile.width();
    (amplitude > 0.0).then_some(Gaussian {
        amplitude,
        width_squared: width * width - bin * bin / 12.0,
    })
}

/// A Gaussian of amplitude 1, and its images in the walls if there are any (m).
struct GaussianShape {
    width: f64,
    half_width: Option<f64>,
}

impl GaussianShape {
    fn at(&self, place: f64) -> f64 {
        let gaussian = |place: f64| {
            let deviations = place / self.width;
            libm::exp(-0.5 * deviations * deviations)
        };
        let Some(half_width) = self.half_width else {
            return gaussian(place);
        };
        let period = 2.0 * half_width;
        let images = ((REACH * self.width + half_width) / period).ceil() as i32;
        let image = |image: i32| gaussian(place + period * f64::from(image));
        (-images..=images).map(image).sum()
    }
}

/// A profile projected on a shape g.
struct Projection {
    /// Sum of v g.
    product: f64,
    /// Sum of g^2.
    norm: f64,
}

impl Projection {
    fn of(points: &[[f64; 2]], shape: &GaussianShape) -> Self {
        let (mut product, mut norm) = (0.0, 0.0);
        for [place, velocity] in points {
            let value = shape.at(*place);
            product += velocity * value;
            norm += value * value;
        }
        Self { product, norm }
    }

    fn amplitude(&self) -> f64 {
        self.product / self.norm
    }

    /// By how much the best amplitude lowers the sum of squares.
    fn explained(&self) -> f64 {
        // A narrow shape may reach no place.
        if self.norm == 0.0 {
            return 0.0;
        }
        self.product * self.product / self.norm
    }
}

/// The maximum of a unimodal function between two ends.
fn golden_section([mut low, mut high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    while high - low > PRECISION * high {
        let [left, right] = [high - share * (high - low), low + share * (high - low)];
        if value(left) < value(right) {
            low = left;
        } else {
            high = right;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{Random, falling};
    use crate::measure::{Region, SpaceAxis};

    const HALF_WIDTH: f64 = 25.0;
    const WALLS: Option<f64> = Some(HALF_WIDTH);
    const DIFFUSION_LENGTH: f64 = 2.28;
    const ORIGIN: f64 = -1.5;

    fn layers(bins: usize) -> Vec<VelocityProfile> {
        let layer = |height: f64| Region {
            low: [-HALF_WIDTH, -4.0, height - 1.0],
            high: [HALF_WIDTH, 4.0, height + 1.0],
        };
        let heights = [10.0, 20.0, 30.0, 40.0].into_iter();
        heights
            .map(|height| VelocityProfile::new(SpaceAxis::X, layer(height), bins))
            .collect()
    }

    /// Adds a pair of snapshots of the law's flow with reflecting walls.
    fn add(layers: &mut [VelocityProfile], random: &mut Random, amplitude: f64, noise: f64) {
        let sides = [[-HALF_WIDTH, HALF_WIDTH], [-4.0, 4.0], [5.0, 45.0]];
        let [before, after] = falling(random, 8000, sides, |[x, _, z], random| {
            let square = 2.0 * DIFFUSION_LENGTH * (z - ORIGIN);
            let images = (-2..=2).map(|image| {
                let x = x + 2.0 * HALF_WIDTH * f64::from(image);
                libm::exp(-0.5 * x * x / square)
            });
            amplitude * images.sum::<f64>() / square.sqrt() + noise * random.normal()
        });
        for layer in layers {
            layer.add(&before, &after);
        }
    }

    #[test]
    fn the_law_of_a_flow_without_noise_is_found() {
        let mut random = Random::new("flow without noise");
        let mut layers = layers(25);
        assert_eq!(flow_spread(&layers, WALLS), None);
        for _ in 0..40 {
            add(&mut layers, &mut random, 3.0, 0.0);
        }
        for (layer, height) in layers.iter().zip([10.0, 20.0, 30.0, 40.0]) {
            let found = flow_width(layer, WALLS).unwrap();
            assert_eq!(found.height, height);
            let width = (2.0 * DIFFUSION_LENGTH * (height - ORIGIN)).sqrt();
            assert!((found.width.value / width - 1.0).abs() < 5e-3, "{found:?}");
            let amplitude = found.amplitude.value * width / 3.0;
            assert!((amplitude - 1.0).abs() < 5e-3, "{found:?}");
        }
        let found = flow_spread(&layers, WALLS).unwrap();
        let relative = found.diffusion_length.value / DIFFUSION_LENGTH - 1.0;
        assert!(relative.abs() < 0.01, "{found:?}");
        assert!((found.origin.value - ORIGIN).abs() < 0.3, "{found:?}");
    }

    #[test]
    fn a_gaussian_alone_is_right_where_the_flow_does_not_reach_the_walls() {
        let mut random = Random::new("flow far from walls");
        let mut layers = layers(25);
        for _ in 0..40 {
            add(&mut layers, &mut random, 3.0, 0.0);
        }
        for (layer, [least, most]) in layers.iter().zip([[-0.01, 0.01], [0.02, 0.05], [0.1, 0.2]]) {
            let found = flow_width(layer, None).unwrap();
            let square = found.width.value * found.width.value;
            let excess = square / (2.0 * DIFFUSION_LENGTH * (found.height - ORIGIN)) - 1.0;
            assert!(
                excess > least && excess < most,
                "{}: {excess}",
                found.height
            );
        }
    }

    #[test]
    fn intervals_cover_the_law_of_a_noisy_flow() {
        let mut random = Random::new("noisy flow");
        let (mut lengths, mut origins) = (0, 0);
        for _ in 0..40 {
            let mut layers = layers(25);
            for _ in 0..10 {
                let amplitude = 3.0 + random.normal();
                add(&mut layers, &mut random, amplitude, 0.1);
            }
            let found = flow_spread(&layers, WALLS).unwrap();
            let covers = |it: Estimate, value: f64| (it.value - value).abs() < it.half_width;
            lengths += usize::from(covers(found.diffusion_length, DIFFUSION_LENGTH));
            origins += usize::from(covers(found.origin, ORIGIN));
            let relative = found.diffusion_length.half_width / DIFFUSION_LENGTH;
            assert!(relative > 0.01 && relative < 0.3, "{found:?}");
        }
        // 40 intervals of 95 %: 38, with a standard deviation of 1.4.
        assert!(lengths >= 34 && origins >= 34, "{lengths}, {origins}");
    }

    #[test]
    fn a_profile_without_a_width_has_none() {
        let mut random = Random::new("flat flow");
        let mut layers = layers(10);
        let sides = [[-HALF_WIDTH, HALF_WIDTH], [-4.0, 4.0], [5.0, 45.0]];
        let [before, after] = falling(&mut random, 20_000, sides, |_, _| 1.0);
        assert_eq!(flow_width(&layers[0], WALLS), None);
        for layer in &mut layers {
            layer.add(&before, &after);
        }
        assert_eq!(flow_width(&layers[0], WALLS), None);
        layers[0].add(&before, &after);
        assert_eq!(flow_spread(&layers, WALLS), None);
    }
}
