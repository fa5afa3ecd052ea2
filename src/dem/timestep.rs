//! Limits of the time step: what a scene's stiffest contact, its drag and its friction allow.
//!
//! Both integrators evaluate forces once per step, at velocities half a step behind the positions.
//! A linear oscillator x'' = -w^2 x - g x' then stays bounded while
//! (w dt)^2 + 2 g dt < 4, which is dt < 2/w without damping and dt < 2/g without a spring. Every
//! limit here is that criterion for one effect, at the fastest impact the scene lets expect; the
//! smallest spheres decide, since all of these times grow with the radius.

use super::contact::restitution::{dissipation_time_from_restitution, time_scale};
use crate::scene::{Contact, Friction, Scene, Start, StartSphere};
use std::f64::consts::PI;

/// A limit of the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// What sets it.
    pub name: &'static str,
    /// Largest time step (s).
    pub seconds: f64,
    /// Whether a larger step is unstable and refused. The others are advice.
    pub decisive: bool,
    /// Formula and meaning, in one line.
    pub explanation: &'static str,
}

/// An elastic head-on impact of two equal spheres, in Hertz's theory (Landau and Lifshitz, Theory
/// of Elasticity, section 9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// Effective mass m1 m2 / (m1 + m2) (kg).
    pub effective_mass: f64,
    /// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)) (N/m^1.5), of F = K xi^1.5.
    pub stiffness: f64,
    /// Relative speed (m/s).
    pub speed: f64,
}

impl Impact {
    /// Two spheres of one radius (m) and density (kg/m3), with Young's modulus (Pa) and Poisson's
    /// ratio, at a relative speed (m/s).
    pub fn of_equal_spheres(
        radius: f64,
        density: f64,
        young_modulus: f64,
        poisson_ratio: f64,
        speed: f64,
    ) -> Self {
        let effective_radius = 0.5 * radius;
        Self {
            effective_mass: 0.5 * sphere_mass(radius, density),
            stiffness: 2.0 * young_modulus * effective_radius.sqrt()
                / (3.0 * (1.0 - poisson_ratio * poisson_ratio)),
            speed,
        }
    }

    /// T = (m_eff / K)^(2/5) v^(-1/5) (s).
    pub fn time_scale(&self) -> f64 {
        time_scale(self.effective_mass, self.stiffness, self.speed)
    }

    /// Duration of the contact, 3.218065460 T (s).
    pub fn contact_time(&self) -> f64 {
        3.218_065_460 * self.time_scale()
    }

    /// Deepest overlap, (5/4)^(2/5) v T (m).
    pub fn deepest_overlap(&self) -> f64 {
        libm::pow(1.25, 0.4) * self.speed * self.time_scale()
    }

    /// Largest force (N).
    pub fn largest_force(&self) -> f64 {
        let overlap = self.deepest_overlap();
        self.stiffness * overlap * overlap.sqrt()
    }

    /// Angular frequency w (1/s) of the linearised contact at its deepest overlap, where it is
    /// stiffest: w^2 = (3/2) K sqrt(xi) / m_eff, so that 2/w = contact time / 2.015.
    pub fn angular_frequency(&self) -> f64 {
        (1.5 * self.stiffness * self.deepest_overlap().sqrt() / self.effective_mass).sqrt()
    }
}

/// Rayleigh time (s): a surface wave's way around half a sphere of that radius (m),
/// pi r sqrt(rho / G) / (0.1631 nu + 0.8766) with the shear modulus G = Y / (2 (1 + nu))
/// (Thornton and Randall, 1988; Ning and Ghadiri, 2006).
pub fn rayleigh_time(radius: f64, density: f64, young_modulus: f64, poisson_ratio: f64) -> f64 {
    let shear_modulus = young_modulus / (2.0 * (1.0 + poisson_ratio));
    PI * radius * (density / shear_modulus).sqrt() / (0.1631 * poisson_ratio + 0.8766)
}

/// Dissipation time A (s) of the scene's contact law: as given, or the one that gives a pair of
/// mean spheres the scene's restitution. Zero without a contact law.
pub fn dissipation_time(scene: &Scene) -> f64 {
    let Some(Contact::Hertz {
        young_modulus,
        poisson_ratio,
        dissipation_time,
        restitution,
        restitution_speed,
        dissipation_factor,
    }) = scene.contact
    else {
        return 0.0;
    };
    match (dissipation_time, restitution) {
        (Some(time), _) => time,
        (None, None) => 0.0,
        (None, Some(restitution)) => {
            let impact = Impact::of_equal_spheres(
                scene.spheres.radius.mean(),
                scene.spheres.density,
                young_modulus,
                poisson_ratio,
                restitution_speed,
            );
            dissipation_time_from_restitution(restitution, impact.time_scale(), dissipation_factor)
        }
    }
}

