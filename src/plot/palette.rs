//! Colours: of states, and of continuous quantities.
//!
//! The tests hold the colours of the labels of a family to differ for every kind of colour
//! blindness and in grey print.

use crate::classify::Label;
use crate::color::{self, ColorMap};
use plotters::style::RGBColor;

/// Colour of a state.
pub(super) fn state(label: Label) -> RGBColor {
    color(label.color)
}

/// Colours of lines, up to four in a panel, from dark to light.
pub(super) const LINES: [RGBColor; 4] = [
    rgb(0x3a_14_57),
    rgb(0xb0_3a_2e),
    rgb(0x2a_86_c8),
    rgb(0xe8_a8_2c),
];

/// Colours of many lines or spheres, in turn.
pub(super) const DISTINCT: [RGBColor; 6] = {
    let [a, b, c, d, e, f] = color::DISTINCT;
    [rgb(a), rgb(b), rgb(c), rgb(d), rgb(e), rgb(f)]
};

/// Lines that help the eye.
pub(super) const GUIDE: RGBColor = RGBColor(0xb4, 0xb4, 0xb4);

/// Ground of cells without a value; their hatch is [`HATCH`].
pub(super) const EMPTY: RGBColor = RGBColor(0xf4, 0xf4, 0xf4);

/// Lines over cells without a value.
pub(super) const HATCH: RGBColor = RGBColor(0xa8, 0xa8, 0xa8);

/// Share of white in a cell on which no seed agrees.
const LARGEST_FADE: f64 = 0.85;

/// A colour as pale as the seeds disagree; `agreement` is the share of the seeds in the majority.
pub(super) fn faded(color: RGBColor, agreement: f64) -> RGBColor {
    lightened(color, LARGEST_FADE * (1.0 - agreement))
}

/// A colour with that share of white.
pub(super) fn lightened(RGBColor(red, green, blue): RGBColor, share: f64) -> RGBColor {
    color(color::mix([red, green, blue], [255; 3], share))
}

/// Colour at `fraction` of a map, 0 to 1.
pub(super) fn mapped(map: ColorMap, fraction: f64) -> RGBColor {
    color(map.at(fraction))
}

const fn rgb(hex: u32) -> RGBColor {
    color(color::rgb(hex))
}

