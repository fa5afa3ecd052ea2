//! The notation: symbol, unit and plain name of every numeric key of a scene.
//!
//! The only place that knows them; figures and documentation read it.

use crate::scene::{Contact, DragLaw, Friction, Scene, Shape};

/// How a quantity is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Notation {
    /// Path of the key in a scene file.
    pub key: &'static str,
    /// Symbol; `_` makes a subscript of the next character or of a group in braces.
    pub symbol: &'static str,
    /// SI unit; empty for a pure number.
    pub unit: &'static str,
    /// Plain name, without the unit.
    pub name: &'static str,
}

impl Notation {
    /// The unit in this scene: that of a drag coefficient depends on the drag law.
    pub fn unit_in(&self, scene: &Scene) -> &'static str {
        if self.key == "spheres.density" && scene.spheres.shape == Shape::Disc {
            return OF_DISCS;
        }
        if let Some(of_silbert) = self.unit_of_silbert() {
            let silbert = match self.key.starts_with("contact.") {
                true => matches!(scene.contact, Some(Contact::Silbert { .. })),
                false => matches!(scene.friction, Some(Friction::Silbert { .. })),
            };
            return if silbert { of_silbert } else { self.unit };
        }
        let law = scene.drag.as_ref().map(|drag| drag.law);
        law.map_or(self.unit, |law| self.unit_with(law))
    }

    /// The units that this quantity has in one scene or another, `unit` first.
    pub fn units(&self) -> Vec<&'static str> {
        let mut units = vec![self.unit];
        for law in [DragLaw::CrossSection, DragLaw::Diameter, DragLaw::Constant] {
            let unit = self.unit_with(law);
            if !units.contains(&unit) {
                units.push(unit);
            }
        }
        if self.key == "spheres.density" {
            units.push(OF_DISCS);
        }
        units.extend(self.unit_of_silbert());
        units
    }

    /// The unit with the contact and the friction of Silbert et al., where it is another one.
    fn unit_of_silbert(&self) -> Option<&'static str> {
        match self.key {
            "contact.stiffness" | "friction.stiffness" => Some("Pa"),
            "contact.damping" | "friction.damping" => Some("1/(m s)"),
            _ => None,
        }
    }

    fn unit_with(&self, law: DragLaw) -> &'static str {
        match (self.key, law) {
            ("drag.linear", DragLaw::Diameter) => "kg/(m s)",
            ("drag.linear", DragLaw::Constant) => "kg/s",
            ("drag.quadratic", DragLaw::Constant) => "kg/m",
            _ => self.unit,
        }
    }
}

/// The notation of a key, if it is a numeric key of a scene.
pub fn notation(key: &str) -> Option<&'static Notation> {
    SCENE_KEYS.iter().find(|notation| notation.key == key)
}

const fn row(
    key: &'static str,
    symbol: &'static str,
    unit: &'static str,
    name: &'static str,
) -> Notation {
    Notation {
        key,
        symbol,
        unit,
        name,
    }
}

/// Unit of the density of discs.
const OF_DISCS: &str = "kg/m²";

