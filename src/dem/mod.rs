//! The discrete element engine.
