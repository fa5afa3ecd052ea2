//! Limits of the Hertz contact of Silbert et al.

use super::overlap::deepest_at_start;
use super::{Impact, Limit, scheme_of};
use crate::scene::{Contact, Friction, Scene};

/// An elastic impact, and the effective radius (m) of its partners.
struct Meeting {
    impact: Impact,
    effective_radius: f64,
}

impl Meeting {
    /// sqrt(R_eff xi) (m) where the partners overlap most.
    fn root(&self) -> f64 {
        (self.effective_radius * self.impact.deepest_overlap()).sqrt()
    }
}

/// The impacts that may set a limit, the stiffest one first: at the fastest speed, or from the
/// deepest overlap at the start. Two of the smallest spheres are the stiffest, w^2 = (3/2) k_n
/// sqrt(R_eff xi) / m_eff; the damping rate gamma_n sqrt(R_eff xi) grows with the radius and is
/// largest for the largest sphere at a wall. In between the limit has no minimum: the sum of rate
/// and frequency is convex in the radius.
fn meetings(scene: &Scene) -> Vec<Meeting> {
    let Some(Contact::Silbert { stiffness, .. }) = scene.dem.contact else {
        return Vec::new();
    };
    let (speed, overlap) = (super::fastest_impact(scene), deepest_at_start(scene));
    let meeting = |effective_radius: f64, effective_mass: f64| {
        let impact = Impact {
            effective_mass,
            stiffness: stiffness * effective_radius.sqrt(),
            speed,
        };
        let release = impact.from_overlap(overlap);
        let impact = if release.speed > speed {
            release
        } else {
            impact
        };
        Meeting {
            impact,
            effective_radius,
        }
    };
    let (small, large) = scene.radius_range();
    let sizes = [
        (small, scene.smallest_mass()),
        (large, scene.largest_mass()),
    ];
    let pairs = sizes.map(|(radius, mass)| meeting(0.5 * radius, 0.5 * mass));
    let walls = sizes.map(|(radius, mass)| meeting(radius, mass));
    // A small sphere meets a much larger one like a wall.
    let has_walls = scene.tank.is_some() || scene.dem.geometry.is_some() || small < large;
    let walls = walls.into_iter().filter(|_| has_walls);
    let all = pairs.into_iter().chain(walls);
    all.filter(|meeting| meeting.impact.speed > 0.0).collect()
}

/// The impact of the two smallest spheres at the fastest speed, or from the deepest overlap at the
/// start.
pub(super) fn stiffest_impact(scene: &Scene) -> Option<Impact> {
    let stiffest = meetings(scene).into_iter().next();
    stiffest.map(|meeting| meeting.impact)
}

/// Limits of the contact and of the friction at it; none without such a contact.
pub(super) fn limits(scene: &Scene) -> Vec<Limit> {
    let meetings = meetings(scene);
    let (Some(Contact::Silbert { damping, .. }), Some(stiffest)) =
        (&scene.dem.contact, meetings.first())
    else {
        return Vec::new();
    };
    let scheme = scheme_of(scene);
    let least = |seconds: &dyn Fn(&Meeting) -> f64| {
        let seconds = meetings.iter().map(seconds);
        seconds.fold(f64::INFINITY, f64::min)
    };
    let of_twelve = |it: &Meeting| {
        super::twelve_contacts(scheme, it.impact.angular_frequency(), damping * it.root())
    };
    let mut limits = vec![
        Limit {
            name: "contact",
            seconds: 2.0 / stiffest.impact.angular_frequency(),
            decisive: true,
            explanation: "2/w of the two smallest spheres at their deepest overlap, at the start or in \
                          the fastest impact, w^2 = (3/2) k_n sqrt(R_eff xi) / m_eff",
        },
        Limit {
            seconds: least(&|it| of_twelve(it).seconds),
            ..of_twelve(stiffest)
        },
        super::displacement(scene, stiffest.impact.speed),
    ];
    if *damping > 0.0 {
        limits.push(Limit {
            name: "damped contact",
            seconds: least(&|it| {
                scheme.oscillator(it.impact.angular_frequency(), damping * it.root())
            }),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with the w of the contact and the damping rate \
                          g = gamma_n sqrt(R_eff xi), of pairs and at walls; q = 2 for \
                          synchronised-verlet, else 1",
        });
    }
    if let Some(Friction::Silbert {
        stiffness, damping, ..
    }) = scene.dem.friction
    {
        // A force at the surface moves it as if the mass were that much less.
        let moved = 1.0 + 1.0 / scene.spheres.shape.inertia_factor();
        limits.push(Limit {
            name: "sticking contact",
            seconds: least(&|it| {
                let root = moved * it.root();
                let squared = stiffness * root / it.impact.effective_mass;
                scheme.oscillator(squared.sqrt(), damping * root)
            }),
            decisive: true,
            explanation: "(w dt)^2 + 2 q g dt < 4 with w^2 = f k_t sqrt(R_eff xi) / m_eff and \
                          g = f gamma_t sqrt(R_eff xi), f = 1 + m r^2 / I, of pairs and at walls; q = 2 \
                          for synchronised-verlet, else 1",
        });
    }
    limits
}
