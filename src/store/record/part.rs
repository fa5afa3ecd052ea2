//! A group of datasets, each with its unit, its names and its axes.

use super::cf;
use super::scales::DimensionScales;
use hdf5_pure::{AttrValue, DatasetBuilder, FileBuilder, GroupBuilder, H5Element};

/// Effort of the compression, 1 to 9. Most of what is measured is noise in its last digits: on a
/// record of 5001 frames (0.96 MB) level 1 saves a quarter in 6 ms, level 6 as much in 20 ms.
const DEFLATE_LEVEL: u32 = 1;
/// Datasets below this size (bytes) are stored as they are.
const COMPRESS_FROM: usize = 4096;
/// Largest chunk of a dataset (bytes): what a reader must unpack to see one frame, or a part of a
/// large one.
const CHUNK: usize = 1 << 20;
/// Most entries of a chunk along an axis: HDF5 2.0 refuses the extents of larger ones as they are
/// written here, in four bytes where it would take three.
const WIDEST: usize = u16::MAX as usize;

/// Name, unit and description of a dataset.
#[derive(Clone, Copy)]
pub(super) struct StoredQuantity<'a>(pub &'a str, pub &'a str, pub &'a str);

/// An axis of datasets.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum DatasetAxis {
    /// Frames or snapshots; each group has its own.
    Time,
    Sphere,
    /// x, y, z.
    Component,
    BinRadius,
    RiseRadius,
    RiseSpeed,
}

impl DatasetAxis {
    /// The axes that all groups share.
    pub(super) const COMMON: [Self; 5] = [
        Self::Sphere,
        Self::Component,
        Self::BinRadius,
        Self::RiseRadius,
        Self::RiseSpeed,
    ];

    /// Name, unit and description of its scale.
    pub(super) fn quantity(self) -> StoredQuantity<'static> {
        match self {
            Self::Time => StoredQuantity("time", "s", "Time"),
            Self::Sphere => StoredQuantity("sphere", "1", "An axis of all spheres, without values"),
            Self::Component => {
                StoredQuantity("component", "1", "An axis of x, y and z, without values")
            }
            Self::BinRadius => {
                let description = "Distance from the axis: centres of the radial bins";
                StoredQuantity("bin_radius", "m", description)
            }
            Self::RiseRadius => {
                let description = "Share of the tank's radius, within which rising spheres count";
                StoredQuantity("rise_radius", "1", description)
            }
            Self::RiseSpeed => {
                let description = "Speed relative to the mean, from which spheres count as rising";
                StoredQuantity("rise_speed", "m/s", description)
            }
        }
    }

    /// Path of its scale, for a dataset of that group.
    fn path(self, group: &str) -> String {
        let name = self.quantity().0;
        match self {
            Self::Time => format!("{group}/{name}"),
            _ => name.to_owned(),
        }
    }
}

/// A group of datasets.
pub(super) struct RecordPart<'a> {
    name: &'a str,
    group: GroupBuilder,
    scales: &'a mut DimensionScales,
}

impl RecordPart<'_> {
    /// Adds a group to a file.
    pub(super) fn add(
        file: &mut FileBuilder,
        name: &str,
        scales: &mut DimensionScales,
        fill: impl FnOnce(&mut RecordPart<'_>) -> Result<(), String>,
    ) -> Result<(), String> {
        let group = file.create_group(name);
        let mut part = RecordPart {
            name,
            group,
            scales,
        };
        fill(&mut part)?;
        file.add_group(part.group.finish());
        Ok(())
    }

    /// Adds a dataset with these axes and their lengths.
    pub(super) fn dataset<T: H5Element>(
        &mut self,
        quantity: StoredQuantity<'_>,
        axes: &[(DatasetAxis, usize)],
        values: &[T],
    ) {
        let shape: Vec<usize> = axes.iter().map(|(_, length)| *length).collect();
        let dataset = self.group.create_dataset(quantity.0);
        fill(dataset, quantity, &shape, values);
        let axes: Vec<_> = axes
            .iter()
            .map(|(axis, length)| (axis.path(self.name), *length))
            .collect();
        self.scales
            .attach(dataset, format!("{}/{}", self.name, quantity.0), &axes);
    }

    /// Adds the times of a group, after all its other datasets.
    pub(super) fn time(&mut self, unit: &str, description: &str, values: &[f64]) {
        let quantity = StoredQuantity(DatasetAxis::Time.quantity().0, unit, description);
        let dataset = self.group.create_dataset(quantity.0);
        fill(dataset, quantity, &[values.len()], values);
        self.scales
            .make_scale(dataset, &DatasetAxis::Time.path(self.name), true);
    }
}

