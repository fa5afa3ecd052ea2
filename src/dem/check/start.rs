//! Whether the spheres have room where they start.

use crate::dem::overlap::{self, Overlap, OverlapPartner};
use crate::document::{Problem, accepted, at_least, number};
use crate::scene::{Scene, Start, may_hold, plural, rounded};
use crate::start;

/// Largest share of the space open to the spheres that a random start may fill. Random placement
/// one by one without overlap cannot exceed 0.384 (Zhang and Torquato, Phys. Rev. E 88, 053312
/// (2013)) and needs ever more attempts on the way there.
const PACKING_LIMIT: f64 = 0.30;

/// Share up to which a random start is taken to succeed without a trial.
const CERTAIN_PACKING: f64 = 0.10;

/// A packing lies below this many times its usual height. Between walls a diameter or two apart,
/// spheres fill a third of the usual volume.
const HIGHEST_PACKING: f64 = 3.0;

/// Largest number of spheres that are placed on trial. In larger scenes spheres are small against
/// their tank.
const MOST_TRIED: usize = 10_000;

impl Scene {
    /// Checks that a random start has enough room. Other starts bring their own positions.
    pub(super) fn check_room(&self, problems: &mut Vec<Problem>) {
        let Start::Random { z_min, z_max, .. } = self.start else {
            return;
        };
        let area = self.start_area();
        if let Some(area) = area.filter(|_| z_min <= z_max && self.misfit().is_none()) {
            self.check_room_between(area, z_min, z_max, problems);
        }
    }

    /// Whether the spheres fit between `z_min` and `z_max` within walls that enclose `area` (m2).
    fn check_room_between(&self, area: f64, z_min: f64, z_max: f64, problems: &mut Vec<Problem>) {
        let radii = &self.spheres.radius;
        let volume = self.spheres.count as f64 * radii.mean_volume();
        let is_in_the_way = self.dem.geometry.is_some() || !self.dem.walls.is_empty();
        if is_in_the_way && self.trial_fails(z_max) {
            let message = match self.dem.geometry {
                Some(_) => "the spheres find no room between those that are fixed",
                None => "the spheres find no room between the walls",
            };
            let help = "let `start.z_min` to `start.z_max` reach farther, or use fewer spheres";
            problems.push(Problem::new("start.z_max", message).help(help));
            return;
        }
        let height_for = |fraction: f64| volume / (fraction * area);
        // A box that is periodic along z has no more room than its period.
        let period = self.domain().periods()[2].unwrap_or(f64::INFINITY);
        let height_up_to = |z_max: f64| (z_max - z_min + 2.0 * radii.mean()).min(period);
        let fraction_up_to = |z_max: f64| height_for(1.0) / height_up_to(z_max);
        // Spheres that are not small against the tank find less room: only a trial can tell.
        let finds_room = |z_max: f64| match fraction_up_to(z_max) {
            fraction if fraction > PACKING_LIMIT => false,
            fraction if fraction > CERTAIN_PACKING => !self.trial_fails(z_max),
            _ => true,
        };
        if finds_room(z_max) {
            return;
        }
        let fraction = fraction_up_to(z_max);
        let message = format!(
            "{} do not fit: they would fill {:.0} % of the space between `start.z_min` and \
             `start.z_max`, and a random start without overlap fills {:.0} % at most",
            plural(self.spheres.count, "sphere", "spheres"),
            100.0 * fraction,
            100.0 * PACKING_LIMIT,
        );
        let message = if fraction <= PACKING_LIMIT {
            format!("{message} (less where spheres are large against the tank)")
        } else {
            message
        };
        let few = "fewer or smaller spheres";
        let room = [PACKING_LIMIT, CERTAIN_PACKING]
            .into_iter()
            .find_map(|limit| {
                let z_max = z_min + 1.01 * (height_for(limit) - 2.0 * radii.mean());
                let z_max = accepted(z_max, |it| {
                    fraction_up_to(it) <= limit && may_hold("start.z_max", it)
                })?;
                let is_enough = z_max.parse().is_ok_and(finds_room);
                is_enough.then_some(z_max)
            });
        let help = match room {
            Some(z_max) => format!("use `z_max = {z_max}` or more, or {few}"),
            None if period.is_finite() => format!("use a longer `periodic.z`, or {few}"),
            None => format!("use a higher `z_max`, or {few}"),
        };
        problems.push(Problem::new("start.z_max", message).help(help));
    }

