//! The keys of a sweep file: which there are, which must be there, and what each may hold.

use crate::document::schema::{Kind, Range, needed, optional};
use crate::scene::schema::SCENE;

const NUMBER: Kind = Kind::Number(Range::ANY);
const POSITIVE: Kind = Kind::Number(Range::POSITIVE);
const NOT_NEGATIVE: Kind = Kind::Number(Range::NOT_NEGATIVE);
const FRACTION: Kind = Kind::Number(Range::FRACTION);
const WHOLE: Kind = Kind::Whole(0);

/// The keys of a sweep file.
pub(crate) const SWEEP: Kind = Kind::Table(&[
    optional("title", Kind::Text),
    needed("scene", Kind::Either(&[Kind::Text, SCENE])),
    optional("axis", Kind::List(&AXIS)),
    optional("seeds", SEEDS),
    optional("sieves", SIEVES),
    optional("plot", PLOT),
]);

/// The keys of an axis.
pub(crate) const AXIS: Kind = Kind::Table(&[
    needed("key", Kind::Text),
    optional("name", Kind::Text),
    optional("values", Kind::List(&NUMBER)),
    optional("from", NUMBER),
    optional("to", NUMBER),
    optional("step", POSITIVE),
    optional("count", Kind::Whole(2)),
    optional("spacing", Kind::Choice(&["linear", "log"])),
]);

const SEEDS: Kind = Kind::Table(&[
    optional("first", WHOLE),
    optional("count", Kind::Whole(1)),
    optional("list", Kind::List(&WHOLE)),
]);

const SIEVES: Kind = Kind::Table(&[
    optional(
        "settle",
        Kind::Table(&[
            optional("window", POSITIVE),
            optional("height", NUMBER),
            optional("tolerance", POSITIVE),
        ]),
    ),
    optional(
        "fluid",
        Kind::Table(&[
            optional("window", POSITIVE),
            optional("rise", NUMBER),
            optional("failures", WHOLE),
            optional("share", FRACTION),
        ]),
    ),
    optional(
        "pinned",
        Kind::Table(&[
            optional("window", POSITIVE),
            optional("hole", NOT_NEGATIVE),
            optional("share", FRACTION),
        ]),
    ),
    optional(
        "spout",
        Kind::Table(&[
            optional("window", POSITIVE),
            optional("rise_speed", NUMBER),
            optional("radius", POSITIVE),
            optional("least", WHOLE),
            optional("small", FRACTION),
            optional("large", FRACTION),
        ]),
    ),
    optional("emptied", Kind::Table(&[optional("share", FRACTION)])),
    optional("arching", Kind::Table(&[optional("window", POSITIVE)])),
    optional(
        "flowing",
        Kind::Table(&[
            optional("window", POSITIVE),
            optional("least", Kind::Whole(1)),
        ]),
    ),
]);

const PLOT: Kind = Kind::Table(&[
    optional("x", Kind::Text),
    optional("y", Kind::Text),
    optional("panels", Kind::Text),
]);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::Sieves;
    use crate::document::schema::differences;
    use crate::sweep::PlotSettings;
    use serde_json::json;

    #[test]
    fn the_description_has_the_keys_of_the_structs() {
        let sieves = serde_json::to_value(Sieves::default()).unwrap();
        assert_eq!(
            differences::<Sieves>(&SIEVES, &sieves),
            Vec::<String>::new()
        );
        assert_eq!(
            differences::<PlotSettings>(&PLOT, &json!({})),
            Vec::<String>::new()
        );
    }
}
