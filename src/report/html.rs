//! The file of a page.

use super::PageDocument;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

const TEMPLATE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");

/// The scripts in the order in which they build on one another.
const SCRIPTS: [&str; 34] = [
    include_str!("page/namespace.js"),
    include_str!("page/dom.js"),
    include_str!("page/markup.js"),
    include_str!("page/numbers.js"),
    include_str!("page/colors.js"),
    include_str!("page/scales.js"),
    include_str!("page/chart.js"),
    include_str!("page/packed.js"),
    include_str!("page/data.js"),
    include_str!("page/rules.js"),
    include_str!("page/scene.js"),
    include_str!("page/store.js"),
    include_str!("page/address.js"),
    include_str!("page/tooltip.js"),
    include_str!("page/patterns.js"),
    include_str!("page/looks.js"),
    include_str!("page/map.js"),
    include_str!("page/legend.js"),
    include_str!("page/hover.js"),
    include_str!("page/keyboard.js"),
    include_str!("page/controls.js"),
    include_str!("page/series.js"),
    include_str!("page/spheres.js"),
    include_str!("page/details.js"),
    include_str!("page/why.js"),
    include_str!("page/overview.js"),
    include_str!("page/thresholds.js"),
    include_str!("page/measures.js"),
    include_str!("page/table.js"),
    include_str!("page/download.js"),
    include_str!("page/sweep.js"),
    include_str!("page/records.js"),
    include_str!("page/studies.js"),
    include_str!("page/main.js"),
];

/// The page of a document.
///
/// # Errors
/// If the document has a number that JSON does not have.
pub fn html(document: &PageDocument) -> Result<String, serde_json::Error> {
    let (style, script) = (without_margins(STYLE), without_margins(&SCRIPTS.concat()));
    let places = [
        ("title", text_of_element(&document.title)),
        ("style-hash", digest(&style)),
        ("script-hash", digest(&script)),
        ("style", style),
        ("data", data(document)?),
        ("script", script),
    ];
    // All places are filled at once, so that what is put in is not looked at.
    let mut page = String::new();
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, behind) = after.split_once("}}").unwrap_or((after, ""));
        let found = places.iter().find(|(place, _)| *place == name);
        page += before;
        page += found.map_or("", |(_, text)| text);
        rest = behind;
    }
    page += rest;
    Ok(page)
}

/// JSON that ends no element of the page.
fn data(document: &PageDocument) -> Result<String, serde_json::Error> {
    let json = serde_json::to_string(document)?;
    let json = json.replace('<', "\\u003c");
    Ok(json
        .replace('\u{2028}', "\\u2028")
        .replace('\u{2029}', "\\u2029"))
}

/// Text of an element.
fn text_of_element(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

/// How the Content-Security-Policy names the text of an element.
fn digest(text: &str) -> String {
    format!(
        "sha256-{}",
        STANDARD.encode(Sha256::digest(text.as_bytes()))
    )
}

/// A text without the spaces at the ends of its lines, and without comments that fill lines, which
/// begin with `/**` or, in styles, `/*`.
fn without_margins(text: &str) -> String {
    let mut kept = String::from("\n");
    let mut is_comment = false;
    for line in text.lines().map(str::trim) {
        is_comment |= line.starts_with("/*");
        if !is_comment && !line.is_empty() {
            kept += line;
            kept.push('\n');
        }
        is_comment &= !line.ends_with("*/");
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_that_fill_lines_are_left_out() {
        let text = "/** What\n * this is. */\nconst a = 1; /* stays */\n\n  b();\n/* one */\n";
        let kept = "\nconst a = 1; /* stays */\nb();\n";
        assert_eq!(without_margins(text), kept);
    }

    #[test]
    fn texts_end_no_element() {
        let title = "</script><b>&{{data}}\u{2028}";
        let document = PageDocument::new(title.to_owned(), Vec::new(), Vec::new());
        let page = html(&document).unwrap();
        assert!(page.contains("<title>&lt;/script&gt;&lt;b&gt;&amp;{{data}}\u{2028}</title>"));
        assert!(page.contains("\\u003c/script>\\u003cb>&{{data}}\\u2028"));
        assert_eq!(page.matches("</script>").count(), 2);
    }
}
