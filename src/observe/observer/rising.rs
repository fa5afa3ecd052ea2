//! Counts spheres that rise faster than the mean.

use super::{Observer, find_distances};
use crate::simulation::FrameView;
use serde::{Deserialize, Serialize};

/// Data of the previous frame for the count of rising spheres.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Previous {
    height: Vec<f64>,
    distance: Vec<f64>,
    height_mean: f64,
}

/// Counts the spheres that rise, block by block.
pub(super) struct Rising<'a> {
    rises: &'a [f64],
    distances: &'a [f64],
    /// One row per distance, one column per rise.
    counts: &'a mut [u16],
    distance: &'a mut Vec<f64>,
    previous: &'a mut Previous,
    is_first_frame: bool,
    /// Mean rise of all spheres (m).
    mean: f64,
    /// Spheres so far.
    seen: usize,
}

impl<'a> Rising<'a> {
    /// For a frame of `count` spheres with this mean height (m); `None` if nothing is counted.
    pub(super) fn new(observer: &'a mut Observer, count: usize, height_mean: f64) -> Option<Self> {
        let cells = observer.rises.len() * observer.distances.len();
        if cells == 0 {
            return None;
        }
        let start = observer.rising.len();
        observer.rising.resize(start + cells, 0);
        let is_first_frame = observer.previous.is_none();
        let previous = observer.previous.get_or_insert_with(|| Previous {
            height: Vec::with_capacity(count),
            distance: Vec::with_capacity(count),
            height_mean,
        });
        let before = std::mem::replace(&mut previous.height_mean, height_mean);
        Some(Self {
            rises: &observer.rises,
            distances: &observer.distances,
            counts: &mut observer.rising[start..],
            distance: &mut observer.distance,
            previous,
            is_first_frame,
            mean: height_mean - before,
            seen: 0,
        })
    }

    pub(super) fn count(&mut self, block: &FrameView<'_>) {
        find_distances(block, self.distance);
        let z = block.position[2];
        let Previous {
            height, distance, ..
        } = &mut *self.previous;
        if self.is_first_frame {
            height.extend_from_slice(z);
            distance.extend_from_slice(self.distance);
            return;
        }
        let here = self.seen..self.seen + z.len();
        self.seen = here.end;
        let (height, distance) = (&mut height[here.clone()], &mut distance[here]);
        let least = self.rises.iter().copied().fold(f64::INFINITY, f64::min);
        for (i, &radius) in block.radius.iter().enumerate() {
            let rise = (z[i] - height[i] - self.mean) / radius;
            // Most spheres do not rise.
            if rise < least {
                continue;
            }
            let rows = self.counts.chunks_exact_mut(self.rises.len());
            for (row, &within) in rows.zip(self.distances) {
                if distance[i] <= within {
                    for (count, &threshold) in row.iter_mut().zip(self.rises) {
                        *count = count.saturating_add(u16::from(rise >= threshold));
                    }
                }
            }
        }
        height.copy_from_slice(z);
        distance.copy_from_slice(self.distance);
    }
}