/// The fastest relative speed (m/s) that the scene lets expect at an impact: the largest of the
/// speeds at the start, of free fall from the highest start to the floor, of the air's updraught
/// and of the air's rotation at the wall. Zero if nothing moves.
pub fn fastest_impact(scene: &Scene) -> f64 {
    let (highest, widest, start_speed) = match &scene.start {
        // Two spheres may meet with opposite velocities.
        Start::Random { z_max, speed, .. } => (*z_max, 0.0, 2.0 * 3.0_f64.sqrt() * speed),
        Start::List { spheres } => extent(spheres),
        Start::File { .. } => (0.0, 0.0, 0.0),
    };
    let tank = scene.tank.as_ref();
    let free_fall = match (&scene.gravity, tank.and_then(|tank| tank.floor)) {
        (Some(gravity), Some(floor)) => {
            let height = (highest - floor).max(scene.smallest_radius());
            (2.0 * gravity.acceleration * height).sqrt()
        }
        _ => 0.0,
    };
    let updraught = scene.updraught.as_ref().map_or(0.0, |air| air.speed.abs());
    let wall = tank.and_then(|tank| tank.radius).unwrap_or(widest);
    let swirl = scene
        .swirl
        .as_ref()
        .map_or(0.0, |air| air.omega.abs() * wall);
    [free_fall, updraught, swirl]
        .into_iter()
        .fold(start_speed, f64::max)
}

/// Highest centre (m), largest distance of a centre from the axis (m), and a bound on the speeds
/// of the spheres and their differences (m/s).
fn extent(spheres: &[StartSphere]) -> (f64, f64, f64) {
    let norm = |vector: [f64; 3]| vector.iter().map(|part| part * part).sum::<f64>().sqrt();
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    let (mut highest, mut widest, mut fastest) = (f64::MIN, 0.0_f64, 0.0_f64);
    for StartSphere {
        position, velocity, ..
    } in spheres
    {
        highest = highest.max(position[2]);
        widest = widest.max(norm([position[0], position[1], 0.0]));
        fastest = fastest.max(norm(*velocity));
        for axis in 0..3 {
            low[axis] = low[axis].min(velocity[axis]);
            high[axis] = high[axis].max(velocity[axis]);
        }
    }
    if spheres.is_empty() {
        return (0.0, 0.0, 0.0);
    }
    let spread = norm([0, 1, 2].map(|axis| high[axis] - low[axis]));
    (highest, widest, fastest.max(spread))
}

/// Duration (s) of the shortest contact the scene lets expect, if there is any.
pub fn shortest_contact(scene: &Scene) -> Option<f64> {
    stiffest_impact(scene).map(|impact| impact.contact_time())
}

/// All limits that apply to a scene, the decisive ones first, each group smallest first.
pub fn limits(scene: &Scene) -> Vec<Limit> {
    let mut limits = contact_limits(scene);
    limits.extend(drag_limit(scene));
    limits.extend(spin_damping_limit(scene));
    let finite = |limit: &Limit| limit.seconds.is_finite();
    limits.retain(finite);
    limits.sort_by(|a, b| {
        let order = b.decisive.cmp(&a.decisive);
        order.then(a.seconds.total_cmp(&b.seconds))
    });
    limits
}

/// The limit above which a scene is refused; absent if nothing in it can become unstable.
pub fn largest_stable(scene: &Scene) -> Option<Limit> {
    limits(scene).into_iter().find(|limit| limit.decisive)
}

/// The impact of the two smallest spheres at the fastest speed. A wall or a larger partner is
/// softer: w^2 falls with the effective mass faster than it grows with the effective radius.
fn stiffest_impact(scene: &Scene) -> Option<Impact> {
    let Contact::Hertz {
        young_modulus,
        poisson_ratio,
        ..
    } = scene.contact.as_ref()?;
    let speed = fastest_impact(scene);
    (speed > 0.0).then(|| {
        Impact::of_equal_spheres(
            scene.smallest_radius(),
            scene.spheres.density,
            *young_modulus,
            *poisson_ratio,
            speed,
        )
    })
}

