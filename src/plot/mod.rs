//! Figures: one file each.
