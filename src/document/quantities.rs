//! Quantities of several keys, with their ranges. These are wider than any experiment and narrow
//! enough that masses, energies and numbers of steps made of them neither vanish nor overflow.

use super::{Attribute, quantity};

/// Least and largest length (m), in scene files and in the files that they name.
pub(crate) const LENGTHS: [f64; 2] = [1e-9, 1e9];

/// A length (m).
pub(crate) fn length(symbol: &str, name: &str) -> Attribute {
    let [least, most] = LENGTHS;
    quantity(symbol, "m", name).at_least(least).at_most(most)
}

/// A coordinate (m).
pub(crate) fn place(symbol: &str, name: &str) -> Attribute {
    let [_, most] = LENGTHS;
    quantity(symbol, "m", name).at_least(-most).at_most(most)
}

/// A time (s) of a run.
pub(crate) fn seconds(symbol: &str, name: &str) -> Attribute {
    quantity(symbol, "s", name).at_least(1e-15).at_most(1e15)
}

/// A number from 0 to 1.
pub(crate) fn fraction(symbol: &str, name: &str) -> Attribute {
    quantity(symbol, "", name).at_least(0.0).at_most(1.0)
}

/// Density of a fluid (kg/m3).
pub(crate) fn fluid_density() -> Attribute {
    quantity("ρ_{fluid}", "kg/m³", "density of the fluid")
        .at_least(0.0)
        .at_most(1e15)
}
