//! The axes of the datasets of a record as dimension scales, by which netCDF and xarray know them.
//!
//! A scale is a dataset that stands for an axis. Other datasets name the scales of their axes, and
//! scales name their datasets. Both do so by places in the file, which are known once its headers
//! are there: until then placeholders of the same length stand in these attributes, and
//! [`Linked`] replaces them while the file is written.

use super::attributes::{self, placeholder};
use super::headers::{self, Unread};
use hdf5_pure::DatasetBuilder;
use std::io::{self, Write};

/// Most datasets of a scale. HDF5 keeps longer lists elsewhere; further datasets have no scales.
const MOST_USERS: usize = 4000;
/// Length of the heap in bytes, the least that HDF5 allows. It has room for 150 scales.
const HEAP: usize = 4096;
/// What netCDF calls a dimension without a variable, before its length.
const NO_VARIABLE: &str = "This is a netCDF dimension but not a netCDF variable.";

/// The scales of a record, and which datasets they are scales of.
#[derive(Debug, Default)]
pub(super) struct DimensionScales {
    scales: Vec<Scale>,
    /// Path of each dataset that has scales, and these by their places in the list.
    users: Vec<(String, Vec<usize>)>,
}

#[derive(Debug)]
struct Scale {
    /// Path in the file.
    path: String,
    length: usize,
    users: usize,
    /// Whether its values say where along the axis something is.
    is_variable: bool,
}

impl Scale {
    fn name(&self) -> String {
        match self.is_variable {
            true => self.path.rsplit('/').next().unwrap_or_default().to_owned(),
            false => format!("{NO_VARIABLE}{:10}", self.length),
        }
    }

    /// Its attributes, for datasets with these addresses, of which it is these axes.
    fn messages(&self, users: &[(u64, usize)]) -> [Vec<u8>; 3] {
        [
            attributes::class(),
            attributes::name(&self.name()),
            attributes::reference_list(users),
        ]
    }
}

impl DimensionScales {
    /// Gives a dataset the scales of these paths and lengths, one for each of its axes. It gets
    /// none if one of them has another length, or too many datasets.
    pub(super) fn attach(
        &mut self,
        dataset: &mut DatasetBuilder,
        path: String,
        axes: &[(String, usize)],
    ) {
        let places: Vec<usize> = axes.iter().map(|axis| self.place(axis)).collect();
        let fits = |(&place, (_, length)): (&usize, &(String, usize))| {
            let scale = &self.scales[place];
            scale.length == *length && scale.users < MOST_USERS
        };
        if places.iter().zip(axes).all(fits) {
            for &place in &places {
                self.scales[place].users += 1;
            }
            let (name, value) = placeholder(&attributes::dimension_list(0, &places));
            dataset.set_attr(&name, value);
            self.users.push((path, places));
        }
    }

    /// Length of the scale of that path; none if no dataset has it.
    pub(super) fn length(&self, path: &str) -> Option<usize> {
        let scale = self.scales.iter().find(|scale| scale.path == path)?;
        (scale.users > 0).then_some(scale.length)
    }

    /// Makes a dataset the scale of that path, if any dataset has it, after all of them have been
    /// attached. `is_variable` says whether its values say where along the axis something is.
    pub(super) fn make_scale(
        &mut self,
        dataset: &mut DatasetBuilder,
        path: &str,
        is_variable: bool,
    ) {
        let mut scales = self.scales.iter_mut();
        let scale = scales.find(|scale| scale.path == path && scale.users > 0);
        if let Some(scale) = scale {
            scale.is_variable = is_variable;
            for message in scale.messages(&vec![(0, 0); scale.users]) {
                let (name, value) = placeholder(&message);
                dataset.set_attr(&name, value);
            }
        }
    }