fn contact_limits(scene: &Scene) -> Vec<Limit> {
    let (
        Some(impact),
        Some(Contact::Hertz {
            young_modulus,
            poisson_ratio,
            dissipation_factor,
            ..
        }),
    ) = (stiffest_impact(scene), &scene.contact)
    else {
        return Vec::new();
    };
    let radius = scene.smallest_radius();
    let frequency = impact.angular_frequency();
    let mut limits = vec![
        Limit {
            name: "contact",
            seconds: 2.0 / frequency,
            decisive: true,
            explanation: "2/w of the two smallest spheres at their deepest overlap in the fastest \
                          impact, w^2 = (3/2) K sqrt(xi) / m_eff",
        },
        Limit {
            name: "twelve contacts",
            seconds: 2.0 / (6.0_f64.sqrt() * frequency),
            decisive: false,
            explanation: "2/w of a sphere with twelve such contacts, w^2 = 12 k / m, all of them \
                          taken to act along one line",
        },
        Limit {
            name: "Rayleigh time",
            seconds: rayleigh_time(
                radius,
                scene.spheres.density,
                *young_modulus,
                *poisson_ratio,
            ),
            decisive: false,
            explanation: "pi r sqrt(rho/G) / (0.1631 nu + 0.8766) of the smallest sphere; a \
                          fifth of it is customary",
        },
        Limit {
            name: "displacement",
            seconds: scene.guards.displacement * radius / impact.speed,
            decisive: false,
            explanation: "the fastest sphere stays below the displacement guard",
        },
    ];
    limits.extend(damping_limit(
        frequency,
        dissipation_factor * dissipation_time(scene),
    ));
    limits.extend(friction_limit(scene, &impact, *poisson_ratio));
    limits
}

/// The contact law's damping rate at overlap xi is g = K c A sqrt(xi) / m_eff = (2/3) c A w^2.
fn damping_limit(frequency: f64, dissipation: f64) -> Option<Limit> {
    let rate = 2.0 / 3.0 * dissipation * frequency * frequency;
    (rate > 0.0).then(|| Limit {
        name: "damped contact",
        // The positive root of (w dt)^2 + 2 g dt = 4, in the form that does not cancel.
        seconds: 4.0 / (rate + (rate * rate + 4.0 * frequency * frequency).sqrt()),
        decisive: true,
        explanation: "(w dt)^2 + 2 g dt < 4 with the w of the contact limit and the damping rate \
                      g = (2/3) c A w^2",
    })
}

fn friction_limit(scene: &Scene, impact: &Impact, poisson_ratio: f64) -> Option<Limit> {
    match scene.friction.as_ref()? {
        // Its stability does not depend on the step: see the range of its coefficient.
        Friction::Spin { .. } => None,
        // The surfaces of two equal spheres move like a mass m_eff / (1 + 5/2).
        Friction::Coulomb {
            coefficient,
            regularisation,
        } => Some(Limit {
            name: "regularised friction",
            seconds: 2.0 * regularisation * impact.effective_mass
                / (3.5 * coefficient * impact.largest_force()),
            decisive: false,
            explanation: "2 u_0 m_eff / (3.5 mu F) at the largest force; above it sliding that \
                          should stop changes sign from step to step",
        }),
        Friction::Mindlin { .. } => {
            let stiffness_ratio = 2.0 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio);
            Some(Limit {
                name: "sticking contact",
                seconds: 2.0 / ((3.5 * stiffness_ratio).sqrt() * impact.angular_frequency()),
                decisive: true,
                explanation: "2/w of the tangential spring, w_t^2 = 3.5 k_t / m_eff with \
                              k_t / k_n = 2 (1 - nu) / (2 - nu)",
            })
        }
    }
}

/// A sphere that slips through the air at speed u returns to its terminal speed at the rate
/// (c1 + 2 c2 u) / m. Swirl and updraught both act on the vertical velocity.
fn drag_limit(scene: &Scene) -> Option<Limit> {
    let drag = scene.drag.as_ref()?;
    let lowest = match (
        &scene.start,
        scene.tank.as_ref().and_then(|tank| tank.floor),
    ) {
        (_, Some(floor)) => floor,
        (Start::Random { z_min, .. }, None) => *z_min,
        (Start::List { spheres }, None) => spheres
            .iter()
            .fold(f64::MAX, |low, sphere| low.min(sphere.position[2])),
        (Start::File { .. }, None) => 0.0,
    };
    let updraught = scene.updraught.as_ref().map_or(0.0, |air| {
        air.strength_in(scene.swirl.as_ref()) * libm::exp(-air.decay * (lowest - air.origin))
    });
    let swirl = if scene.swirl.is_some() { 1.0 } else { 0.0 };
    let (linear, quadratic) = drag.coefficients(scene.smallest_radius());
    let coefficient = (linear + 2.0 * quadratic * fastest_impact(scene)) * (swirl + updraught);
    let mass = sphere_mass(scene.smallest_radius(), scene.spheres.density);
    Some(Limit {
        name: "drag",
        seconds: 2.0 * mass / coefficient,
        decisive: true,
        explanation: "2 m / (c1 + 2 c2 u) of the smallest sphere, times the factors of swirl and \
                      updraught at the lowest height",
    })
}