const fn color([red, green, blue]: [u8; 3]) -> RGBColor {
    RGBColor(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{FAMILIES, NUMERICS, TANK};

    type Matrix = [[f64; 3]; 3];

    /// Dichromats in linear RGB: Machado, Oliveira and Fernandes (2009), severity 1.
    const VISIONS: [(&str, Matrix); 4] = [
        ("full", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "protanopia",
            [
                [0.152286, 1.052583, -0.204868],
                [0.114503, 0.786281, 0.099216],
                [-0.003882, -0.048116, 1.051998],
            ],
        ),
        (
            "deuteranopia",
            [
                [0.367322, 0.860646, -0.227968],
                [0.280085, 0.672501, 0.047413],
                [-0.011820, 0.042940, 0.968881],
            ],
        ),
        (
            "tritanopia",
            [
                [1.255528, -0.076749, -0.178779],
                [-0.078411, 0.930809, 0.147602],
                [0.004733, 0.691367, 0.303900],
            ],
        ),
    ];

    /// Least distance of two states in CIELAB, for every vision; 2 is just noticeable.
    const LEAST_DISTANCE: f64 = 18.0;

    /// Least step of the grey lightness L* from state to state; the full range is 100.
    const LEAST_STEP: f64 = 10.0;

    fn apply(matrix: &Matrix, vector: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(vector).map(|(a, b)| a * b).sum())
    }

    fn linear(color: RGBColor) -> [f64; 3] {
        [color.0, color.1, color.2].map(|channel| {
            let value = f64::from(channel) / 255.0;
            if value <= 0.04045 {
                value / 12.92
            } else {
                libm::pow((value + 0.055) / 1.055, 2.4)
            }
        })
    }

    fn lab(color: RGBColor, vision: &Matrix) -> [f64; 3] {
        let seen = apply(vision, linear(color)).map(|channel| channel.clamp(0.0, 1.0));
        let xyz = apply(
            &[
                [0.4124, 0.3576, 0.1805],
                [0.2126, 0.7152, 0.0722],
                [0.0193, 0.1192, 0.9505],
            ],
            seen,
        );
        let response = |ratio: f64| {
            if ratio > 0.008856 {
                libm::cbrt(ratio)
            } else {
                7.787 * ratio + 16.0 / 116.0
            }
        };
        let [x, y, z] = [xyz[0] / 0.95047, xyz[1], xyz[2] / 1.08883].map(response);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    fn lightness(color: RGBColor) -> f64 {
        lab(color, &VISIONS[0].1)[0]
    }

    /// All pairs of states that one diagram may show.
    fn pairs() -> Vec<(Label, Label)> {
        let families = FAMILIES.into_iter().map(|family| family.labels());
        let of_family = |labels: Vec<Label>| {
            let pairs = labels.iter().enumerate().flat_map(|(index, one)| {
                let others = labels[index + 1..].iter();
                others.map(|other| (*one, *other))
            });
            pairs.collect::<Vec<_>>()
        };
        families.flat_map(of_family).collect()
    }

    fn apart_for_every_vision(one: RGBColor, other: RGBColor) {
        for (name, vision) in &VISIONS {
            let (a, b) = (lab(one, vision), lab(other, vision));
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
            let distance = square.sqrt();
            assert!(
                distance >= LEAST_DISTANCE,
                "{name}: {one:?} and {other:?} are {distance:.1} apart"
            );
        }
    }

    #[test]
    fn states_stay_apart_for_every_vision() {
        for (one, other) in pairs() {
            apart_for_every_vision(state(one), state(other));
        }
    }

    #[test]
    fn states_of_a_family_stay_apart_in_grey() {
        for family in FAMILIES {
            let mut shades: Vec<f64> = family
                .labels()
                .into_iter()
                .map(|it| lightness(state(it)))
                .collect();
            shades.sort_by(f64::total_cmp);
            let steps = shades.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(
                steps.fold(f64::INFINITY, f64::min) >= LEAST_STEP,
                "{family:?}: {shades:?}"
            );
        }
    }

    #[test]
    fn states_of_a_tank_get_darker_in_order() {
        let labels = TANK.labels().into_iter().skip(1);
        let shades = labels.map(|label| -lightness(state(label)));
        assert!(shades.is_sorted());
    }

    #[test]
    fn numerical_labels_and_lines_stay_apart_for_every_vision_and_in_grey() {
        let numerical = NUMERICS.labels().into_iter().rev();
        let numerical: Vec<RGBColor> = numerical.map(state).collect();
        for colors in [&LINES[..], &numerical] {
            for pair in colors.windows(2) {
                apart_for_every_vision(pair[0], pair[1]);
                let step = lightness(pair[1]) - lightness(pair[0]);
                assert!(step >= LEAST_STEP, "{pair:?}: {step:.1}");
            }
        }
    }

    #[test]
    fn states_differ_from_empty_cells_and_paper() {
        let step = lightness(EMPTY) - lightness(state(Label::UNSETTLED));
        assert!(step > 4.0, "{step:.1}");
    }

    #[test]
    fn fading_is_towards_white_by_disagreement() {
        let color = state(Label::PINNED);
        assert_eq!(faded(color, 1.0), color);
        let shades: Vec<f64> = [1.0, 2.0 / 3.0, 1.0 / 3.0]
            .map(|agreement| lightness(faded(color, agreement)))
            .to_vec();
        assert!(
            shades.windows(2).all(|pair| pair[1] - pair[0] > 8.0),
            "{shades:?}"
        );
        assert!(lightness(faded(state(Label::LARGE_SPOUT), 0.1)) < 99.0);
    }

    #[test]
    fn sequential_map_is_monotone_and_even_in_grey() {
        let shades: Vec<f64> = (0..=32)
            .map(|index| lightness(mapped(ColorMap::Sequential, f64::from(index) / 32.0)))
            .collect();
        for pair in shades.windows(2) {
            let step = pair[1] - pair[0];
            assert!((1.5..4.0).contains(&step), "{step}");
        }
    }

    #[test]
    fn diverging_map_is_lightest_in_the_middle() {
        let shade = |fraction| lightness(mapped(ColorMap::Diverging, fraction));
        assert!(shade(0.5) > 96.0 && shade(0.0) < 45.0 && shade(1.0) < 45.0);
        assert_eq!(
            mapped(ColorMap::Diverging, 7.0),
            mapped(ColorMap::Diverging, 1.0)
        );
    }
}
