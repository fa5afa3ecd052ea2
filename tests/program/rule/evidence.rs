//! Conditions: whether they hold, and how clearly.

use super::run::{Run, condition};
use phase::rule::Evidence;
use proptest::prelude::*;

/// The evidence of a comparison of two numbers.
fn of(left: f64, order: &str, right: f64) -> Evidence {
    let run = Run::at(vec![left, right], &[left, right]);
    run.evidence(&format!("first(time) {order} last(time)"))
}

#[test]
fn a_comparison_shows_its_numbers() {
    let mut run = Run::of(&[1.0]);
    run.columns.insert("height_mean", vec![0.06]);
    let found = run.evidence("min(height_mean)>0.05 and max(x) <=  4.0 / (2)");
    assert!(found.holds);
    let [height, x] = found.comparisons.as_slice() else {
        panic!("{found:?}");
    };
    assert_eq!(height.text, "min(height_mean) > 0.05");
    assert_eq!((height.value, height.threshold), (0.06, 0.05));
    assert_eq!(height.margin, 0.06 - 0.05);
    assert_eq!(height.unit.to_string(), "m");
    assert_eq!(x.text, "max(x) <= 4 / 2");
    assert_eq!((x.value, x.threshold, x.margin), (1.0, 2.0, 1.0));
    assert_eq!((x.relative_margin, x.unit.to_string().as_str()), (0.5, "1"));
    assert_eq!(found.margin, height.relative_margin);
    assert!((found.margin - 1.0 / 6.0).abs() < 1e-15);
}

#[test]
fn margins_follow_the_operators() {
    let run = Run::of(&[1.0]);
    let margin = |text: &str| run.evidence(text).margin;
    assert_eq!(margin("max(x) > 0.5"), 0.5);
    assert_eq!(margin("max(x) < 0.5"), -0.5);
    assert_eq!(margin("not max(x) < 0.5"), 0.5);
    assert_eq!(margin("max(x) == 0.5"), -0.5);
    assert_eq!(margin("max(x) != 0.5"), 0.5);
    assert_eq!(margin("max(x) == 1"), 0.0);
    assert_eq!(margin("max(x) > 0.5 and max(x) > 0.75"), 0.25);
    assert_eq!(margin("max(x) > 0.5 or max(x) > 0.75"), 0.5);
    assert_eq!(
        margin("max(x) > 0.5 and (max(x) < 0.75 or max(x) < 2)"),
        0.5
    );
    assert_eq!(margin("0 >= 0"), 0.0);
    assert_eq!(margin("-1 < 1"), 2.0);
}

#[test]
fn what_is_not_a_number_decides_nothing() {
    let run = Run::of(&[f64::NAN]);
    for order in ["<", "<=", ">", ">=", "==", "!="] {
        let found = run.evidence(&format!("mean(x) {order} 1"));
        assert!(!found.holds && found.margin.is_nan(), "{order}");
        let [comparison] = found.comparisons.as_slice() else {
            panic!("{found:?}");
        };
        assert!(!comparison.is_defined() && !comparison.holds);
        assert!(comparison.value.is_nan() && comparison.margin.is_nan());
        assert!(comparison.relative_margin.is_nan());
    }
    let found = run.evidence("mean(x) > 1 or 2 > 1");
    assert!(found.holds && found.margin == 0.5 && found.comparisons.len() == 2);
    let found = run.evidence("mean(x) > 1 and 2 > 1");
    assert!(!found.holds && found.margin.is_nan());
    let found = run.evidence("not mean(x) > 1");
    assert!(found.holds && found.margin.is_nan());
    let found = run.evidence("not mean(x) > 1 and 2 > 1");
    assert!(found.holds && found.margin == 0.5);
}

#[test]
fn extremes_have_margins() {
    let greatest = f64::MAX;
    assert_eq!(of(greatest, ">", -greatest).margin, 2.0);
    assert_eq!(of(-greatest, ">", greatest).margin, -2.0);
    let run = Run::of(&[1.0]);
    assert_eq!(run.evidence("1 / 0 > 3").margin, 1.0);
    assert_eq!(run.evidence("1 / 0 > -1 / 0").margin, 2.0);
    assert_eq!(run.evidence("1 / 0 >= 1 / 0").margin, 0.0);
    assert_eq!(run.evidence("1 / 0 >= 1 / 0").comparisons[0].margin, 0.0);
}

#[test]
fn conditions_name_what_they_need() {
    let condition = condition(
        "share(time > 1 and x > spheres.count) > 0.5 or \
         max(height_mean) > spheres.radius and max(x) > kinds[1].share",
    );
    assert_eq!(condition.columns(), ["height_mean", "time", "x"]);
    assert_eq!(
        condition.keys(),
        ["kinds[1].share", "spheres.count", "spheres.radius"]
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]
    /// The sign of a margin says whether the comparison holds; only the border itself is 0.
    #[test]
    fn signs_of_margins_agree(
        left in any::<f64>(),
        right in any::<f64>(),
        steps in -2..3_i32,
        close in any::<bool>(),
    ) {
        let near = f64::from_bits(left.to_bits().wrapping_add_signed(i64::from(steps)));
        let right = if close { near } else { right };
        // A step below zero is not a number.
        let right = if right.is_nan() { left } else { right };
        for (order, on_border) in
            [("<", false), ("<=", true), (">", false), (">=", true), ("==", true), ("!=", false)]
        {
            let found = of(left, order, right);
            for margin in [found.margin, found.comparisons[0].margin] {
                let says = if on_border { margin >= 0.0 } else { margin > 0.0 };
                prop_assert_eq!(found.holds, says, "{} {} {}: {}", left, order, right, margin);
            }
            prop_assert!(found.margin.abs() <= 2.0);
        }
    }
}
