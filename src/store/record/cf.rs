//! Names and units as the Climate and Forecast (CF) conventions have them, which xarray, netCDF and
//! their tools read.

/// The version of the conventions.
pub(super) const CONVENTIONS: &str = "CF-1.11";
/// What is counted is no unit of UDUNITS.
const COUNTED: [&str; 2] = ["spheres", "grains"];
/// Superscript digits and signs, and what they stand for.
const RAISED: [(char, char); 11] = [
    ('⁰', '0'),
    ('¹', '1'),
    ('²', '2'),
    ('³', '3'),
    ('⁴', '4'),
    ('⁵', '5'),
    ('⁶', '6'),
    ('⁷', '7'),
    ('⁸', '8'),
    ('⁹', '9'),
    ('⁻', '-'),
];

/// A unit in ASCII and with exponents for slashes, such as `m s-1` for `m/s`. What is no product of
/// powers, such as `days since 2000-01-01`, stays as it is.
pub(super) fn units(unit: &str) -> String {
    let Some(factors) = factors(unit) else {
        return unit.to_owned();
    };
    let written = |(symbol, exponent): &(String, i32)| match exponent {
        1 => symbol.clone(),
        _ => format!("{symbol}{exponent}"),
    };
    match factors.is_empty() {
        true => "1".to_owned(),
        false => factors.iter().map(written).collect::<Vec<_>>().join(" "),
    }
}

/// Symbols and exponents of a product, without pure numbers; none if it is no product.
fn factors(unit: &str) -> Option<Vec<(String, i32)>> {
    let mut factors = Vec::new();
    // A slash divides by the one factor behind it.
    for (part, product) in unit.split('/').enumerate() {
        let mut words = product.split([' ', '·']).filter(|word| !word.is_empty());
        let first = words.next();
        if part > 0 && (first.is_none() || words.clone().next().is_some()) {
            return None;
        }
        for word in first.into_iter().chain(words) {
            let (symbol, exponent) = power(word)?;
            let sign = if part > 0 { -1 } else { 1 };
            if symbol != "1" && !COUNTED.contains(&symbol.as_str()) {
                factors.push((symbol, sign * exponent));
            }
        }
    }
    Some(factors)
}

/// A symbol and its exponent.
fn power(word: &str) -> Option<(String, i32)> {
    if word == "1" {
        return Some((word.to_owned(), 1));
    }
    let plain = |letter: char| match RAISED.iter().find(|(raised, _)| *raised == letter) {
        Some((_, plain)) => *plain,
        None => letter,
    };
    let end = word.find(|letter: char| !letter.is_alphabetic() && !['%', '°'].contains(&letter));
    let (symbol, exponent) = word.split_at(end.unwrap_or(word.len()));
    let exponent: String = exponent
        .trim_start_matches('^')
        .chars()
        .map(plain)
        .collect();
    let exponent = match exponent.is_empty() {
        true => 1,
        false => exponent.parse().ok()?,
    };
    let symbol = match symbol {
        "" => return None,
        "°" => "degree",
        _ => symbol,
    };
    Some((symbol.to_owned(), exponent))
}

/// A short name for axes of figures: the beginning of a description.
pub(super) fn long_name(description: &str) -> &str {
    let end = [": ", "; ", ". ", " ("].map(|end| description.find(end));
    let end = end.into_iter().flatten().min();
    &description[..end.unwrap_or(description.len())]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_those_of_udunits() {
        for (unit, expected) in [
            ("m", "m"),
            ("1", "1"),
            ("", "1"),
            ("m/s", "m s-1"),
            ("rad/s", "rad s-1"),
            ("1/s", "s-1"),
            ("spheres/s", "s-1"),
            ("m^2/s^2", "m2 s-2"),
            ("kg m²/s", "kg m2 s-1"),
            ("kg·m⁻¹·s⁻²", "kg m-1 s-2"),
            ("kg m^-1 s^-2", "kg m-1 s-2"),
            ("W/m^2/K", "W m-2 K-1"),
            ("%", "%"),
            ("°", "degree"),
            ("days since 2000-01-01", "days since 2000-01-01"),
            ("kg/(m s)", "kg/(m s)"),
            ("m/s kg", "m/s kg"),
        ] {
            assert_eq!(units(unit), expected, "{unit}");
        }
    }

    #[test]
    fn a_name_is_the_beginning_of_a_description() {
        let description = "Height of the highest centre in each radial bin, inner bin first; more";
        let name = "Height of the highest centre in each radial bin, inner bin first";
        assert_eq!(long_name(description), name);
        assert_eq!(long_name("Centres x, y, z"), "Centres x, y, z");
    }
}
