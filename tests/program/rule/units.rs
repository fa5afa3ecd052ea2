//! Units: their text, and expressions whose units fit or do not.

use super::run::{TestNames, number, parse, unit_of};
use phase::rule::Unit;
use proptest::prelude::*;

#[test]
fn units_print_as_one_writes_them() {
    let forms = [
        ("", "1"),
        ("1", "1"),
        ("rad", "rad"),
        ("rad/s", "rad/s"),
        ("rad m", "m"),
        ("rad^2/s", "1/s"),
        ("Hz", "1/s"),
        ("1/s", "1/s"),
        ("m/s²", "m/s^2"),
        ("m s⁻²", "m/s^2"),
        ("m/s/s", "m/s^2"),
        ("kg m^2/s^2", "J"),
        ("N m", "J"),
        ("J/s", "W"),
        ("kg m^-1 s^-2", "Pa"),
        ("N/m", "kg/s^2"),
        ("N s/m", "kg/s"),
        ("kg/(m² s)", "kg m^-2 s^-1"),
        ("1/(m s)", "m^-1 s^-1"),
        ("Pa·s", "kg m^-1 s^-1"),
        ("m^0.5", "m^0.5"),
        ("kg/m³", "kg/m^3"),
    ];
    for (text, form) in forms {
        let unit = unit_of(text);
        assert_eq!(unit.to_string(), form, "{text}");
        assert_eq!(unit_of(form), unit, "{form}");
    }
}

#[test]
fn texts_that_are_no_units_are_refused() {
    let texts = [
        "mm", "km", "g", "deg", "°", "2", "m^", "m^x", "m^1.03", "m^1000", "m^--2", "m/", "/s",
        "m/(s", "m)", "m//s", "(m)", "m/s kg", "m^2 3", "m⁻", "µm", "10",
    ];
    for text in texts {
        assert!(Unit::parse(text).is_err(), "{text}");
    }
}

#[test]
fn bare_numbers_take_the_unit_of_their_place() {
    let fine = [
        ("max(height_mean) + 0.05", "m"),
        ("0.05 + max(height_mean)", "m"),
        ("2 * 0.05 - max(height_mean)", "m"),
        ("lesser(1, spheres.radius)", "m"),
        ("2 * spheres.radius", "m"),
        ("1 / spheres.radius", "1/m"),
        ("sqrt(spheres.radius)", "m^0.5"),
        ("spheres.radius^-1.5", "1/m^1.5"),
        ("sqrt(gravity.acceleration * spheres.radius)", "m/s"),
        ("trend(height_mean)", "m/s"),
        ("trend(x)", "1/s"),
        ("trend(1)", "1/s"),
        ("share(height_mean > 0.05)", "1"),
        ("repeats(height_mean, 6.28 / swirl.omega)", "1"),
        ("deviation(rotation)", "rad/s"),
        ("max(rotation) * spheres.radius - max(speed_mean)", "m/s"),
        ("sin(swirl.omega * last(time))", "1"),
        ("sin(1)", "1"),
        ("max(kinetic) / (spheres.radius * 1[N])", "1"),
        ("3", "1"),
        ("spheres.count", "1"),
        ("mean(kinetic) + 0.5 * 1[kg] * mean(speed_mean)^2", "J"),
    ];
    for (text, unit) in fine {
        assert_eq!(number(text).unit(), unit_of(unit), "{text}");
        assert_eq!(number(text).unit().to_string(), unit, "{text}");
    }
}

#[test]
fn units_that_do_not_fit_are_refused() {
    let texts = [
        "max(height_mean) + last(time)",
        "max(height_mean) + spheres.count",
        "spheres.radius - 2 * spheres.count",
        "1[m] + 1[s]",
        "sin(spheres.radius)",
        "spheres.radius + sin(1)",
        "spheres.radius + share(x > 1)",
        "greater(spheres.radius, 1[1])",
        "repeats(x, swirl.omega)",
        "repeats(x, 1[m])",
        "share(height_mean > time)",
        "mean(height_mean + time)",
        "sqrt(sqrt(sqrt(sqrt(sqrt(spheres.radius)))))",
        "((spheres.radius^100)^100)^100",
    ];
    for text in texts {
        assert!(parse(text).number(&TestNames).is_err(), "{text}");
    }
}

