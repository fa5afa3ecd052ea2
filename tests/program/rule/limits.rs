//! Long and deep texts.

use super::run::TestNames;
use phase::rule::Expression;
use std::thread;

fn message(text: &str) -> String {
    match Expression::parse(text) {
        Ok(_) => "fine".to_owned(),
        Err(error) => {
            assert!(error.render(text).len() < 1000);
            error.message
        }
    }
}

#[test]
fn texts_have_at_most_2000_bytes() {
    let text = |bytes: usize| format!("{}1", " ".repeat(bytes - 1));
    assert_eq!(message(&text(2000)), "fine");
    let too_long = "the expression has more than 2000 bytes";
    assert_eq!(message(&text(2001)), too_long);
    assert_eq!(message(&"é".repeat(1_000_000)), too_long);
    // 1500 bytes whose normal form has spaces around 500 operators.
    let sum = |terms: usize| vec!["1"; terms].join("+");
    let sums = vec![format!("({})", sum(15)); 50].join("-");
    assert!(sums.len() < 2000);
    assert_eq!(
        message(&sums),
        "the normal form of the expression has more than 2000 bytes"
    );
}

#[test]
fn trees_have_at_most_64_levels() {
    let too_deep = "the expression is more than 64 levels deep";
    type Nest = fn(usize) -> String;
    let nests: [(Nest, usize); 8] = [
        (
            |depth| format!("{}1{}", "(".repeat(depth), ")".repeat(depth)),
            64,
        ),
        (|depth| format!("{}1", "-".repeat(depth)), 63),
        (|depth| format!("{}a", "not ".repeat(depth)), 63),
        (|depth| format!("1{}", "^1".repeat(depth)), 63),
        (|depth| format!("1{}", "+1".repeat(depth)), 63),
        (|depth| format!("a{}", " or a".repeat(depth)), 63),
        (
            |depth| format!("{}1{}", "abs(".repeat(depth), ")".repeat(depth)),
            63,
        ),
        (
            |depth| format!("{}1{}", "1-(".repeat(depth), ")".repeat(depth)),
            63,
        ),
    ];
    for (nest, deepest) in nests {
        assert_eq!(message(&nest(deepest)), "fine", "{}", nest(3));
        assert_eq!(message(&nest(deepest + 1)), too_deep, "{}", nest(3));
        assert_eq!(message(&nest(300)), too_deep, "{}", nest(3));
    }
    // Parentheses beside each other are not deep.
    let wide = vec!["abs((-1)^2)"; 60].join("+");
    assert_eq!(message(&format!("({wide})-({wide})")), "fine");
    assert_eq!(message(&"(".repeat(2000)), too_deep);
    assert_eq!(message(&"mean(".repeat(400)), too_deep);
}

/// The longest ways through the parser fit into a small stack.
#[test]
fn the_deepest_trees_need_little_stack() {
    let every_level = "a or a and not a<1+1*-1^(".repeat(31) + "1" + &")".repeat(31);
    let shallow = "a or a and a<1+1*1^(".repeat(31) + "1" + &")".repeat(31);
    let open = "a or a and a<1+1*(".repeat(110);
    let sum = vec!["1"; 64].join("+");
    let calls = format!("{}x{}", "abs(".repeat(63), ")".repeat(63));
    let right = format!("{}x{}", "1-(".repeat(63), ")".repeat(63));
    let signs = format!("{}x{}", "-((".repeat(32), "))".repeat(32));
    let texts = [every_level, shallow, open, sum, calls, right, signs];
    let judge = move || {
        for text in &texts {
            if let Ok(expression) = Expression::parse(text) {
                let copy = expression.clone();
                assert_eq!(copy.to_string().parse(), Ok(expression));
                let _ = copy.condition(&TestNames);
                let _ = copy.number(&TestNames);
            }
        }
    };
    let small = thread::Builder::new().stack_size(512 * 1024);
    small.spawn(judge).unwrap().join().unwrap();
}
