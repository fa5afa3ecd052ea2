//! The keys of a study file.

use crate::document::schema::{Kind, Range, needed, optional};
use crate::scene::schema::{INTEGRATOR, SCENE};
use crate::sweep::schema::AXIS;

/// The keys of a study file.
pub(crate) const STUDY: Kind = Kind::Table(&[
    optional("title", Kind::Text),
    needed("scene", Kind::Either(&[Kind::Text, SCENE])),
    needed("axis", Kind::List(&AXIS)),
    optional("integrators", Kind::List(&INTEGRATOR)),
    optional("frames", Kind::Whole(1)),
    optional("energy_gain", Kind::Number(Range::POSITIVE)),
]);