fn spin_damping_limit(scene: &Scene) -> Option<Limit> {
    let damping = scene.spin_damping.as_ref()?;
    let radius = scene.smallest_radius();
    let inertia = 0.4 * sphere_mass(radius, scene.spheres.density) * radius * radius;
    Some(Limit {
        name: "spin damping",
        seconds: 2.0 * inertia / damping.coefficient,
        decisive: true,
        explanation: "2 I / c of the smallest sphere",
    })
}

/// Mass of a sphere (kg).
pub(crate) fn sphere_mass(radius: f64, density: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius * density
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::from_str;
    use std::path::Path;

    fn close(found: f64, expected: f64, tolerance: f64) {
        let error = (found / expected - 1.0).abs();
        assert!(error < tolerance, "{found:e} instead of {expected:e}");
    }

    fn impact_at_one_metre_per_second(young_modulus: f64, density: f64) -> Impact {
        Impact::of_equal_spheres(0.004, density, young_modulus, 0.3, 1.0)
    }

    #[test]
    fn limits_of_a_soft_and_of_a_steel_pair() {
        // Pair limit, Rayleigh time and twelve contacts (s), to the four digits they are known to.
        let cases = [
            (2e5, 1e4, 3.370e-3, 4.895e-3, 1.376e-3),
            (2.1e11, 7850.0, 1.194e-5, 4.233e-6, 4.876e-6),
        ];
        for (young_modulus, density, pair, rayleigh, twelve) in cases {
            let impact = impact_at_one_metre_per_second(young_modulus, density);
            close(2.0 / impact.angular_frequency(), pair, 5e-4);
            close(impact.contact_time() / 2.015, pair, 5e-4);
            close(
                rayleigh_time(0.004, density, young_modulus, 0.3),
                rayleigh,
                5e-4,
            );
            close(
                2.0 / (6.0_f64.sqrt() * impact.angular_frequency()),
                twelve,
                5e-4,
            );
        }
    }

    #[test]
    fn elastic_impacts_of_known_materials() {
        // Set-ups of Chung and Ooi (2011): overlap (um), force (N), contact time (us).
        let glass = Impact::of_equal_spheres(0.01, 2800.0, 48e9, 0.2, 20.0);
        let aluminium_on_rigid_wall = Impact {
            effective_mass: sphere_mass(0.1, 2699.0),
            stiffness: 4.0 / 3.0 * 70e9 / (1.0 - 0.3 * 0.3) * 0.1_f64.sqrt(),
            speed: 0.2,
        };
        let cases = [
            (glass, 274.1127, 10_696.889, 40.339_456),
            (aluminium_on_rigid_wall, 49.717_175, 11_369.858, 731.656_64),
        ];
        for (impact, overlap, force, time) in cases {
            close(1e6 * impact.deepest_overlap(), overlap, 1e-6);
            close(impact.largest_force(), force, 1e-6);
            close(1e6 * impact.contact_time(), time, 1e-6);
        }
    }

    /// Two spheres that meet at 1 m/s, and what else `tables` says.
    fn pair(tables: &str) -> Scene {
        let text = format!(
            "{tables}
            [spheres]
            count = 2
            radius = 0.004
            density = 1e4
            [start]
            kind = 'list'
            spheres = [
                {{ position = [0, 0, 0], velocity = [0.5, 0, 0] }},
                {{ position = [1, 0, 0], velocity = [-0.5, 0, 0] }},
            ]
            [time]
            dt = 1e-7
            duration = 1
            frame_interval = 1e-3"
        );
        from_str(&text, Path::new("pair.toml")).unwrap_or_else(|error| panic!("{error}"))
    }

    fn hertz(dissipation: &str) -> String {
        format!(
            "contact = {{ law = 'hertz', young_modulus = 2e5, poisson_ratio = 0.3, {dissipation} }}\n"
        )
    }

    #[test]
    fn the_scene_decides_which_limits_there_are() {
        assert_eq!(limits(&pair("")), []);
        assert_eq!(largest_stable(&pair("")), None);
        let names =
            |scene: &Scene| -> Vec<&str> { limits(scene).iter().map(|limit| limit.name).collect() };
        let elastic = pair(&hertz("dissipation_time = 0"));
        assert_eq!(
            names(&elastic),
            [
                "contact",
                "twelve contacts",
                "displacement",
                "Rayleigh time"
            ]
        );
        close(largest_stable(&elastic).unwrap().seconds, 3.370e-3, 5e-4);
        let damped = pair(&hertz("dissipation_time = 1e-3"));
        assert_eq!(largest_stable(&damped).unwrap().name, "damped contact");
        let mindlin = "friction = { law = 'mindlin', coefficient = 0.3 }\n";
        let sticking = pair(&(hertz("dissipation_time = 0") + mindlin));
        assert_eq!(largest_stable(&sticking).unwrap().name, "sticking contact");
    }

    #[test]
    fn a_restitution_becomes_a_dissipation_time() {
        // b = 0.473881 gives e = 0.609834523 for this pair at 1 m/s with A = 1e-3 s and c = 1.
        let scene = pair(&hertz("restitution = 0.609834523"));
        close(dissipation_time(&scene), 1e-3, 1e-6);
        let scene = pair(&hertz(
            "restitution = 0.494664113, dissipation_factor = 1.5",
        ));
        close(dissipation_time(&scene), 1e-3, 1e-6);
        assert_eq!(
            dissipation_time(&pair(&hertz("dissipation_time = 2e-4"))),
            2e-4
        );
    }

    #[test]
    fn the_smallest_sphere_decides() {
        let scene = |radius: &str| {
            let text = format!(
                "contact = {{ law = 'hertz', young_modulus = 2e5, poisson_ratio = 0.3, dissipation_time = 0 }}
                spheres = {{ count = 2, density = 1e4, radius = {radius} }}
                tank = {{ radius = 0.06, floor = 0.0 }}
                start = {{ kind = 'random', z_min = 0.1, z_max = 0.2 }}
                gravity = {{ acceleration = 9.8 }}
                time = {{ dt = 1e-6, duration = 1, frame_interval = 1e-3 }}"
            );
            from_str(&text, Path::new("scene.toml")).unwrap_or_else(|error| panic!("{error}"))
        };
        let mixed = scene("[{ radius = 0.002, share = 1 }, { radius = 0.004, share = 1 }]");
        assert_eq!(limits(&mixed), limits(&scene("0.002")));
        assert!(limits(&mixed)[0].seconds < limits(&scene("0.004"))[0].seconds);
        close(fastest_impact(&mixed), (2.0 * 9.8 * 0.2_f64).sqrt(), 1e-12);
    }

    /// Whether x'' = -w^2 x - g x' stays bounded under the scheme both integrators share.
    fn bounded(frequency: f64, rate: f64, dt: f64) -> bool {
        let (mut position, mut velocity) = (1.0, 0.0);
        for _ in 0..20_000 {
            velocity -= dt * (frequency * frequency * position + rate * velocity);
            position += dt * velocity;
        }
        f64::abs(position) < 1e3
    }

    #[test]
    fn the_damped_limit_is_where_an_oscillator_diverges() {
        for (frequency, dissipation) in [(1.0, 0.1), (3.0, 1.0), (10.0, 3.0)] {
            let limit = damping_limit(frequency, dissipation).unwrap().seconds;
            let rate = 2.0 / 3.0 * dissipation * frequency * frequency;
            assert!(bounded(frequency, rate, 0.99 * limit));
            assert!(!bounded(frequency, rate, 1.01 * limit));
        }
        assert!(bounded(5.0, 0.0, 0.99 * 2.0 / 5.0) && !bounded(5.0, 0.0, 1.01 * 2.0 / 5.0));
        assert_eq!(damping_limit(5.0, 0.0), None);
    }

    #[test]
    fn air_and_spins_limit_the_step() {
        let still_air = "drag = { law = 'constant', linear = 0.1, quadratic = 0.2 }
            swirl = { omega = 0.0 }\n";
        let mass = sphere_mass(0.004, 1e4);
        let limit = largest_stable(&pair(still_air)).unwrap();
        assert_eq!(limit.name, "drag");
        close(limit.seconds, 2.0 * mass / (0.1 + 2.0 * 0.2 * 1.0), 1e-12);
        let damped = hertz("dissipation_time = 0")
            + "friction = { law = 'spin', coefficient = 0.01 }
               spin_damping = { coefficient = 1e-3 }\n";
        let limit = largest_stable(&pair(&damped)).unwrap();
        assert_eq!(limit.name, "spin damping");
        close(
            limit.seconds,
            2.0 * 0.4 * mass * 0.004 * 0.004 / 1e-3,
            1e-12,
        );
    }
}
