//! VTK XML, as ParaView reads it: one VTP file of points per state, and a PVD file that says at
//! which time each belongs.
//!
//! The numbers of a VTP file follow its XML as they are in memory ("appended", "raw"): 64-bit
//! floating point and integers, little-endian, each array behind its size in bytes.

use super::{fixed, frame_name, make_folder, present, rotate};
use crate::markup::escape;
use crate::observe::Snapshot;
use crate::particles::vector::Vector;
use crate::record::RunRecord;
use crate::render::Scenery;
use crate::scene::FixedSphere;
use crate::store::atomic::write_one_of_many;
use crate::store::{StoreError, write_atomic};
use crate::walls::Wall;
use ndarray::{Array2, Axis};
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes these states of a record as a series for ParaView: the file `series` (`….pvd`), which
/// names the files `frame_00000.vtp` and so on in the folder of its name without `.pvd`. Each holds
/// the centres as points, with `radius` (m), `mass` (kg), `velocity` (m/s) and, of spheres that
/// rotate, `spin` (rad/s). Where spheres come and go, a file holds those that are in, with `id`,
/// the index of each. Fixed spheres are further parts of the series, `walls.vtp` and, as long as it
/// is closed, `door.vtp`; so are the walls that the scene lists, as polygons, `surfaces.vtp`. The
/// series is written last: when it exists, all its files do.
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
    let write = |file: &str, bytes: Vec<u8>| write_one_of_many(&folder.join(file), &bytes);
    let fixed = fixed(record);
    for (file, spheres) in [(WALLS, &fixed.walls), (DOOR, &fixed.door)] {
        if !spheres.is_empty() {
            write(file, fixed_file(spheres))?;
        }
    }
    let walls = Wall::of_scene(&record.scene).into_iter();
    let surfaces: Vec<_> = walls.flat_map(|wall| wall.polygons()).collect();
    if !surfaces.is_empty() {
        write(SURFACES, polygons_file(&surfaces))?;
    }
    let scenery = Scenery::new(&record.scene, &record.milestones);
    let spins = rotate(states);
    let mut collection = String::new();
    for (frame, state) in states.iter().enumerate() {
        let file = frame_name(frame, "vtp");
        write(&file, state_file(record, state, spins))?;
        let walls = (!fixed.walls.is_empty()).then_some(WALLS);
        let door = (!scenery.door_at(state.time).is_empty()).then_some(DOOR);
        let surfaces = (!surfaces.is_empty()).then_some(SURFACES);
        let parts = [Some(&file[..]), walls, door, surfaces];
        for (part, file) in parts.into_iter().enumerate() {
            let Some(file) = file else { continue };
            collection += &format!(
                "    <DataSet timestep=\"{:?}\" part=\"{part}\" file=\"{}/{file}\"/>\n",
                state.time,
                escape(&name)
            );
        }
    }
    let text = format!(
        "{VTK_SIGNATURE}\n\
         <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
         <Collection>\n{collection}  </Collection>\n</VTKFile>\n"
    );
    write_atomic(series, text.as_bytes())
}

/// What the files of a series begin with.
pub const VTK_SIGNATURE: &str = "<?xml version=\"1.0\"?>\n<!-- phase: spheres -->";

/// Names of the files of fixed spheres.
const WALLS: &str = "walls.vtp";
const DOOR: &str = "door.vtp";

/// Name of the file of listed walls.
const SURFACES: &str = "surfaces.vtp";

/// Names of the files of a series of that many states: frames and fixed spheres.
pub fn vtk_names(states: usize) -> impl Iterator<Item = String> {
    let frames = (0..states).map(|frame| frame_name(frame, "vtp"));
    frames.chain([WALLS, DOOR, SURFACES].map(str::to_owned))
}

/// The VTP file of a state.
fn state_file(record: &RunRecord, state: &Snapshot, spins: bool) -> Vec<u8> {
    let spheres = present(record, state);
    let rows = |values: &Array2<f64>| values.select(Axis(0), &spheres);
    let some = |values: &[f64]| -> Vec<f64> { spheres.iter().map(|&it| values[it]).collect() };
    let mut arrays = Appended::default();
    let position = arrays.floats("Points", 3, &rows(&state.position));
    let mut data = arrays.floats("radius", 1, &some(&record.radius));
    data += &arrays.floats("mass", 1, &some(&record.mass));
    data += &arrays.floats("velocity", 3, &rows(&state.velocity));
    if spins {
        data += &arrays.floats("spin", 3, &rows(&state.spin));
    }
    if record.scene.has_flow() {
        data += &arrays.integers("id", spheres.iter().map(|&it| it as i64));
    }
    points(
        arrays,
        spheres.len(),
        &position,
        &format!("<PointData Scalars=\"radius\" Vectors=\"velocity\">\n{data}</PointData>"),
    )
}

/// The VTP file of fixed spheres.
fn fixed_file(spheres: &[FixedSphere]) -> Vec<u8> {
    let mut arrays = Appended::default();
    let position = arrays.floats("Points", 3, spheres.iter().flat_map(|it| &it.position));
    let radius = arrays.floats("radius", 1, spheres.iter().map(|it| &it.radius));
    let data = format!("<PointData Scalars=\"radius\">\n{radius}</PointData>");
    points(arrays, spheres.len(), &position, &data)
}

/// A VTP file of that many points.
fn points(mut arrays: Appended, count: usize, position: &str, data: &str) -> Vec<u8> {
    // Each point is a vertex, so that it is seen without any filter.
    let connectivity = arrays.integers("connectivity", 0..count as i64);
    let offsets = arrays.integers("offsets", 1..=count as i64);
    let vertices = format!("<Verts>\n{connectivity}{offsets}</Verts>");
    let counts = format!("NumberOfVerts=\"{count}\" NumberOfPolys=\"0\"");
    poly_data(&arrays, count, &counts, &[data, position, &vertices])
}

/// The VTP file of polygons.
fn polygons_file(polygons: &[Vec<Vector>]) -> Vec<u8> {
    let mut arrays = Appended::default();
    let corners: Vec<f64> = (polygons.iter().flatten())
        .flat_map(|it| [it.x, it.y, it.z])
        .collect();
    let count = corners.len() / 3;
    let position = arrays.floats("Points", 3, &corners);
    let connectivity = arrays.integers("connectivity", 0..count as i64);
    let mut end = 0;
    let offsets = polygons.iter().map(|polygon| {
        end += polygon.len() as i64;
        end
    });
    let offsets = arrays.integers("offsets", offsets);
    let faces = format!("<Polys>\n{connectivity}{offsets}</Polys>");
    let counts = format!("NumberOfVerts=\"0\" NumberOfPolys=\"{}\"", polygons.len());
    poly_data(&arrays, count, &counts, &["", &position, &faces])
}

/// The VTP file of that many points, with counts of cells, and the elements of data, points and
/// cells.
fn poly_data(
    arrays: &Appended,
    count: usize,
    counts: &str,
    [data, position, cells]: &[&str; 3],
) -> Vec<u8> {
    let mut file = format!(
        "{VTK_SIGNATURE}\n\
         <VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n  \
         <PolyData>\n    \
         <Piece NumberOfPoints=\"{count}\" {counts} NumberOfLines=\"0\" \
         NumberOfStrips=\"0\">\n\
         {data}\n\
         <Points>\n{position}</Points>\n\
         {cells}\n    \
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
