//! The normal form prints what was read.

use super::run::{COLUMNS, KEYS, Run, TestNames, parse};
use phase::rule::{Expression, ExpressionError};
use proptest::prelude::*;

/// Any expression, with parentheses around every part, so that its tree is plain.
fn expression() -> impl Strategy<Value = String> {
    let number = (0.0..=f64::MAX).prop_map(|value| format!("{value:e}"));
    let short = (0..2000_u32, -20..20_i32).prop_map(|(digits, place)| format!("{digits}e{place}"));
    let unit = prop::sample::select(vec!["m", " kg m^-1 s^-2 ", "rad/s", "m²/(kg s)", "1"]);
    let with_unit = (short.clone(), unit).prop_map(|(number, unit)| format!("{number} [{unit}]"));
    let names: Vec<&str> = COLUMNS
        .iter()
        .map(|(name, _)| *name)
        .chain(KEYS.iter().map(|(name, _, _)| *name))
        .collect();
    let name = prop::sample::select(names).prop_map(str::to_owned);
    let leaf = prop_oneof![number, short, with_unit, name];
    leaf.prop_recursive(8, 60, 2, |inner| {
        let operator = prop::sample::select(vec![
            "or", "and", "<", "<=", ">", ">=", "==", "!=", "+", "-", "*", "/", "^",
        ]);
        let one = prop::sample::select(vec!["mean", "share", "sqrt", "trend", "-", "not "]);
        let two = prop::sample::select(vec!["lesser", "repeats"]);
        prop_oneof![
            5 => (inner.clone(), operator, inner.clone())
                .prop_map(|(left, operator, right)| format!("({left}){operator}({right})")),
            2 => (one, inner.clone()).prop_map(|(name, inside)| format!("{name}({inside})")),
            1 => (two, inner.clone(), inner)
                .prop_map(|(name, one, other)| format!("{name}({one},{other})")),
        ]
    })
}

/// Words of the language in any order.
fn words() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "x",
        "height_mean",
        "spheres.radius",
        "axis[0]",
        "1",
        ".5",
        "2e3",
        "0.05[m]",
        "[",
        "]",
        "(",
        "(",
        "(",
        ")",
        ")",
        ")",
        "+",
        "-",
        "*",
        "/",
        "^",
        "^2",
        "<",
        ">=",
        "==",
        "!=",
        "and",
        "or",
        "not",
        "mean(",
        "share(",
        "repeats(",
        "lesser(",
        ",",
        "²",
        "é",
        ".",
        "\n",
        "=",
    ]);
    prop::collection::vec(word, 0..30).prop_map(|words| words.join(" "))
}

/// Nothing panics, and errors point into the text.
fn holds_no_surprise(text: &str) {
    let shown = |error: ExpressionError| {
        let span = error.span.clone();
        assert!(
            span.start <= span.end && span.end <= text.len(),
            "{error:?}"
        );
        assert!(text.is_char_boundary(span.start) && text.is_char_boundary(span.end));
        let rendered = error.render(text);
        assert!(!error.message.is_empty() && !error.help.is_empty());
        assert!(rendered.lines().count() == 4, "{rendered}");
    };
    match Expression::parse(text) {
        Err(error) => shown(error),
        Ok(expression) => {
            let printed = expression.to_string();
            assert_eq!(parse(&printed), expression, "{printed}");
            assert_eq!(parse(&printed).to_string(), printed);
            let run = Run::of(&[1.0, -2.0, 0.5]);
            match expression.condition(&TestNames) {
                Err(error) => shown(error),
                Ok(condition) => {
                    let found = condition.evaluate(&run, run.all());
                    assert!(found.margin <= 0.0 || found.margin.is_nan() || found.holds);
                    assert!(found.margin >= 0.0 || found.margin.is_nan() || !found.holds);
                }
            }
            match expression.number(&TestNames) {
                Err(error) => shown(error),
                Ok(number) => {
                    let found = number.evaluate(&run, run.all()).to_bits();
                    assert_eq!(found, number.evaluate(&run, run.all()).to_bits());
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn the_normal_form_has_the_same_tree(text in expression()) {
        match Expression::parse(&text) {
            Ok(_) => holds_no_surprise(&text),
            Err(error) => {
                let is_limit = error.message.contains("more than");
                prop_assert!(is_limit, "{}", error.render(&text));
            }
        }
    }

    #[test]
    fn any_text_is_read_or_refused(text in any::<String>()) {
        holds_no_surprise(&text);
    }

    #[test]
    fn printable_text_is_read_or_refused(text in "\\PC{0,200}") {
        holds_no_surprise(&text);
    }

    #[test]
    fn ascii_text_is_read_or_refused(text in "[ -~]{0,200}") {
        holds_no_surprise(&text);
    }

    #[test]
    fn words_in_any_order_are_read_or_refused(text in words()) {
        holds_no_surprise(&text);
    }
}

#[test]
fn operators_bind_as_documented() {
    let pairs = [
        ("a or b and c", "a or (b and c)"),
        ("a and b or c", "(a and b) or c"),
        ("a or b or c", "(a or b) or c"),
        ("not a and b", "(not a) and b"),
        ("not a == b", "not (a == b)"),
        ("not not a", "not (not a)"),
        ("a < b + c", "a < (b + c)"),
        ("a + b * c", "a + (b * c)"),
        ("a - b - c", "(a - b) - c"),
        ("a / b / c", "(a / b) / c"),
        ("a / b * c", "(a / b) * c"),
        ("-a * b", "(-a) * b"),
        ("a * -b", "a * (-b)"),
        ("-a^2", "-(a^2)"),
        ("a^2^3", "a^(2^3)"),
        ("a^-2^3", "a^(-(2^3))"),
        ("a^-b * c", "(a^(-b)) * c"),
        ("- -a", "-(-a)"),
        ("a - -b", "a - (-b)"),
        (
            "a > b and c < d or e == f",
            "((a > b) and (c < d)) or (e == f)",
        ),
    ];
    for (plain, explicit) in pairs {
        assert_eq!(parse(plain), parse(explicit), "{plain}");
    }
    let different = [
        ("a - (b - c)", "a - b - c"),
        ("(-a)^2", "-a^2"),
        ("(a^2)^3", "a^2^3"),
        ("(not a) == b", "not a == b"),
        ("a < (b < c)", "(a < b) < c"),
        ("0.05[m]", "0.05"),
    ];
    for (one, other) in different {
        assert_ne!(parse(one), parse(other), "{one}");
    }
}

#[test]
fn the_normal_form_is_short() {
    let forms = [
        ("  min( wall_share )>.950  ", "min(wall_share) > 0.95"),
        ("((a+b))*(c)", "(a + b) * c"),
        ("(a*b)+(c)", "a * b + c"),
        ("a-(b-c)", "a - (b - c)"),
        ("(-a)^(2)", "(-a)^2"),
        ("not(a<b)and(c<d)", "not a < b and c < d"),
        ("a and not (b and c)", "a and not (b and c)"),
        ("1E+3 [ kg m^2/s^2 ]", "1000[kg m^2/s^2]"),
        ("1e-9 + 2.5e10", "1e-9 + 2.5e10"),
        ("repeats(x,2*T)", "repeats(x, 2 * T)"),
        ("a\n  or\tb", "a or b"),
        ("spheres.radius[1].share", "spheres.radius[1].share"),
    ];
    for (text, form) in forms {
        assert_eq!(parse(text).to_string(), form);
    }
}
