//! The table of symbols.

use crate::document::KeyQuantity;
use crate::scene::SCENE;

const INTRODUCTION: &str = "\
# Notation

Symbol, unit and name of every numeric key of a scene, as figures write them. This page is made by
`phase generate reference notation`.

| symbol | quantity and unit | key |
|---|---|---|
";

/// The table of symbols, in Markdown.
pub fn notation() -> String {
    // Several laws may have keys with the same name but different units.
    let mut rows: Vec<(String, &KeyQuantity, Vec<&str>)> = Vec::new();
    SCENE.kind.visit("", &mut |path, key| {
        let Some(quantity) = key.quantity.as_ref().filter(|it| !it.symbol.is_empty()) else {
            return;
        };
        let known = rows.iter().position(|(known, ..)| known == path);
        let row = known.unwrap_or_else(|| {
            rows.push((path.to_owned(), quantity, Vec::new()));
            rows.len() - 1
        });
        let units = &mut rows[row].2;
        let new: Vec<&str> = quantity
            .units()
            // The unit of a pure number is empty.
            .filter(|unit| !unit.is_empty() && !units.contains(unit))
            .collect();
        units.extend(new);
    });
    let row = |(path, quantity, units): &(String, &KeyQuantity, Vec<&str>)| {
        let symbol = subscripts(&quantity.symbol);
        // The bars of an absolute value would end a cell.
        let name = quantity.name.replace('|', "\\|");
        let unit = match units.as_slice() {
            [] => String::new(),
            units => format!(" ({})", units.join(", ")),
        };
        format!("| {symbol} | {name}{unit} | `{path}` |\n")
    };
    INTRODUCTION.to_owned() + &rows.iter().map(row).collect::<String>()
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
