//! Maps from a quantity to colours, shared by figures and pictures.

/// Map from a quantity to colours, perceptually uniform and safe for the colour-blind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColorMap {
    /// From low to high: viridis (van der Walt and Smith, 2015; CC0).
    Sequential,
    /// From negative over zero to positive: RdBu reversed (Harrower and Brewer, 2003).
    Diverging,
}

const VIRIDIS: [u32; 9] = [
    0x44_01_54, 0x47_2d_7b, 0x3b_52_8b, 0x2c_72_8e, 0x21_91_8c, 0x28_ae_80, 0x5e_c9_62, 0xad_dc_30,
    0xfd_e7_25,
];

const BLUE_RED: [u32; 9] = [
    0x21_66_ac, 0x43_93_c3, 0x92_c5_de, 0xd1_e5_f0, 0xf7_f7_f7, 0xfd_db_c7, 0xf4_a5_82, 0xd6_60_4d,
    0xb2_18_2b,
];

impl ColorMap {
    /// Red, green and blue at `fraction` of the map, 0 to 1.
    pub(crate) fn at(self, fraction: f64) -> [u8; 3] {
        let anchors = match self {
            Self::Sequential => &VIRIDIS,
            Self::Diverging => &BLUE_RED,
        };
        let position = fraction.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
        let index = (position as usize).min(anchors.len() - 2);
        mix(
            rgb(anchors[index]),
            rgb(anchors[index + 1]),
            position - index as f64,
        )
    }
}

/// Colours of things in turn, told apart by every kind of colour vision (Okabe and Ito, 2008).
pub(crate) const DISTINCT: [u32; 6] = [
    0x00_72_b2, 0xd5_5e_00, 0x00_9e_73, 0xcc_79_a7, 0xe6_9f_00, 0x56_b4_e9,
];

/// The channels of a colour written as 0xRRGGBB.
pub(crate) const fn rgb(hex: u32) -> [u8; 3] {
    let [_, red, green, blue] = hex.to_be_bytes();
    [red, green, blue]
}

/// `share` of `other` in `color`.
pub(crate) fn mix(color: [u8; 3], other: [u8; 3], share: f64) -> [u8; 3] {
    let channel =
        |one: u8, two: u8| (f64::from(one) + share * (f64::from(two) - f64::from(one))).round();
    [0, 1, 2].map(|index| channel(color[index], other[index]) as u8)
}
