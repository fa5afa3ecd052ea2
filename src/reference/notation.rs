//! The table of symbols.

use crate::notation::{Notation, SCENE_KEYS};

const INTRODUCTION: &str = "\
# Notation

Symbol, unit and name of every numeric key of a scene, as figures write them. This page is made by
`phase reference notation`.

| symbol | quantity | unit | key |
|---|---|---|---|
";

/// The table of symbols, in Markdown.
pub fn notation() -> String {
    let row = |notation: &Notation| {
        let symbol = subscripts(notation.symbol);
        // The bars of an absolute value would end a cell.
        let name = notation.name.replace('|', "\\|");
        let unit = notation.units().join(", ");
        format!("| {symbol} | {name} | {unit} | `{}` |\n", notation.key)
    };
    INTRODUCTION.to_owned() + &SCENE_KEYS.iter().map(row).collect::<String>()
}

/// A symbol whose `_` are subscripts in HTML: `z_{max}` becomes `z<sub>max</sub>`.
fn subscripts(symbol: &str) -> String {
    let mut text = String::new();
    let mut rest = symbol.chars();
    while let Some(character) = rest.next() {
        if character != '_' {
            text.push(character);
            continue;
        }
        let subscript: String = match rest.next() {
            Some('{') => rest.by_ref().take_while(|&next| next != '}').collect(),
            Some(next) => next.to_string(),
            None => String::new(),
        };
        text += &format!("<sub>{subscript}</sub>");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn underscores_become_subscripts() {
        for (symbol, text) in [
            ("Ω", "Ω"),
            ("M_1", "M<sub>1</sub>"),
            ("Δx_{max} / r", "Δx<sub>max</sub> / r"),
        ] {
            assert_eq!(subscripts(symbol), text);
        }
    }
}
