//! The axes of space.

/// An axis along which something is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceAxis {
    /// Across a box, from side wall to side wall.
    X,
    /// Through its depth.
    Y,
    /// Up.
    Z,
}

impl SpaceAxis {
    /// Index of the coordinate along it.
    pub fn index(self) -> usize {
        self as usize
    }
}