/// Every numeric key of a scene, in the order of [`Scene`].
#[rustfmt::skip]
pub const SCENE_KEYS: &[Notation] = &[
    row("seed", "seed", "", "seed"),
    row("spheres.count", "n", "", "number of spheres"),
    row("spheres.radius", "r", "m", "radius of the spheres"),
    row("spheres.density", "ρ", "kg/m³", "density of the spheres"),
    row("contact.young_modulus", "Y", "Pa", "Young's modulus"),
    row("contact.poisson_ratio", "ν", "", "Poisson's ratio"),
    row("contact.dissipation_time", "A", "s", "dissipation time"),
    row("contact.restitution", "e", "", "coefficient of restitution"),
    row("contact.restitution_speed", "v_e", "m/s", "speed at which the restitution holds"),
    row("contact.dissipation_factor", "c", "", "factor of the dissipative term"),
    row("contact.stiffness", "k", "N/m", "spring constant of a contact"),
    row("contact.damping", "b", "N s/m", "drag constant of a contact"),
    row("friction.coefficient", "μ", "", "coefficient of friction"),
    row("friction.stiffness", "k_t", "N/m", "tangential spring constant"),
    row("friction.damping", "b_t", "N s/m", "tangential drag constant"),
    row("friction.regularisation", "v_μ", "m/s", "sliding speed of full friction"),
    row("tank.radius", "R", "m", "radius of the tank"),
    row("tank.width", "W", "m", "width of the tank"),
    row("tank.depth", "W_y", "m", "depth of the tank"),
    row("tank.floor", "z_{floor}", "m", "height of the floor"),
    row("geometry.half_width", "W / 2", "m", "half the width of the silo"),
    row("geometry.top", "z_{top}", "m", "top of the walls"),
    row("geometry.foot", "z_{foot}", "m", "foot of the walls"),
    row("geometry.slope", "φ", "rad", "angle of the slopes"),
    row("geometry.opening", "D", "m", "clear width of the opening"),
    row("geometry.spacing", "Δ_{wall}", "m", "distance between fixed spheres"),
    row("geometry.radius", "r_{wall}", "m", "radius of the fixed spheres"),
    row("door.opens", "t_{door}", "s", "time at which the door opens"),
    row("rest.kinetic_energy", "E_{rest}", "J", "kinetic energy of spheres at rest"),
    row("rest.hold", "t_{rest}", "s", "time for which spheres must be slow"),
    row("outlet.height", "z_{out}", "m", "height below which spheres are out"),
    row("start.z_min", "z_{min}", "m", "lowest start height"),
    row("start.z_max", "z_{max}", "m", "highest start height"),
    row("start.speed", "v_{start}", "m/s", "largest start velocity component"),
    row("start.spin", "ω_{start}", "rad/s", "largest start spin component"),
    row("start.interval", "Δt_{feed}", "s", "time between spheres that come in"),
    row("start.spread", "Δx_{feed}", "m", "random shift of where spheres come in"),
    row("gravity.acceleration", "g", "m/s²", "acceleration of gravity"),
    row("gravity.tilt", "θ", "rad", "tilt of gravity"),
    row("drag.linear", "M_1", "kg/(m² s)", "linear drag coefficient"),
    row("drag.quadratic", "M_2", "kg/m³", "quadratic drag coefficient"),
    row("swirl.omega", "Ω", "rad/s", "angular velocity of the air"),
    row("updraught.speed", "v_z", "m/s", "speed of the rising air"),
    row("updraught.strength", "s", "", "strength of the updraught"),
    row("updraught.decay", "β", "1/m", "decay of the updraught with height"),
    row("updraught.origin", "z_0", "m", "height where the decay begins"),
    row("updraught.alpha", "α", "", "factor per shielding sphere"),
    row("updraught.reference_omega", "Ω_0", "rad/s", "rotation at which the updraught is as given"),
    row("spin_damping.coefficient", "c_ω", "kg m²/s", "coefficient of spin damping"),
    row("neighbours.length", "L", "m", "side of a cell"),
    row("time.dt", "Δt", "s", "time step"),
    row("time.safety_factor", "f", "", "time step over its least limit"),
    row("time.duration", "T", "s", "duration"),
    row("time.frame_interval", "Δt_{frame}", "s", "time between frames"),
    row("guards.overlap", "ξ_{max} / r", "", "largest overlap, in radii"),
    row("guards.displacement", "Δx_{max} / r", "", "largest displacement per step, in radii"),
    row("guards.horizontal", "x_{max}", "m", "largest |x| and |y|"),
    row("guards.vertical", "z_{guard}", "m", "largest |z|"),
    row("output.snapshot_interval", "Δt_{snapshot}", "s", "time between snapshots"),
    row("output.profile_bins", "n_{bins}", "", "radial bins of the surface profile"),
];

/// Units of the numbers in files that are no numeric keys of a scene: entries of lists (`[]`), axes,
/// and thresholds of the sieves. Empty for a pure number.
#[rustfmt::skip]
pub const OTHER_UNITS: &[(&str, &str)] = &[
    ("spheres.radius[].radius", "m"),
    ("spheres.radius[].share", ""),
    ("geometry.walls[].position", "m"),
    ("geometry.walls[].radius", "m"),
    ("geometry.door[].position", "m"),
    ("geometry.door[].radius", "m"),
    ("start.position", "m"),
    ("start.velocity", "m/s"),
    ("start.spheres[].position", "m"),
    ("start.spheres[].velocity", "m/s"),
    ("start.spheres[].spin", "rad/s"),
    ("start.spheres[].radius", "m"),
    ("output.rise_speeds", "1/s"),
    ("output.rise_radii", ""),
    ("axis[].values", "of the key"),
    ("axis[].from", "of the key"),
    ("axis[].to", "of the key"),
    ("axis[].step", "of the key"),
    ("sieves.settle.window", "s"),
    ("sieves.settle.height", "m"),
    ("sieves.settle.tolerance", ""),
    ("sieves.fluid.window", "s"),
    ("sieves.fluid.rise", ""),
    ("sieves.fluid.share", ""),
    ("sieves.pinned.window", "s"),
    ("sieves.pinned.hole", ""),
    ("sieves.pinned.share", ""),
    ("sieves.spout.window", "s"),
    ("sieves.spout.rise_speed", "1/s"),
    ("sieves.spout.radius", ""),
    ("sieves.spout.small", ""),
    ("sieves.spout.large", ""),
    ("sieves.emptied.share", ""),
    ("sieves.arching.window", "s"),
    ("sieves.flowing.window", "s"),
    ("energy_gain", ""),
];