/// Choices that make a random expression.
struct Choices<'a>(std::slice::Iter<'a, u8>);

impl Choices<'_> {
    fn below(&mut self, count: usize) -> usize {
        self.0.next().map_or(0, |choice| *choice as usize % count)
    }
}

/// Powers of m and s.
type Powers = [i32; 2];

/// A number per frame of that unit.
fn tree(powers: Powers, depth: usize, choices: &mut Choices<'_>) -> String {
    let [metre, second] = powers;
    let text = |powers, choices: &mut Choices<'_>| tree(powers, depth - 1, choices);
    let others = [[1, 0], [0, 1], [1, -1], [-1, 2], [0, 0]];
    let kind = if depth == 0 { 0 } else { choices.below(8) };
    match kind {
        0 => match (powers, choices.below(2)) {
            ([1, 0], 0) => "height_mean".to_owned(),
            ([1, -1], 0) => "speed_mean".to_owned(),
            ([0, 1], 0) => "time".to_owned(),
            ([0, -1], 0) => "rotation".to_owned(),
            ([0, 0], 0) => "wall_share".to_owned(),
            ([1, -2], 0) => "gravity.acceleration".to_owned(),
            _ => format!("2.5[m^{metre} s^{second}]"),
        },
        1 => format!("({} + {})", text(powers, choices), text(powers, choices)),
        2 => format!("({} - -{})", text(powers, choices), text(powers, choices)),
        3 => {
            let [m, s] = others[choices.below(others.len())];
            format!(
                "{} * {}",
                text([metre - m, second - s], choices),
                text([m, s], choices)
            )
        }
        4 => {
            let [m, s] = others[choices.below(others.len())];
            format!(
                "{} / ({})",
                text([metre + m, second + s], choices),
                text([m, s], choices)
            )
        }
        5 if metre % 2 == 0 && second % 2 == 0 => {
            format!("({})^2", text([metre / 2, second / 2], choices))
        }
        5 => format!("sqrt({})", text([2 * metre, 2 * second], choices)),
        6 => format!("lesser({}, 3)", text(powers, choices)),
        _ => format!("abs(7 * {})", text(powers, choices)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn random_trees_of_consistent_units_pass(
        bytes in prop::collection::vec(any::<u8>(), 40),
        powers in [-3..4_i32, -3..4_i32],
        other in [-3..4_i32, -3..4_i32],
    ) {
        let mut choices = Choices(bytes.iter());
        let frames = tree(powers, 4, &mut choices);
        prop_assume!(frames.len() < 600);
        let reduced = format!("mean({frames})");
        let [metre, second] = powers;
        let unit = unit_of(&format!("m^{metre} s^{second}"));
        prop_assert_eq!(number(&reduced).unit(), unit);
        let [metre, second] = other;
        let other = unit_of(&format!("m^{metre} s^{second}"));
        let compared = parse(&format!("{reduced} < 1[m^{metre} s^{second}]"));
        prop_assert_eq!(compared.condition(&TestNames).is_ok(), unit == other);
        let added = parse(&format!("{reduced} + 1[m^{metre} s^{second}]"));
        prop_assert_eq!(added.number(&TestNames).is_ok(), unit == other);
        let bare = parse(&format!("{reduced} > 3 and 2 / 3 < {reduced}"));
        prop_assert!(bare.condition(&TestNames).is_ok());
    }

    #[test]
    fn any_text_is_a_unit_or_not(text in "[ -~²³⁻·µé]{0,20}") {
        if let Ok(unit) = Unit::parse(&text) {
            prop_assert_eq!(unit_of(&unit.to_string()), unit);
        }
    }
}
