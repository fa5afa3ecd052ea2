//! Run records: what is written is what is read, damage is noticed, others can read them too.

mod axes;
mod damage;
mod examples;
mod interchange;
mod round_trip;
