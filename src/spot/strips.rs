//! Which thread makes which moves of a batch.
//!
//! The box is divided by height into strips, one for each thread. A thread makes the moves of its
//! strip in their order. Before a move that may touch the same spheres as an earlier one of a
//! neighbouring strip, it waits for that one. So every move finds the spheres as if all moves were
//! made one after the other.

use super::arrangement::Arrangement;
use super::parameters::{Parameters, Relaxation, Walk};
use super::slack::Slack;
use crate::particles::vector::Vector;
use std::ops::Range;

/// The strips next to one.
pub(super) const BELOW: usize = 0;
pub(super) const ABOVE: usize = 1;

/// Fewest moves that are divided.
const FEWEST: usize = 64;

/// Number of earlier moves that are checked for conflicts with a move. If none conflicts, the move
/// waits for the one before these: checking more would take longer.
const LOOKED_UP: usize = 32;

/// Divides moves among threads.
#[derive(Clone, Debug)]
pub(super) struct Planner {
    /// Distance of their centres below which two moves may touch the same sphere (m).
    conflict: f64,
    /// Distance from the edge of a strip within which a move may touch a sphere that another strip
    /// keeps, or a move there (m).
    reach: f64,
    /// Distance (m) from a strip, at the time of sorting, of spheres that its moves may touch or
    /// depend on.
    watched: f64,
    /// The same for all spheres that are read (m).
    seen: f64,
}

/// Moves in strips.
#[derive(Clone, Debug, Default)]
pub(super) struct StripPlan {
    pub(super) strips: Vec<Strip>,
    /// Layer of cells of each move.
    layers: Vec<u32>,
    /// Layers of cells at which strips other than the lowest begin.
    edges: Vec<usize>,
    /// Moves within reach of each edge, below and above it.
    near: Vec<[NearMoves; 2]>,
}

/// The moves of one strip and its spheres.
#[derive(Clone, Debug, Default)]
pub(super) struct Strip {
    pub(super) turns: Vec<Turn>,
    /// Number of moves that neighbours need to know of.
    shared: u32,
    /// Slots of the spheres whose final places this strip has.
    pub(super) own: Range<usize>,
    /// Slots of the spheres whose moves by other strips matter to it.
    pub(super) watched: Range<usize>,
    /// Slots of all spheres that its moves read.
    pub(super) seen: Range<usize>,
}

/// A move of a strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Number of the move in the batch.
    pub(super) number: u32,
    /// How many of the moves that the strips below and above share must have been made before.
    pub(super) after: [u32; 2],
    /// Whether the strips below and above need to know which spheres it moves.
    pub(super) shared: [bool; 2],
}

/// Centres of moves, and how many moves their strip has shared with each.
type NearMoves = Vec<(Vector, u32)>;

impl Planner {
    pub(super) fn new(parameters: &Parameters, slack: Slack) -> Self {
        let [x, y, z] = parameters.step;
        let step = (x * x + y * y + z * z).sqrt();
        let diameter = parameters.diameter;
        // How far from a centre spheres have influence, and how far moved spheres may get.
        let spot = parameters.spot_radius;
        let margin = 0.1 * diameter + parameters.greatest_displacement();
        let (mut read, mut moved) = (spot, spot + margin);
        let local = !matches!(
            parameters.relaxation,
            Relaxation::Off | Relaxation::Global { .. }
        );
        if local {
            read = read.max(parameters.relaxation_radius + diameter);
            // A longer displacement by relaxation is an error.
            moved = moved.max(parameters.relaxation_radius + 0.5 * diameter);
        }
        // A biased step is not known yet: it depends on the spheres around the spot.
        if let Walk::Biased { .. } = parameters.walk {
            read = read.max(spot + 0.5 * step) + 0.5 * step;
            moved += 0.5 * step;
        }
        let conflict = moved + read;
        // Spheres have moved since they were sorted.
        let strayed = slack.most() + 0.5 * diameter;
        let watched = read.max(moved) + strayed;
        Self {
            conflict,
            reach: conflict.max(moved + strayed),
            watched,
            seen: watched + 2.0 * (slack.most() + diameter),
        }
    }