/// The unit of a number in a scene or sweep file, if it is known; empty for a pure number. That of
/// a drag coefficient names the units of all drag laws.
pub fn unit(key: &str) -> Option<String> {
    if let Some(notation) = notation(key) {
        return Some(notation.units().join(", "));
    }
    let other = OTHER_UNITS.iter().find(|(other, _)| *other == key);
    other.map(|(_, unit)| (*unit).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};
    use std::collections::BTreeSet;

    /// Scenes that together set every numeric key.
    fn scenes() -> Vec<Scene> {
        let scene = |contact: Value, friction: Value| -> Scene {
            serde_json::from_value(json!({
                "spheres": { "count": 3, "radius": 0.004, "density": 1e3 },
                "contact": contact,
                "friction": friction,
                "tank": { "radius": 0.06, "width": 0.1, "depth": 0.1, "floor": -0.2 },
                "start": { "kind": "random", "z_min": -0.1, "z_max": 0.3 },
                "gravity": { "acceleration": 9.8, "tilt": 0.1 },
                "drag": { "linear": 1.0, "quadratic": 1.0, "law": "cross-section" },
                "swirl": { "omega": 3.0 },
                "updraught": { "speed": 1.0, "decay": 25.0, "origin": 0.0, "alpha": 0.5,
                    "reference_omega": 3.0 },
                "spin_damping": { "coefficient": 1.0 },
                "time": { "dt": 1e-4, "duration": 1.0, "frame_interval": 1e-3 },
                "guards": { "horizontal": 1.0, "vertical": 1.0 },
                "output": { "profile_bins": 8 },
            }))
            .unwrap()
        };
        let hertz = json!({ "law": "hertz", "young_modulus": 1e5, "poisson_ratio": 0.3,
            "dissipation_time": 1e-3, "restitution": 0.9 });
        let silo = json!({
            "spheres": { "count": 3, "radius": 0.04, "density": 1.0, "shape": "disc" },
            "contact": { "law": "linear", "stiffness": 100.0, "damping": 0.05 },
            "friction": { "law": "cundall-strack", "coefficient": 0.1, "stiffness": 80.0 },
            "geometry": { "kind": "hopper", "half_width": 1.3, "top": 4.0, "foot": 1.0,
                "slope": 0.6, "opening": 0.3, "spacing": 0.05, "radius": 0.03 },
            "start": { "kind": "feed", "position": [0.0, 0.0, 4.0], "interval": 0.05 },
            "rest": { "kinetic_energy": 1e-4 },
            "door": { "opens": 60.0 },
            "outlet": { "height": -1.0 },
            "neighbours": { "search": "cells", "length": 0.25 },
            "time": { "dt": 1e-3, "safety_factor": 0.2, "duration": 300.0, "frame_interval": 0.05 },
        });
        vec![
            scene(
                hertz,
                json!({ "law": "coulomb", "coefficient": 0.1, "regularisation": 1e-3 }),
            ),
            serde_json::from_value(silo).unwrap(),
        ]
    }

    fn numeric_keys(value: &Value, path: &str, keys: &mut BTreeSet<String>) {
        match value {
            Value::Number(_) => {
                keys.insert(path.to_owned());
            }
            Value::Object(table) => {
                for (name, value) in table {
                    let dot = if path.is_empty() { "" } else { "." };
                    numeric_keys(value, &format!("{path}{dot}{name}"), keys);
                }
            }
            _ => {}
        }
    }

    #[test]
    fn covers_every_numeric_key_of_a_scene_and_no_other() {
        let mut keys = BTreeSet::new();
        for scene in scenes() {
            numeric_keys(&serde_json::to_value(scene).unwrap(), "", &mut keys);
        }
        let known: BTreeSet<String> = SCENE_KEYS.iter().map(|row| row.key.to_owned()).collect();
        assert_eq!(known.len(), SCENE_KEYS.len(), "a key occurs twice");
        assert_eq!(keys, known);
    }

    #[test]
    fn unit_of_drag_depends_on_its_law() {
        let mut scene = scenes().remove(0);
        let linear = notation("drag.linear").unwrap();
        assert_eq!(linear.unit_in(&scene), "kg/(m² s)");
        scene.drag.as_mut().unwrap().law = DragLaw::Constant;
        assert_eq!(linear.unit_in(&scene), "kg/s");
    }
}
