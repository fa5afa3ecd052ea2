//! Bad expressions and the messages that they give, in `refused.txt`: what it should be (`when` a
//! condition, `value` a number), the expression, and the message. `BLESS=1` writes the messages.

use super::run::TestNames;
use phase::rule::{Expression, ExpressionError};
use std::path::Path;

/// What stands between cases.
const SEPARATOR: &str = "\n---\n";

fn refused(kind: &str, text: &str) -> String {
    let judge = |expression: Expression| match kind {
        "when" => expression.condition(&TestNames).map(|_| ()),
        "value" => expression.number(&TestNames).map(|_| ()),
        _ => panic!("{kind} is neither `when` nor `value`"),
    };
    let result: Result<(), ExpressionError> = Expression::parse(text).and_then(judge);
    match result {
        Ok(()) => format!("`{text}` is accepted"),
        Err(error) => error.render(text),
    }
}

#[test]
fn bad_expressions_give_their_messages() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/rule/refused.txt");
    let table = std::fs::read_to_string(&path).unwrap();
    let cases: Vec<&str> = table.trim_end().split(SEPARATOR).collect();
    assert!(cases.len() >= 40);
    let found: Vec<String> = cases
        .iter()
        .map(|case| {
            let first = case.lines().next().unwrap_or("");
            let (kind, text) = first.split_once(' ').unwrap_or((first, ""));
            format!("{first}\n{}", refused(kind, text))
        })
        .collect();
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, found.join(SEPARATOR) + "\n").unwrap();
    } else {
        for (case, found) in cases.iter().zip(&found) {
            assert_eq!(case, found);
        }
    }
}

/// Tabs stay, other characters that steer a terminal do not, and one line is shown.
#[test]
fn messages_show_one_printable_line() {
    let shown = |text: &str| Expression::parse(text).unwrap_err().render(text);
    let message = "`$` means nothing here\n";
    assert_eq!(
        shown("1 +\n\t2 $\n+ 3"),
        format!("{message}  \t2 $\n  \t  ^\nremove it")
    );
    let text = "1[m] + größe $ \u{7}";
    assert_eq!(
        shown(text),
        format!("{message}  1[m] + größe $ �\n  {:13}^\nremove it", "")
    );
    let text = "1 + \u{1b}[31m";
    let message = "`\\u{1b}` means nothing here\n";
    assert_eq!(
        shown(text),
        format!("{message}  1 + �[31m\n      ^\nremove it")
    );
    let error = Expression::parse("1 +").unwrap_err();
    assert_eq!(error.render("é").lines().nth(2), Some("   ^"));
}
