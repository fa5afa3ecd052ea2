//! VTK XML, as ParaView reads it: one VTP file of points per state, and a PVD file that says at
//! which time each belongs.
//!
//! The numbers of a VTP file follow its XML as they are in memory ("appended", "raw"): 64-bit
//! floating point and integers, little-endian, each array behind its size in bytes.

use super::{make_folder, rotate};
use crate::observe::Snapshot;
use crate::record::RunRecord;
use crate::store::{StoreError, write_atomic};
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes these states of a record as a series for ParaView: the file `series` (`….pvd`), which
/// names the files `frame_00000.vtp` and so on in the folder of its name without `.pvd`. Each
/// holds the centres as points, with `radius` (m), `mass` (kg), `velocity` (m/s) and, of spheres
/// that rotate, `spin` (rad/s). The series appears last: when it is there, all its files are.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`].
pub fn write_vtk(
    record: &RunRecord,
    states: &[&Snapshot],
    series: &Path,
) -> Result<(), StoreError> {
    let folder = series.with_extension("");
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    match fs::remove_file(series) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            return Err(StoreError::writing(series, error));
        }
        _ => make_folder(&folder)?,
    }
    let spins = rotate(states);
    let mut collection = String::new();
    for (frame, state) in states.iter().enumerate() {
        let file = format!("frame_{frame:05}.vtp");
        let path = folder.join(&file);
        // Not made durable one by one, which takes longer than all the rest: the series decides.
        fs::write(&path, points(record, state, spins))
            .map_err(|error| StoreError::writing(&path, error))?;
        collection += &format!(
            "    <DataSet timestep=\"{:?}\" part=\"0\" file=\"{}/{file}\"/>\n",
            state.time,
            escaped(&name)
        );
    }
    let text = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
         <Collection>\n{collection}  </Collection>\n</VTKFile>\n"
    );
    write_atomic(series, text.as_bytes())
}

/// One VTP file.
fn points(record: &RunRecord, state: &Snapshot, spins: bool) -> Vec<u8> {
    let count = record.radius.len();
    let mut arrays = Appended::default();
    let position = arrays.floats("Points", 3, &state.position);
    let mut data = arrays.floats("radius", 1, &record.radius);
    data += &arrays.floats("mass", 1, &record.mass);
    data += &arrays.floats("velocity", 3, &state.velocity);
    if spins {
        data += &arrays.floats("spin", 3, &state.spin);
    }
    // Each point is a vertex, so that it is seen without any filter.
    let connectivity = arrays.integers("connectivity", 0..count as i64);
    let offsets = arrays.integers("offsets", 1..=count as i64);
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n  \
         <PolyData>\n    \
         <Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n\
         <PointData Scalars=\"radius\" Vectors=\"velocity\">\n{data}</PointData>\n\
         <Points>\n{position}</Points>\n\
         <Verts>\n{connectivity}{offsets}</Verts>\n    \
         </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_"
    )
    .into_bytes();
    file.extend_from_slice(&arrays.bytes);
    // Writing to memory cannot fail.
    let _ = write!(file, "\n  </AppendedData>\n</VTKFile>\n");
    file
}

/// The numbers behind the XML.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Appends an array; returns the XML element that stands for it.
    fn floats<'a>(
        &mut self,
        name: &str,
        components: usize,
        values: impl IntoIterator<Item = &'a f64>,
    ) -> String {
        let values = values.into_iter().map(|value| value.to_le_bytes());
        self.append("Float64", name, components, values)
    }

    fn integers(&mut self, name: &str, values: impl IntoIterator<Item = i64>) -> String {
        let values = values.into_iter().map(i64::to_le_bytes);
        self.append("Int64", name, 1, values)
    }

    fn append(
        &mut self,
        kind: &str,
        name: &str,
        components: usize,
        values: impl Iterator<Item = [u8; 8]>,
    ) -> String {
        let offset = self.bytes.len();
        let start = offset + size_of::<u64>();
        self.bytes.resize(start, 0);
        self.bytes.extend(values.flatten());
        let size = (self.bytes.len() - start) as u64;
        self.bytes[offset..start].copy_from_slice(&size.to_le_bytes());
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>\n"
        )
    }
}

/// Text as it may stand in an XML attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}
