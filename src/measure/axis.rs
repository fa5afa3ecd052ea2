//! The axes of space.

/// An axis along which something is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Across a box, from side wall to side wall.
    X,
    /// Through its depth.
    Y,
    /// Up.
    Z,
}

impl Axis {
    /// The coordinate of a place along it is the one of this number.
    pub fn index(self) -> usize {
        self as usize
    }
}