    /// Divides moves into at most this number of strips. `centre` gives their centres, as far as
    /// they are known (m); `costs` are the times of a move in each of the last strips, in any unit.
    pub(super) fn divide(
        &self,
        plan: &mut StripPlan,
        arrangement: &Arrangement,
        (moves, centre): (usize, impl Fn(usize) -> Vector),
        (most, costs): (usize, &[f64]),
    ) {
        let (layers, height) = arrangement.cells.layers();
        let layer_of = |number: usize| {
            let layer = (centre(number).z / height).max(0.0) as usize;
            layer.min(layers - 1)
        };
        plan.layers.clear();
        plan.layers.extend((0..moves).map(|it| layer_of(it) as u32));
        let mut work = vec![0.0; layers];
        let strips = strips_of_layers(&plan.edges, layers);
        for &layer in &plan.layers {
            let strip = strips[layer as usize];
            work[layer as usize] += costs.get(strip).unwrap_or(&1.0);
        }
        let thinnest = (2.0 * self.reach / height) as usize + 1;
        plan.edges = match moves < FEWEST {
            true => Vec::new(),
            false => edges(&work, most, thinnest),
        };
        self.begin(plan, arrangement);
        let strips = strips_of_layers(&plan.edges, layers);
        for number in 0..moves {
            let strip = strips[plan.layers[number] as usize];
            self.add(plan, (number, &centre), (strip, height));
        }
    }

    /// Adds a move to a strip. Layers have this height (m).
    fn add(
        &self,
        plan: &mut StripPlan,
        (number, centre): (usize, impl Fn(usize) -> Vector),
        (own, height): (usize, f64),
    ) {
        let z = centre(number).z;
        let strip = &mut plan.strips[own];
        let mut turn = Turn {
            number: number as u32,
            after: [0; 2],
            shared: [false; 2],
        };
        for (side, edge) in [(BELOW, own.wrapping_sub(1)), (ABOVE, own)] {
            let Some(layer) = plan.edges.get(edge) else {
                continue;
            };
            let distance = (z - *layer as f64 * height).abs();
            if distance < self.reach {
                // Seen from the edge, this strip is on the other side.
                let centre = centre(number);
                turn.after[side] = self.latest(&plan.near[edge][side], centre);
                turn.shared[side] = true;
                plan.near[edge][1 - side].push((centre, strip.shared + 1));
            }
        }
        strip.shared += u32::from(turn.shared.contains(&true));
        strip.turns.push(turn);
    }

    /// Creates empty strips between the edges of a plan.
    fn begin(&self, plan: &mut StripPlan, arrangement: &Arrangement) {
        let (layers, height) = arrangement.cells.layers();
        let halo = |distance: f64| (distance / height) as usize + 1;
        let (watched, seen) = (halo(self.watched), halo(self.seen));
        let slots = |from: usize, to: usize| {
            let cells = &arrangement.cells;
            cells.first_of_layer(from)..cells.first_of_layer(to)
        };
        let count = plan.edges.len() + 1;
        plan.strips.resize_with(count, Strip::default);
        plan.near.resize_with(count - 1, <[NearMoves; 2]>::default);
        plan.near.iter_mut().flatten().for_each(Vec::clear);
        let starts = std::iter::once(0).chain(plan.edges.iter().copied());
        let ends = plan.edges.iter().copied().chain([layers]);
        for (strip, (from, to)) in plan.strips.iter_mut().zip(starts.zip(ends)) {
            strip.turns.clear();
            strip.shared = 0;
            strip.own = slots(from, to);
            strip.watched = slots(from.saturating_sub(watched), to + watched);
            strip.seen = slots(from.saturating_sub(seen), to + seen);
        }
    }

