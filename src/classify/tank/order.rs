//! Continuous measures of the state, which distinguish runs of one label.

use super::run::TankRun;
use crate::classify::measure::{measured, measures};

measures! {
    /// Continuous measures of the state, each a mean over time. Fields are empty where a measure
    /// is undefined.
    struct OrderParameters {
        /// Mean radius of the hole about the axis, over R.
        hole_radius: measured("hole radius / $R$", "").part(),
        /// Curvature of the paraboloid z = z0 + a rho^2 fitted to the mean surface profile, as the
        /// angular velocity sqrt(2 g a) (rad/s) of the fluid that has it (Rice, 2012, eq. 40);
        /// negative for a heap. Bins count that are occupied at least half of the time; empty if
        /// those are fewer than three.
        paraboloid_rotation: measured("paraboloid rotation", "rad/s").signed(),
        /// Root mean square residual of that fit, in (mean) radii of the spheres.
        paraboloid_residual: measured("paraboloid residual / $r$", ""),
        /// Rotation rate of the spheres over Omega, signed: 1 if they turn with the air. Empty
        /// without swirl.
        rotation: measured("rotation of the spheres / $Ω$", ""),
        /// Velocity fluctuation over sqrt(2 r g): small in a bed, of order 1 in a gas.
        mobility: measured("velocity fluctuation / √(2$rg$)", ""),
        /// Twice the mean height above the floor, over R. Empty without a floor.
        packing_height: measured("packing height / $R$", ""),
        /// Mean number of rising spheres, as the spout sieve counts them, over all spheres.
        spout_count: measured("rising spheres / $n$", "").part(),
    }
}

impl OrderParameters {
    /// Means over the settled part, or over the last quarter of a run that did not settle.
    pub(super) fn measure(run: &TankRun<'_>) -> Self {
        let start = run.start.unwrap_or(run.frames() * 3 / 4);
        let observations = run.observations;
        let mean_from_start = |values: &[f32]| mean(values.iter().skip(start).copied());
        let floor = run.scene.tank.as_ref().and_then(|tank| tank.floor);
        let omega = run
            .scene
            .dem
            .effects
            .swirl
            .as_ref()
            .map(|swirl| swirl.omega);
        let paraboloid = Paraboloid::fit(&mean_profile(run, start));
        // Rises are counted from the second frame of a run.
        let rising = run.rising.iter().skip(start.max(1)).copied();
        Self {
            hole_radius: mean_from_start(&observations.hole_radius)
                .map(|radius| radius / run.tank_radius),
            paraboloid_rotation: paraboloid.as_ref().map(|fit| fit.rotation(run.gravity)),
            paraboloid_residual: paraboloid.as_ref().map(|fit| fit.residual / run.radius),
            rotation: mean_from_start(&observations.rotation)
                .zip(omega.filter(|&omega| omega != 0.0))
                .map(|(rotation, omega)| rotation / omega),
            mobility: mean_from_start(&observations.fluctuation)
                .map(|fluctuation| fluctuation / (2.0 * run.radius * run.gravity).sqrt()),
            packing_height: mean_from_start(&observations.height_mean)
                .zip(floor)
                .map(|(height, floor)| 2.0 * (height - floor) / run.tank_radius),
            spout_count: mean(rising.map(f32::from)).map(|rising| rising / run.count as f64),
        }
    }
}

fn mean(values: impl Iterator<Item = f32>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_usize);
    for value in values {
        sum += f64::from(value);
        count += 1;
    }
    (count > 0).then(|| sum / count as f64)
}

/// Distance from the axis and mean height (m) of each bin that is occupied in at least half of
/// the frames from `start` on.
fn mean_profile(run: &TankRun<'_>, start: usize) -> Vec<(f64, f64)> {
    let profile = &run.observations.profile;
    let frames = profile.nrows().saturating_sub(start);
    let width = run.tank_radius / profile.ncols() as f64;
    let mut points = Vec::new();
    for (bin, tops) in profile.columns().into_iter().enumerate() {
        let tops = tops.into_iter().skip(start).copied();
        let occupied: Vec<f32> = tops.filter(|top| !top.is_nan()).collect();
        if 2 * occupied.len() >= frames {
            let centre = (bin as f64 + 0.5) * width;
            points.extend(mean(occupied.into_iter()).map(|height| (centre, height)));
        }
    }
    points
}

/// The surface z = z0 + a rho^2.
struct Paraboloid {
    /// a (1/m).
    curvature: f64,
    /// Root mean square residual (m).
    residual: f64,
}

impl Paraboloid {
    /// Least squares over points of distance from the axis and height (m). None with fewer than
    /// three points, which any paraboloid could meet.
    fn fit(points: &[(f64, f64)]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let count = points.len() as f64;
        let square_mean = points.iter().map(|(rho, _)| rho * rho).sum::<f64>() / count;
        let height_mean = points.iter().map(|(_, height)| height).sum::<f64>() / count;
        let centred = || {
            let centre =
                |(rho, height): &(f64, f64)| (rho * rho - square_mean, height - height_mean);
            points.iter().map(centre)
        };
        let variance: f64 = centred().map(|(square, _)| square * square).sum();
        let covariance: f64 = centred().map(|(square, height)| square * height).sum();
        let curvature = covariance / variance;
        let residuals = centred().map(|(square, height)| height - curvature * square);
        let squares: f64 = residuals.map(|residual| residual * residual).sum();
        Some(Self {
            curvature,
            residual: (squares / count).sqrt(),
        })
    }

