//! Run records: what is written is what is read, damage is noticed, others can read them too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod damage;
mod examples;
mod interchange;
mod round_trip;
