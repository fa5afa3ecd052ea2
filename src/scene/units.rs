//! The units in which a scene is best read.

use super::Scene;

/// The units in which a scene is best read. All numbers are SI; but a scene whose spheres have a
/// diameter of 1 m in a gravity of 1 m/s² is read in units of the spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Metres, seconds, kilograms.
    Si,
    /// The diameter d of the spheres, and τ = sqrt(d/g).
    OfSpheres,
}

impl Scene {
    /// The units in which it is best read: units of its spheres if their mean diameter is 1 m and
    /// gravity 1 m/s². Scenes of spots have no gravity, so only the diameter decides.
    pub fn units(&self) -> Units {
        let gravity = self.dem.effects.gravity.as_ref();
        let of_spheres = match gravity {
            Some(gravity) => gravity.acceleration == 1.0,
            None => self.spot.is_some(),
        };
        if of_spheres && 2.0 * self.spheres.radius.mean() == 1.0 {
            Units::OfSpheres
        } else {
            Units::Si
        }
    }
}

impl Units {
    /// Their description in records.
    pub fn description(self) -> &'static str {
        match self {
            Self::Si => "SI: m, s, kg",
            Self::OfSpheres => "of the spheres: d = 1 m, tau = sqrt(d/g) = 1 s",
        }
    }

    /// An SI unit as figures and text show it: the same number of d and τ. Other units do not
    /// change.
    pub fn shown(self, unit: &str) -> &str {
        match (self, unit) {
            (Self::OfSpheres, "m") => "d",
            (Self::OfSpheres, "s") => "τ",
            (Self::OfSpheres, "m/s") => "d/τ",
            (Self::OfSpheres, "1/s") => "1/τ",
            (Self::OfSpheres, "rad/s") => "rad/τ",
            (Self::OfSpheres, "spheres/s") => "spheres/τ",
            _ => unit,
        }
    }

    /// Symbol of the unit of time.
    pub fn of_time(self) -> &'static str {
        self.shown("s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn the_diameter_and_gravity_tell_the_units() {
        let units = |radius: f64, gravity: &str| {
            let text = format!(
                "spheres = {{ count = 1, radius = {radius}, density = 1e3 }}\n\
                 start = {{ kind = \"list\", spheres = [{{ position = [0, 0, 0] }}] }}\n{gravity}\n\
                 time = {{ dt = 1e-4, duration = 1.0, frame_interval = 1e-3 }}"
            );
            Scene::from_toml(&text, Path::new("scene.toml"))
                .expect("a scene")
                .units()
        };
        assert_eq!(units(0.5, "gravity.acceleration = 1.0"), Units::OfSpheres);
        assert_eq!(units(0.5, "gravity.acceleration = 9.8"), Units::Si);
        assert_eq!(units(0.4, "gravity.acceleration = 1.0"), Units::Si);
        assert_eq!(units(0.5, ""), Units::Si);
    }

    #[test]
    fn figures_show_lengths_and_times_in_units_of_the_scene() {
        for (unit, of_spheres) in [
            ("m", "d"),
            ("spheres/s", "spheres/τ"),
            ("rad", "rad"),
            ("", ""),
        ] {
            assert_eq!(Units::Si.shown(unit), unit);
            assert_eq!(Units::OfSpheres.shown(unit), of_spheres);
        }
    }
}
