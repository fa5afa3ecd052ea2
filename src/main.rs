//! The `phase` program: parse and dispatch, nothing else.

fn main() {}