    /// How many moves the other strip must have shared before a move with this centre.
    fn latest(&self, others: &NearMoves, centre: Vector) -> u32 {
        let mut others = others.iter().rev();
        let conflicting = |(other, _): &&(Vector, u32)| self.conflict(*other, centre);
        let found = others.by_ref().take(LOOKED_UP).find(conflicting);
        found.or_else(|| others.next()).map_or(0, |it| it.1)
    }

    /// Whether moves with these centres may touch the same sphere.
    pub(super) fn conflict(&self, one: Vector, other: Vector) -> bool {
        (one - other).norm_squared() < self.conflict * self.conflict
    }
}

/// The layers where strips other than the lowest begin, so that each has about the same amount of
/// work, and those in the middle are not too thin.
fn edges(work: &[f64], most: usize, thinnest: usize) -> Vec<usize> {
    let total: f64 = work.iter().sum();
    let mut edges: Vec<usize> = Vec::new();
    let mut sum = 0.0;
    for (layer, here) in work.iter().enumerate() {
        let wanted = (edges.len() + 1) as f64 * total / most as f64;
        let thick = edges.last().is_none_or(|last| layer - last >= thinnest);
        // The edge below this layer is nearer to the wanted place than the one above.
        if edges.len() + 1 < most && thick && sum + 0.5 * here > wanted && sum > 0.0 {
            edges.push(layer);
        }
        sum += here;
    }
    edges
}

/// The strip to which each layer belongs.
fn strips_of_layers(edges: &[usize], layers: usize) -> Vec<usize> {
    let strip = |layer: usize| edges.iter().filter(|edge| **edge <= layer).count();
    (0..layers).map(strip).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spot::random::RandomStream;
    use crate::spot::samples;

    #[test]
    fn moves_wait_for_earlier_ones_beyond_the_edge() {
        let simulation = samples::simulation(|_| {});
        let planner = Planner::new(&simulation.model.parameters, simulation.model.slack);
        let mut random = RandomStream::new("strips", 1);
        let mut place = || {
            let x = 14.0 * random.uniform() - 7.0;
            Vector::new(x, 0.0, 16.0 * random.uniform())
        };
        let centres: Vec<Vector> = (0..400).map(|_| place()).collect();
        let mut plan = StripPlan::default();
        let moves = (centres.len(), |number| centres[number]);
        planner.divide(&mut plan, &simulation.arrangement, moves, (2, &[]));
        let [below, above] = &plan.strips[..] else {
            panic!("{} strips", plan.strips.len());
        };
        assert!(below.turns.len().abs_diff(above.turns.len()) < 50);
        assert_eq!(below.own.end, above.own.start);
        let mut waits = 0;
        for (own, other, side) in [(below, above, ABOVE), (above, below, BELOW)] {
            for turn in &own.turns {
                let centre = |turn: &Turn| centres[turn.number as usize];
                let shared = other.turns.iter().filter(|it| it.shared[1 - side]);
                let (made, left) = {
                    let made = shared.clone().take(turn.after[side] as usize);
                    (made, shared.skip(turn.after[side] as usize))
                };
                assert!(made.clone().all(|it| it.number < turn.number));
                waits += made.count();
                let mut left = left.filter(|it| it.number < turn.number);
                assert!(!left.any(|it| planner.conflict(centre(it), centre(turn))));
                let alone = other.turns.iter().filter(|it| !it.shared[1 - side]);
                assert!(
                    !alone
                        .into_iter()
                        .any(|it| planner.conflict(centre(it), centre(turn)))
                );
            }
        }
        assert!(waits > 0);
    }

    #[test]
    fn strips_have_about_the_same_work() {
        let work = [1.0, 3.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0];
        assert_eq!(edges(&work, 2, 1), [3]);
        assert_eq!(edges(&work, 3, 1), [2, 4]);
        assert_eq!(edges(&work, 3, 4), [2, 6]);
        assert_eq!(edges(&[5.0, 0.0], 2, 1), [1]);
        assert_eq!(edges(&[0.0, 5.0], 2, 1), Vec::<usize>::new());
    }
}