    /// Place in the list of the scale of that path.
    fn place(&mut self, (path, length): &(String, usize)) -> usize {
        let place = self.scales.iter().position(|scale| scale.path == *path);
        place.unwrap_or_else(|| {
            self.scales.push(Scale {
                path: path.clone(),
                length: *length,
                users: 0,
                is_variable: true,
            });
            self.scales.len() - 1
        })
    }

    /// Replaces the placeholders in the headers at the beginning of a file. Returns the heap, which
    /// goes to the end of the file.
    fn link(&self, head: &mut [u8]) -> Result<Vec<u8>, Unread> {
        let headers = headers::datasets(head)?;
        let header = |path: &str| {
            let header = headers.get(path);
            header.ok_or(Unread::Other("a dataset with scales is missing"))
        };
        let place_of_heap = headers::length(head)?;
        let mut lists = vec![Vec::new(); self.scales.len()];
        for (path, places) in &self.users {
            let header = header(path)?;
            for (axis, &place) in places.iter().enumerate() {
                lists[place].push((header.address(), axis));
            }
            // Entries of a heap are counted from 1.
            let entries: Vec<usize> = places.iter().map(|place| place + 1).collect();
            header.replace(head, &attributes::dimension_list(place_of_heap, &entries))?;
        }
        let mut addresses = vec![0; self.scales.len()];
        for (place, (scale, users)) in self.scales.iter().zip(&lists).enumerate() {
            if users.is_empty() {
                continue;
            }
            let header = header(&scale.path)?;
            for message in scale.messages(users) {
                header.replace(head, &message)?;
            }
            addresses[place] = header.address();
        }
        headers::set_length(head, place_of_heap + HEAP as u64);
        Ok(heap(&addresses))
    }
}

/// A heap that holds these addresses (HDF5 File Format Specification Version 3.0, III.E).
fn heap(addresses: &[u64]) -> Vec<u8> {
    let mut heap = b"GCOL\x01\0\0\0".to_vec();
    heap.extend((HEAP as u64).to_le_bytes());
    // Number of an entry, how often it is referred to, and its length; number 0 is what is free.
    let mut entry = |number: usize, length: usize, content: &[u8]| {
        heap.extend((number as u16).to_le_bytes());
        heap.extend([u8::from(number > 0), 0, 0, 0, 0, 0]);
        heap.extend((length as u64).to_le_bytes());
        heap.extend(content);
    };
    for (number, address) in (1..).zip(addresses) {
        entry(number, 8, &address.to_le_bytes());
    }
    let taken = 16 + 24 * addresses.len();
    entry(0, HEAP - taken, &[]);
    heap.resize(HEAP, 0);
    heap
}

/// A file that `hdf5-pure` writes, in which placeholders are replaced on the way.
pub(super) struct Linked<'a, W> {
    file: &'a mut W,
    scales: DimensionScales,
    /// The beginning, as far as it has been written, and how long it must be to be complete.
    head: Vec<u8>,
    needed: usize,
    /// What goes to the end of the file, once the beginning is complete.
    heap: Option<Vec<u8>>,
}

impl<'a, W: Write> Linked<'a, W> {
    pub(super) fn new(file: &'a mut W, scales: DimensionScales) -> Self {
        Self {
            file,
            scales,
            head: Vec::new(),
            needed: 0,
            heap: None,
        }
    }

    /// Ends the file.
    pub(super) fn finish(self) -> io::Result<()> {
        match self.heap {
            Some(heap) => self.file.write_all(&heap),
            None => Err(io::Error::other("its headers are not complete")),
        }
    }
}

impl<W: Write> Write for Linked<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.heap.is_some() {
            return self.file.write(bytes);
        }
        self.head.extend_from_slice(bytes);
        if self.head.len() >= self.needed {
            match self.scales.link(&mut self.head) {
                Ok(heap) => {
                    self.file.write_all(&self.head)?;
                    self.heap = Some(heap);
                }
                Err(Unread::Short(needed)) => self.needed = needed,
                Err(Unread::Other(reason)) => return Err(io::Error::other(reason)),
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
