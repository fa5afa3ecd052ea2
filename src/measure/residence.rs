//! When spheres leave, and how long they stay.

use super::Region;
use super::bins::Bins;
use crate::particles::vector::Vector;
use crate::simulation::Snapshot;
use ndarray::Array2;

/// Residence times of the spheres in a first snapshot; snapshots are added in the order of time.
#[derive(Clone, Debug)]
pub struct Residence {
    /// Times of all snapshots (s).
    times: Vec<f64>,
    /// Centres in the first snapshot (m), n x 3.
    start: Array2<f64>,
    /// The first snapshot in which each sphere is missing.
    missing: Vec<Option<usize>>,
}

/// Residence times of spheres that start in one part of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidenceTimes {
    /// Distance of the part from the middle, | x | (m).
    pub distance: f64,
    /// Its height (m).
    pub height: f64,
    /// Number of spheres that start there.
    pub spheres: usize,
    /// Number of them that left.
    pub left: usize,
    /// Mean time (s); `None` while a sphere is left.
    pub mean: Option<f64>,
    /// Times (s) by which a quarter, half and three quarters of the spheres left; `None` if they
    /// have not.
    pub quartiles: [Option<f64>; 3],
}

impl Residence {
    /// Spheres at their start; spheres that come later do not count.
    pub fn new(start: &Snapshot) -> Self {
        Self {
            times: vec![start.time],
            start: start.position.clone(),
            missing: vec![None; start.position.nrows()],
        }
    }

    /// Adds a later snapshot.
    pub fn add(&mut self, snapshot: &Snapshot) {
        let starts = self.start.rows().into_iter().zip(&mut self.missing);
        for ((start, missing), now) in starts.zip(snapshot.position.rows()) {
            if missing.is_none() && now[0].is_nan() && !start[0].is_nan() {
                *missing = Some(self.times.len());
            }
        }
        self.times.push(snapshot.time);
    }

    /// Time (s) from the first snapshot until each sphere left: the middle between the last
    /// snapshot that contains it and the next. `None` if it has not left, or was never there.
    pub fn times(&self) -> Vec<Option<f64>> {
        let missing = self.missing.iter();
        missing.map(|it| it.map(|it| self.residence(it))).collect()
    }

    /// Time (s) until spheres left that are missing in this snapshot, but not in the one before.
    fn residence(&self, missing: usize) -> f64 {
        0.5 * (self.times[missing - 1] + self.times[missing]) - self.times[0]
    }

    /// Spheres that left per time (1/s) between each two snapshots, at the middle of their times
    /// (s).
    pub fn rates(&self) -> Vec<[f64; 2]> {
        let mut counts = vec![0.0; self.times.len()];
        for missing in self.missing.iter().flatten() {
            counts[*missing] += 1.0;
        }
        let pairs = self.times.windows(2).zip(&counts[1..]);
        pairs
            .map(|(time, count)| [0.5 * (time[0] + time[1]), count / (time[1] - time[0])])
            .collect()
    }

    /// Residence times by where spheres start: in bins of the distance | x | up to `half_width`,
    /// and of the height between two (m). Bins without spheres are left out.
    ///
    /// * `bins`: number of bins of the distance and of the height, one or more
    pub fn by_start(
        &self,
        half_width: f64,
        heights: [f64; 2],
        bins: [usize; 2],
    ) -> Vec<ResidenceTimes> {
        let bins = Bins {
            region: Region {
                low: [0.0, 0.0, heights[0]],
                high: [half_width, 1.0, heights[1]],
            },
            counts: [bins[0], 1, bins[1]],
        };
        let mut times = vec![Vec::new(); bins.len()];
        for (start, time) in self.start.rows().into_iter().zip(self.times()) {
            // The depth does not count.
            let place = Vector::new(start[0].abs(), 0.0, start[2]);
            if let Some(bin) = bins.index(place) {
                times[bin].push(time.unwrap_or(f64::INFINITY));
            }
        }
        let of_bin = |(bin, times): (usize, Vec<f64>)| {
            let distance = bins.middle(0, bin / bins.counts[2]);
            let height = bins.middle(2, bin % bins.counts[2]);
            (!times.is_empty()).then(|| ResidenceTimes::of(distance, height, times))
        };
        times.into_iter().enumerate().filter_map(of_bin).collect()
    }
}

impl ResidenceTimes {
    /// From one or more times (s), infinite for spheres that have not left.
    fn of(distance: f64, height: f64, mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        let spheres = times.len();
        let finite = |it: &f64| it.is_finite();
        // The time by which at least this many quarters have left.
        let quartile = |quarters: usize| times[(quarters * spheres).div_ceil(4) - 1];
        let mean = times.iter().sum::<f64>() / spheres as f64;
        Self {
            distance,
            height,
            spheres,
            left: times.iter().filter(|it| finite(it)).count(),
            mean: Some(mean).filter(finite),
            quartiles: [1, 2, 3].map(|it| Some(quartile(it)).filter(finite)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::snapshot;

    /// Columns of eight spheres at x = -1.5, 1.5 and 4.5. In the left two the lowest leaves first,
    /// one per second; in the right one none leaves.
    fn drain(seconds: usize) -> Residence {
        let at = |second: usize| {
            let places = (0..24).map(|sphere| {
                let [column, row] = [sphere / 8, sphere % 8];
                let x = [-1.5, 1.5, 4.5][column];
                let is_gone = column < 2 && row < second;
                [if is_gone { f64::NAN } else { x }, 0.0, row as f64 + 0.5]
            });
            snapshot(10.0 + second as f64, &places.collect::<Vec<_>>())
        };
        let mut residence = Residence::new(&at(0));
        for second in 1..=seconds {
            residence.add(&at(second));
        }
        residence
    }

    #[test]
    fn times_of_leaving_are_between_snapshots() {
        let residence = drain(8);
        let times = residence.times();
        for (sphere, time) in times.iter().enumerate() {
            let expected = (sphere < 16).then_some((sphere % 8) as f64 + 0.5);
            assert_eq!(*time, expected);
        }
        let rates = residence.rates();
        assert_eq!(rates.len(), 8);
        for (interval, rate) in rates.into_iter().enumerate() {
            assert_eq!(rate, [interval as f64 + 10.5, 2.0]);
        }
    }

    #[test]
    fn residence_times_follow_the_start() {
        let bins = drain(8).by_start(6.0, [0.0, 8.0], [2, 2]);
        let expected = |distance, height, mean, quartiles| ResidenceTimes {
            distance,
            height,
            spheres: 8,
            left: 8,
            mean: Some(mean),
            quartiles,
        };
        assert_eq!(bins[0], expected(1.5, 2.0, 2.0, [0.5, 1.5, 2.5].map(Some)));
        assert_eq!(bins[1], expected(1.5, 6.0, 6.0, [4.5, 5.5, 6.5].map(Some)));
        for (bin, height) in bins[2..].iter().zip([2.0, 6.0]) {
            let stays = ResidenceTimes {
                distance: 4.5,
                height,
                spheres: 4,
                left: 0,
                mean: None,
                quartiles: [None; 3],
            };
            assert_eq!(*bin, stays);
        }
    }

    #[test]
    fn what_has_not_left_yet_counts_as_later() {
        // Two of four have left on either side.
        let bins = drain(2).by_start(3.0, [0.0, 4.0], [1, 1]);
        assert_eq!((bins[0].spheres, bins[0].left, bins[0].mean), (8, 4, None));
        assert_eq!(bins[0].quartiles, [Some(0.5), Some(1.5), None]);
    }
}