    /// Refuses fixed spheres where a packing may lie.
    pub(super) fn check_packing_beside_fixed(&self, problems: &mut Vec<Problem>) {
        let (Start::Packing {}, Some(geometry)) = (&self.start, &self.dem.geometry) else {
            return;
        };
        let tank = self.tank.clone().unwrap_or_default();
        let floor = tank.floor.unwrap_or(0.0);
        let top = floor + HIGHEST_PACKING * self.packed_height() + 2.0 * self.radius_range().1;
        let fixed = geometry.spheres();
        let in_the_way = fixed.walls.iter().chain(&fixed.door).find(|sphere| {
            let [x, y, z] = sphere.position;
            let within = |place: f64, reach: Option<f64>| {
                reach.is_none_or(|reach| place.abs() - sphere.radius < reach)
            };
            let [wide, deep] = tank.reach();
            let low = z - sphere.radius < top && z + sphere.radius > floor;
            within(x, wide) && within(y, deep) && low
        });
        if let Some(sphere) = in_the_way {
            let [x, y, z] = sphere.position.map(rounded);
            let message = format!(
                "a fixed sphere stands at ({x}, {y}, {z}) m, where the packing may lie: it fills \
                 the box up to at most {} m",
                rounded(top)
            );
            let help = "move it out of the box, or list the spheres with `kind = \"list\"`";
            problems.push(Problem::new("geometry", message).help(help));
        }
    }

    /// Refuses listed spheres that overlap so much that the run would end at once, or that have
    /// their centre inside a fixed sphere. The deepest overlap is named.
    ///
    /// Other overlaps are allowed: soft contacts in a start that continues an earlier run may be as
    /// deep as a radius. [`Release`](crate::dem::Release) finds overlaps that no motion in this
    /// scene explains, and commands warn of them.
    pub(super) fn check_overlaps(&self, problems: &mut Vec<Problem>) {
        let limit = self.dem.guards.overlap;
        let mut deepest: Option<Overlap> = None;
        overlap::visit(self, |overlap| {
            let is_inside = matches!(overlap.partner, OverlapPartner::Fixed(_))
                && overlap.depth > overlap.radius;
            let before = deepest.map_or(0.0, |it| it.depth_in_radii);
            if (is_inside || overlap.depth_in_radii > limit) && overlap.depth_in_radii > before {
                deepest = Some(overlap);
            }
        });
        let Some(overlap) = deepest else { return };
        let Overlap {
            sphere,
            partner,
            depth,
            depth_in_radii,
            distance,
            ..
        } = overlap;
        let message = match depth_in_radii > limit {
            true => format!(
                "sphere {sphere} starts {} m deep in {partner}, more than the {} radii at which \
                 `guards.overlap` ends the run",
                rounded(depth),
                number(limit)
            ),
            false => format!("sphere {sphere} starts with its centre inside {partner}"),
        };
        let allowed = limit.min(1.0) * depth / depth_in_radii;
        // A little more, so that rounding does not matter.
        let apart = at_least((distance + depth - allowed) * (1.0 + 1e-9));
        let other = match partner {
            OverlapPartner::Wall(_) => partner.to_string(),
            OverlapPartner::Sphere(_) | OverlapPartner::Fixed(_) => "the other centre".to_owned(),
        };
        let help = format!("move its centre to {apart} m or farther from {other}");
        let path = format!("start.spheres[{sphere}].position");
        problems.push(Problem::new(path, message).help(help));
    }

    /// Whether a quick trial fails to place the spheres below this height (m). False if there are
    /// too many for a trial.
    fn trial_fails(&self, highest: f64) -> bool {
        if self.spheres.count > MOST_TRIED {
            return false;
        }
        let mut scene = self.clone();
        if let Start::Random { z_max, .. } = &mut scene.start {
            *z_max = highest;
        }
        start::place(&scene).is_err()
    }
}
