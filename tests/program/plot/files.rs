//! What the files hold besides the picture, and what is refused.

use super::bench::{OMEGA, RADIUS, axis, nine, of_table, png, sweep, table, verdict};
use phase::classify::{Label, TANK};
use phase::plot::{self, PlotError, PlotErrorKind, Svg};

#[test]
fn metadata_names_program_commit_and_seeds() {
    let (mut sweep, table) = nine();
    sweep.title = Some("Ω < Ω & \"r\"".to_owned());
    let svg = of_table("phase", &sweep, &table).unwrap();
    let text = String::from_utf8(svg.to_svg_bytes()).unwrap();
    let metadata = text.split("metadata>").nth(1).unwrap();
    for line in [
        "Title: Ω &lt; Ω &amp; &quot;r&quot;",
        "Software: phase 9.8.7",
        "Commit: c0ffee123456",
        "Figure: phase",
        "Seeds: 1-3",
    ] {
        assert!(metadata.contains(line), "{line} not in {metadata}");
    }

    let bytes = png(&svg);
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!(info.width, 1800);
    assert!(info.pixel_dims.is_some());
    let chunks: Vec<(&str, &str)> = info
        .uncompressed_latin1_text
        .iter()
        .map(|chunk| (chunk.keyword.as_str(), chunk.text.as_str()))
        .collect();
    for chunk in [
        ("Software", "phase 9.8.7"),
        ("Commit", "c0ffee123456"),
        ("Figure", "phase"),
        ("Seeds", "1-3"),
    ] {
        assert!(chunks.contains(&chunk), "{chunk:?} not in {chunks:?}");
    }
    let title = &info.utf8_text[0];
    assert_eq!(title.keyword, "Title");
    assert_eq!(title.get_text().unwrap(), "Ω < Ω & \"r\"");
}

/// Symptom: the map of a measure could not be drawn. Cause: a figure had its name.
#[test]
fn no_two_figures_have_one_name() {
    let mut names: Vec<&str> = plot::figures().iter().map(|it| it.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn every_figure_can_be_drawn_of_a_table_without_values() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let mut sweep = sweep("", axes, &[1]);
    sweep.title = None;
    let table = table(&sweep, |_, _| Some(verdict(Label::UNSETTLED)));
    let figures = plot::figures();
    assert_eq!(figures[0].name, "phase");
    for figure in figures {
        assert!(!figure.description.is_empty());
        if figure.is_of_sweep()
            && figure.default_runs().is_none()
            && figure.applies_to(&TANK)
            && !["critical-rotation", "net-force", "measures", "refined"].contains(&figure.name)
        {
            of_table(figure.name, &sweep, &table).unwrap();
        }
    }
    // A panel per measure that a run has: of none there is nothing to draw.
    let nothing = of_table("measures", &sweep, &table);
    assert_eq!(nothing.unwrap_err().kind(), PlotErrorKind::Nothing);
}

#[test]
fn png_shows_the_colours_of_the_cells() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let sweep = sweep("Fluid", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::FLUID)));
    let bytes = png(&of_table("phase", &sweep, &table).unwrap());
    let mut decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let share = |color: [u8; 3]| {
        let found = pixels
            .chunks_exact(3)
            .filter(|pixel| **pixel == color)
            .count();
        found as f64 / (pixels.len() / 3) as f64
    };
    let (fluid, white) = (share([0x58, 0xa6, 0xe0]), share([255, 255, 255]));
    assert!(fluid > 0.4, "{fluid}");
    assert!(white > 0.15 && fluid + white > 0.95, "{white}");
}

#[test]
fn refusals_name_what_there_is() {
    let message = |result: Result<Svg, PlotError>| result.unwrap_err().to_string();
    let (sweep, table) = nine();

    let text = message(of_table("phases", &sweep, &table));
    assert!(
        text.starts_with("there is no figure `phases`; the figures are phase, refined, states")
    );

    let mut other = sweep.clone();
    other.plot.x = Some("density".to_owned());
    assert_eq!(
        message(of_table("phase", &other, &table)),
        "[plot] names the axis `density`, but the axes of this sweep are radius, omega"
    );
    other.plot.x = Some("omega".to_owned());
    other.plot.panels = Some("omega".to_owned());
    assert!(message(of_table("phase", &other, &table)).contains("`omega` twice"));

    let mut empty = table.clone();
    empty.rows.clear();
    assert!(message(of_table("phase", &sweep, &empty)).contains("is empty"));

    let mut foreign = table.clone();
    foreign.axes[0] = "density".to_owned();
    assert!(message(of_table("phase", &sweep, &foreign)).contains("density, omega"));

    let mut damaged = table.clone();
    damaged.rows[7].values[1] = f64::NAN;
    assert!(message(of_table("phase", &sweep, &damaged)).contains("run 0000000000000007"));

    let mut bare = sweep.clone();
    bare.axes.clear();
    let mut single = table.clone();
    single.axes.clear();
    single.rows.truncate(1);
    single.rows[0].values.clear();
    assert!(message(of_table("phase", &bare, &single)).contains("no axis"));
}