/// Adds the scale of an axis that groups share, after all of them, if any needs it. `values` say
/// where along the axis something is, if they are known.
pub(super) fn common_axis(
    file: &mut FileBuilder,
    axis: DatasetAxis,
    values: Option<Vec<f64>>,
    scales: &mut DimensionScales,
) {
    let quantity = axis.quantity();
    let path = axis.path("");
    let Some(length) = scales.length(&path) else {
        return;
    };
    let dataset = file.create_dataset(quantity.0);
    let values = values.filter(|values| values.len() == length);
    match &values {
        Some(values) => fill(dataset, quantity, &[length], values),
        None => fill(dataset, quantity, &[length], &vec![0_u8; length]),
    }
    scales.make_scale(dataset, &path, values.is_some());
}

fn fill<T: H5Element>(
    dataset: &mut DatasetBuilder,
    StoredQuantity(_, unit, description): StoredQuantity<'_>,
    shape: &[usize],
    values: &[T],
) {
    let shape: Vec<u64> = shape.iter().map(|&extent| extent as u64).collect();
    dataset
        .with_data(values)
        .with_shape(&shape)
        .set_attr("unit", short_text(unit))
        .set_attr("description", short_text(description))
        .set_attr("units", short_text(&cf::units(unit)))
        .set_attr("long_name", short_text(cf::long_name(description)));
    let size = size_of_val(values);
    if size >= COMPRESS_FROM {
        dataset
            .with_chunks(&chunk(&shape, size_of::<T>()))
            .with_shuffle()
            .with_deflate(DEFLATE_LEVEL);
    }
}

/// A text of a fixed length. One of a variable length takes 4 kB of the file, which for the texts
/// of each dataset is more than the record of a short run holds.
pub(super) fn short_text(value: &str) -> AttrValue {
    AttrValue::String(value.to_owned())
}

/// Extents of the chunks of a dataset with entries of that size (bytes): whole rows as far as they
/// fit.
fn chunk(shape: &[u64], size: usize) -> Vec<u64> {
    let mut chunk = shape.to_vec();
    let mut room = CHUNK / size;
    for extent in chunk.iter_mut().rev() {
        let entries = (*extent as usize).min(WIDEST).min(room).max(1);
        room /= entries;
        *extent = entries as u64;
    }
    chunk
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_chunk_is_some_frames_or_a_part_of_one() {
        assert_eq!(chunk(&[5001, 256, 3], 8), [170, 256, 3]);
        assert_eq!(chunk(&[2, 40_000, 3], 8), [1, 40_000, 3]);
        assert_eq!(chunk(&[2, 1_000_000, 3], 8), [1, 43_690, 3]);
        assert_eq!(chunk(&[1_000_000], 8), [65_535]);
    }

    proptest! {
        #[test]
        fn chunks_are_neither_too_large_nor_too_wide(
            shape in prop::collection::vec(1_u64..3_000_000, 1..4),
        ) {
            let chunk = chunk(&shape, 8);
            prop_assert!(chunk.iter().product::<u64>() * 8 <= CHUNK as u64);
            for (extent, all) in chunk.iter().zip(&shape) {
                prop_assert!((1..=WIDEST as u64).contains(extent) && extent <= all);
            }
        }
    }
}