    /// Angular velocity (rad/s) of the fluid with this surface; negative for a heap.
    fn rotation(&self, gravity: f64) -> f64 {
        let size = (2.0 * gravity * self.curvature.abs()).sqrt();
        size.copysign(self.curvature)
    }
}

#[cfg(test)]
mod tests {
    use crate::classify::tank::synthetic::{BINS, RADIUS, quiet};
    use crate::classify::{Label, Sieves, Verdict, classify};
    use crate::record::RunRecord;

    fn measure(record: &RunRecord) -> Verdict {
        classify(record, &Sieves::default()).unwrap()
    }

    fn close(measured: Option<f64>, expected: f64) -> bool {
        (measured.unwrap() - expected).abs() < 1e-5 * expected.abs().max(1.0)
    }

    /// A run whose mean surface is the paraboloid of a fluid turning at this rate (rad/s).
    fn paraboloid(rotation: f64) -> RunRecord {
        let mut record = quiet(1000);
        for ((frame, bin), top) in record.observations.profile.indexed_iter_mut() {
            let rho = 0.06 * (bin as f64 + 0.5) / BINS as f64;
            let height = rotation * rotation.abs() * rho * rho / (2.0 * 9.8);
            let ripple = if frame % 2 == 0 { 0.001 } else { -0.001 };
            *top = (height - 0.1 + ripple) as f32;
        }
        record
    }

    #[test]
    fn the_fitted_paraboloid_is_that_of_the_surface() {
        for rotation in [3.0, 12.0, -5.0] {
            let order = measure(&paraboloid(rotation));
            let fitted = order.value("paraboloid_rotation").unwrap();
            assert!((fitted - rotation).abs() < 1e-2, "{fitted}");
            assert!(order.value("paraboloid_residual").unwrap() < 1e-2);
        }
    }

    #[test]
    fn the_residual_is_in_radii() {
        // Bins one radius above and below their mean in turn: a flat fit leaves one radius, and
        // the best paraboloid hardly less.
        let mut record = quiet(1000);
        for ((_, bin), top) in record.observations.profile.indexed_iter_mut() {
            *top = if bin % 2 == 0 { 0.004 } else { -0.004 };
        }
        let residual = measure(&record).value("paraboloid_residual").unwrap();
        assert!((0.9..=1.0).contains(&residual), "{residual}");
    }

    #[test]
    fn bins_empty_most_of_the_time_are_left_out() {
        let mut record = paraboloid(10.0);
        let profile = &mut record.observations.profile;
        profile.column_mut(0).fill(f32::NAN);
        for (frame, top) in profile.column_mut(3).iter_mut().enumerate() {
            *top = if frame % 4 == 0 { 1.0 } else { f32::NAN };
        }
        assert!(close(measure(&record).value("paraboloid_rotation"), 10.0));

        for bin in [1, 2, 4] {
            record.observations.profile.column_mut(bin).fill(f32::NAN);
        }
        assert!(measure(&record).value("paraboloid_rotation").is_some());
        record.observations.profile.column_mut(5).fill(f32::NAN);
        assert_eq!(measure(&record).value("paraboloid_rotation"), None);
        assert_eq!(measure(&record).value("paraboloid_residual"), None);
    }

    #[test]
    fn scalars_are_scaled() {
        let mut record = quiet(1000)
            .with_hole(0.015, 0..1000)
            .with_rising(64, 0..1000);
        record.observations.rotation.fill(4.0);
        record.observations.fluctuation.fill(0.14);
        record.observations.height_mean.fill(-0.17);
        let order = measure(&record);
        assert!(close(order.value("hole_radius"), 0.25));
        assert!(close(order.value("rotation"), 0.8));
        assert!(close(
            order.value("mobility"),
            0.14 / (2.0 * RADIUS * 9.8).sqrt()
        ));
        assert!(close(order.value("packing_height"), 1.0));
        assert!(close(order.value("spout_count"), 0.25));

        record.scene.dem.effects.swirl.as_mut().unwrap().omega = 0.0;
        record.scene.tank.as_mut().unwrap().floor = None;
        let order = measure(&record);
        assert_eq!(order.value("rotation"), None);
        assert_eq!(order.value("packing_height"), None);
    }

    #[test]
    fn means_are_over_the_steady_part_or_else_the_last_quarter() {
        let mut record = quiet(1000);
        record.observations.hole_radius[..251].fill(0.06);
        assert_eq!(measure(&record).value("hole_radius"), Some(0.0));

        let mut record = quiet(1000);
        record.observations.height_max.fill(1.0);
        record.observations.hole_radius[750..].fill(0.06);
        let verdict = classify(&record, &Sieves::default()).unwrap();
        assert_eq!(verdict.label, Label::UNSETTLED);
        assert!(close(verdict.value("hole_radius"), 1.0));
    }

    #[test]
    fn nothing_is_measured_on_nothing() {
        assert_eq!(measure(&quiet(0)).values, [None; 17]);
        // The first frame is no frame of a rise.
        assert_eq!(measure(&quiet(1)).value("spout_count"), None);
    }
}
