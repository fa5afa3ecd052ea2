//! Which moves of a step can be made at the same time.
//!
//! Moves are divided into waves. Two moves of one wave are so far apart that neither moves a sphere
//! that the other one looks at. Where they are nearer, the one that comes first in the order of the
//! step is in an earlier wave. The waves one after the other thus give what the moves one after the
//! other would, whatever the order of the moves within a wave, and whoever makes them.

use super::parameters::{Parameters, Walk};
use crate::particles::vector::Vector;
use std::ops::Range;

/// Edge of the tiles that moves mark, in diameters.
const TILE: f64 = 0.5;

/// Divides moves into waves.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    /// Half of the distance below which two moves may touch the same sphere (m).
    radius: f64,
    tile: f64,
    half_width: f64,
    /// Tiles along x.
    columns: usize,
    /// The last wave that touches each tile; 0 if there is none.
    last: Vec<u32>,
    /// Ranges of tiles of one move.
    rows: Vec<Range<usize>>,
}

/// The moves of a step in waves: numbers of moves, and where the waves end.
#[derive(Clone, Debug, Default)]
pub(super) struct Waves {
    pub(super) moves: Vec<u32>,
    ends: Vec<u32>,
}

impl Waves {
    /// Number of waves.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// Numbers of the moves of a wave.
    pub(super) fn wave(&self, index: usize) -> &[u32] {
        let first = index.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.moves[first as usize..self.ends[index] as usize]
    }
}

impl Planner {
    pub(super) fn new(parameters: &Parameters) -> Self {
        let [x, y, z] = parameters.step;
        let step = (x * x + y * y + z * z).sqrt();
        let diameter = parameters.diameter;
        // Spheres nearer than this to the middle of the way are moved, each by less than half a
        // diameter.
        let moved = parameters.spot_radius.max(parameters.relaxation_radius) + 0.5 * diameter;
        // A biased way is not known yet: a spot looks at the places around it.
        let (ahead, uncertain) = match parameters.walk {
            Walk::Unbiased => (0.0, 0.0),
            Walk::Biased { .. } => (step, step),
        };
        let read = (parameters.spot_radius + ahead).max(parameters.relaxation_radius + diameter);
        let radius = 0.5 * (moved + read + uncertain);
        let tile = TILE * diameter;
        let columns = (2.0 * parameters.half_width / tile) as usize + 1;
        Self {
            radius,
            tile,
            half_width: parameters.half_width,
            columns,
            last: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Divides the moves with these centres, as far as they are known, in the order of the step.
    pub(super) fn plan(&mut self, places: &[Vector]) -> Waves {
        let highest = places.iter().fold(0.0, |most: f64, it| most.max(it.z));
        let layers = ((highest + self.radius) / self.tile) as usize + 1;
        self.last.clear();
        self.last.resize(layers * self.columns, 0);
        let wave: Vec<u32> = places.iter().map(|&place| self.wave_of(place)).collect();
        let waves = wave.iter().copied().max().unwrap_or(0) as usize;
        let mut ends = vec![0; waves];
        for &wave in &wave {
            ends[wave as usize - 1] += 1;
        }
        let mut next = Vec::with_capacity(waves);
        let mut total = 0;
        for end in &mut ends {
            next.push(total);
            total += *end;
            *end = total;
        }
        let mut moves = vec![0; places.len()];
        for (index, &wave) in (0..).zip(&wave) {
            let place = &mut next[wave as usize - 1];
            moves[*place as usize] = index;
            *place += 1;
        }
        Waves { moves, ends }
    }

    /// The wave of the next move, counted from 1; marks its tiles.
    fn wave_of(&mut self, place: Vector) -> u32 {
        let tile = self.tile;
        let index = |value: f64, most: usize| ((value / tile).max(0.0) as usize).min(most);
        let layers = self.last.len() / self.columns;
        let low = index(place.z - self.radius, layers - 1);
        let high = index(place.z + self.radius, layers - 1);
        let mut wave = 0;
        let mut rows = std::mem::take(&mut self.rows);
        rows.clear();
        for layer in low..=high {
            let from = layer as f64 * tile;
            let distance = (from - place.z).max(place.z - from - tile).max(0.0);
            let half = (self.radius * self.radius - distance * distance)
                .max(0.0)
                .sqrt();
            let first = index(place.x - half + self.half_width, self.columns - 1);
            let last = index(place.x + half + self.half_width, self.columns - 1);
            let row = layer * self.columns + first..layer * self.columns + last + 1;
            let marked = &self.last[row.clone()];
            wave = marked.iter().fold(wave, |most, &it| it.max(most));
            rows.push(row);
        }
        for row in &rows {
            self.last[row.clone()].fill(wave + 1);
        }
        self.rows = rows;
        wave + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::random::Stream;

    #[test]
    fn near_moves_keep_their_order_and_share_no_wave() {
        let mut random = Stream::new("waves", 1);
        let parameters = Parameters::figure_2(1.0);
        let mut place = || {
            let x = 40.0 * random.uniform() - 20.0;
            Vector::new(x, 0.0, 90.0 * random.uniform())
        };
        let places: Vec<Vector> = (0..600).map(|_| place()).collect();
        let mut planner = Planner::new(&parameters);
        let waves = planner.plan(&places);
        let mut wave_of = vec![usize::MAX; places.len()];
        for wave in 0..waves.len() {
            for &index in waves.wave(wave) {
                wave_of[index as usize] = wave;
            }
        }
        for (second, place) in places.iter().enumerate() {
            for first in 0..second {
                if (*place - places[first]).norm() < 2.0 * planner.radius {
                    assert!(wave_of[first] < wave_of[second], "{first} before {second}");
                }
            }
        }
        assert!(waves.len() < 200, "{} waves", waves.len());
    }
}
