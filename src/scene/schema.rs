//! The keys of a scene file: which there are, which must be there, and what each may hold.
//!
//! What the keys mean and their units stand at the structs in [`super`].

use super::Integrator;
use crate::document::schema::{Kind, Range, needed, optional};

/// Least and largest length (m), in scene files and in the files that they name.
pub(crate) const LENGTHS: [f64; 2] = [1e-9, 1e9];

/// In the place of a time step: one that follows from the scene.
pub(crate) const AUTO: &str = "auto";

// Wider than any experiment, narrow enough that masses, energies and numbers of steps made of them
// neither vanish nor overflow.
const LENGTH: Kind = Kind::Number(Range::between(LENGTHS[0], LENGTHS[1]));
const PLACE: Kind = Kind::Number(Range::between(-LENGTHS[1], LENGTHS[1]));
const DENSITY: Kind = Kind::Number(Range::between(1e-9, 1e15));
const SECONDS: Kind = Kind::Number(Range::between(1e-15, 1e15));
const NUMBER: Kind = Kind::Number(Range::ANY);
const POSITIVE: Kind = Kind::Number(Range::POSITIVE);
const NOT_NEGATIVE: Kind = Kind::Number(Range::NOT_NEGATIVE);
const COUNT: Kind = Kind::Whole(1);

/// The keys of a scene file.
pub(crate) const SCENE: Kind = Kind::Table(&[
    optional("title", Kind::Text),
    optional("seed", Kind::Whole(0)),
    needed("spheres", SPHERES),
    optional("contact", CONTACT),
    optional("friction", FRICTION),
    optional("tank", TANK),
    optional("geometry", GEOMETRY),
    optional("door", Kind::Table(&[optional("opens", NOT_NEGATIVE)])),
    optional(
        "rest",
        Kind::Table(&[
            needed("kinetic_energy", POSITIVE),
            optional("hold", POSITIVE),
        ]),
    ),
    optional("outlet", Kind::Table(&[needed("height", NUMBER)])),
    needed("start", START),
    optional(
        "gravity",
        Kind::Table(&[
            needed("acceleration", NOT_NEGATIVE),
            optional("tilt", NUMBER),
        ]),
    ),
    optional("drag", DRAG),
    optional("swirl", Kind::Table(&[needed("omega", NUMBER)])),
    optional("updraught", UPDRAUGHT),
    optional(
        "spin_damping",
        Kind::Table(&[needed("coefficient", NOT_NEGATIVE)]),
    ),
    optional("neighbours", NEIGHBOURS),
    needed("time", TIME),
    optional("guards", GUARDS),
    optional("output", OUTPUT),
]);

const SPHERES: Kind = Kind::Table(&[
    needed("count", COUNT),
    needed("radius", RADII),
    needed("density", DENSITY),
    optional("shape", Kind::Choice(&["sphere", "disc"])),
]);

const RADII: Kind = Kind::Either(&[
    LENGTH,
    Kind::List(&Kind::Table(&[
        needed("radius", LENGTH),
        needed("share", NOT_NEGATIVE),
    ])),
    Kind::List(&LENGTH),
    Kind::Table(&[needed("file", Kind::Text)]),
]);

const CONTACT: Kind = Kind::Tagged(
    "law",
    &[
        (
            "hertz",
            &[
                needed("young_modulus", POSITIVE),
                needed("poisson_ratio", Kind::Number(Range::above(-1.0, 0.5))),
                optional("dissipation_time", NOT_NEGATIVE),
                optional("restitution", Kind::Number(Range::between(0.01, 1.0))),
                optional("restitution_speed", POSITIVE),
                optional("dissipation_factor", POSITIVE),
            ],
        ),
        (
            "linear",
            &[
                needed("stiffness", POSITIVE),
                needed("damping", NOT_NEGATIVE),
                optional("drag", Kind::Choice(&["normal", "whole"])),
            ],
        ),
        (
            "silbert",
            &[
                needed("stiffness", POSITIVE),
                needed("damping", NOT_NEGATIVE),
            ],
        ),
    ],
);

const FRICTION: Kind = Kind::Tagged(
    "law",
    &[
        // Above 1, a step turns the spins of a touching pair around and lets them grow.
        (
            "spin",
            &[needed("coefficient", Kind::Number(Range::FRACTION))],
        ),
        (
            "coulomb",
            &[
                needed("coefficient", NOT_NEGATIVE),
                needed("regularisation", POSITIVE),
            ],
        ),
        (
            "cundall-strack",
            &[
                needed("coefficient", NOT_NEGATIVE),
                needed("stiffness", POSITIVE),
                optional("damping", NOT_NEGATIVE),
            ],
        ),
        ("mindlin", &[needed("coefficient", NOT_NEGATIVE)]),
        (
            "silbert",
            &[
                needed("coefficient", NOT_NEGATIVE),
                needed("stiffness", POSITIVE),
                optional("damping", NOT_NEGATIVE),
            ],
        ),
    ],
);

const TANK: Kind = Kind::Table(&[
    optional("radius", LENGTH),
    optional("width", LENGTH),
    optional("depth", LENGTH),
    optional("floor", PLACE),
]);

const GEOMETRY: Kind = Kind::Tagged(
    "kind",
    &[
        (
            "file",
            &[
                needed("path", Kind::Text),
                needed("unit", Kind::Choice(&["m", "cm", "mm"])),
            ],
        ),
        (
            "hopper",
            &[
                needed("half_width", LENGTH),
                needed("top", PLACE),
                needed("foot", PLACE),
                needed("slope", Kind::Number(Range::between(0.0, 1.5))),
                needed("opening", LENGTH),
                needed("spacing", LENGTH),
                needed("radius", LENGTH),
            ],
        ),
        (
            "list",
            &[
                needed("walls", Kind::List(&FIXED_SPHERE)),
                optional("door", Kind::List(&FIXED_SPHERE)),
            ],
        ),
    ],
);

