//! Measures a simulation at a frame.

/// Measures a simulation at every frame.
pub struct Observer;