const FIXED_SPHERE: Kind =
    Kind::Table(&[needed("position", Kind::Vector), needed("radius", LENGTH)]);

const START: Kind = Kind::Tagged(
    "kind",
    &[
        (
            "random",
            &[
                needed("z_min", PLACE),
                needed("z_max", PLACE),
                optional("speed", NOT_NEGATIVE),
                optional("spin", NOT_NEGATIVE),
            ],
        ),
        ("list", &[needed("spheres", Kind::List(&START_SPHERE))]),
        (
            "feed",
            &[
                needed("position", Kind::Vector),
                optional("velocity", Kind::Vector),
                needed("interval", POSITIVE),
                optional("spread", NOT_NEGATIVE),
            ],
        ),
        ("file", &[needed("path", Kind::Text)]),
    ],
);

/// A sphere of a list to start from.
pub(super) const START_SPHERE: Kind = Kind::Table(&[
    needed("position", Kind::Vector),
    optional("velocity", Kind::Vector),
    optional("spin", Kind::Vector),
    optional("radius", LENGTH),
]);

const DRAG: Kind = Kind::Table(&[
    optional("linear", NOT_NEGATIVE),
    optional("quadratic", NOT_NEGATIVE),
    needed(
        "law",
        Kind::Choice(&["cross-section", "diameter", "constant"]),
    ),
    optional("form", Kind::Choice(&["vector", "component"])),
]);

const UPDRAUGHT: Kind = Kind::Table(&[
    needed("speed", NUMBER),
    optional("strength", NOT_NEGATIVE),
    needed("decay", NOT_NEGATIVE),
    needed("origin", PLACE),
    needed("alpha", Kind::Number(Range::FRACTION)),
    optional("reference_omega", POSITIVE),
]);

const NEIGHBOURS: Kind = Kind::Tagged(
    "search",
    &[
        ("verlet-list", &[]),
        ("all-pairs", &[]),
        ("cells", &[needed("length", LENGTH)]),
        ("hashed-cells", &[needed("length", LENGTH)]),
    ],
);

const TIME: Kind = Kind::Table(&[
    needed("dt", Kind::Either(&[SECONDS, Kind::Choice(&[AUTO])])),
    optional("safety_factor", Kind::Number(Range::above(0.0, 1.0))),
    needed("duration", SECONDS),
    needed("frame_interval", SECONDS),
    optional("integrator", INTEGRATOR),
]);

/// The integrators by their names.
pub(crate) const INTEGRATOR: Kind = Kind::Choice(&Integrator::NAMES);

const GUARDS: Kind = Kind::Table(&[
    optional("overlap", POSITIVE),
    optional("displacement", POSITIVE),
    optional("horizontal", POSITIVE),
    optional("vertical", POSITIVE),
]);

const OUTPUT: Kind = Kind::Table(&[
    optional("snapshot_interval", NOT_NEGATIVE),
    optional("trajectory", Kind::Flag),
    optional("ledger", Kind::Flag),
    optional("profile_bins", COUNT),
    optional("rise_speeds", Kind::List(&NUMBER)),
    optional("rise_radii", Kind::List(&POSITIVE)),
]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::schema::differences;
    use crate::scene::Scene;
    use serde_json::{Value, json};

    fn everything(friction: Value, start: Value) -> Value {
        json!({
            "spheres": { "count": 2, "radius": 0.004, "density": 1e3 },
            "contact": { "law": "hertz", "young_modulus": 1e6, "poisson_ratio": 0.3 },
            "friction": friction,
            "tank": {},
            "start": start,
            "gravity": { "acceleration": 9.8 },
            "drag": { "law": "diameter" },
            "swirl": { "omega": 1.0 },
            "updraught": { "speed": 1.0, "decay": 25.0, "origin": 0.0, "alpha": 0.5 },
            "spin_damping": { "coefficient": 1e-8 },
            "geometry": { "kind": "file", "path": "silo1.dat", "unit": "cm" },
            "door": {},
            "rest": { "kinetic_energy": 1e-4 },
            "outlet": { "height": -1.0 },
            "neighbours": { "search": "cells", "length": 0.25 },
            "time": { "dt": 1e-4, "duration": 1.0, "frame_interval": 1e-3 },
            "guards": {},
            "output": { "ledger": true },
        })
    }

    #[test]
    fn the_description_has_the_keys_of_the_structs() {
        let sphere = json!({ "position": [0.0, 0.0, 0.0] });
        let scenes = [
            everything(
                json!({ "law": "spin", "coefficient": 0.1 }),
                json!({ "kind": "random", "z_min": 0.0, "z_max": 1.0 }),
            ),
            everything(
                json!({ "law": "coulomb", "coefficient": 0.1, "regularisation": 1e-3 }),
                json!({ "kind": "list", "spheres": [sphere] }),
            ),
            everything(
                json!({ "law": "cundall-strack", "coefficient": 0.1, "stiffness": 80.0 }),
                json!({ "kind": "feed", "position": [0.0, 0.0, 4.0], "interval": 0.05 }),
            ),
            everything(
                json!({ "law": "mindlin", "coefficient": 0.1 }),
                json!({ "kind": "file", "path": "start.csv" }),
            ),
            everything(
                json!({ "law": "silbert", "coefficient": 0.1, "stiffness": 1e5 }),
                json!({ "kind": "random", "z_min": 0.0, "z_max": 1.0 }),
            ),
        ];
        for scene in scenes {
            assert_eq!(differences::<Scene>(&SCENE, &scene), Vec::<String>::new());
        }
    }
}
