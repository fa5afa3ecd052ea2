//! Scenes that start with a packing made by the program.

use crate::forces::simplification::Simplification;
use crate::scene::{Scene, Start, StartSphere};
use crate::simulation::{BuildError, Model, PartOfStep, Simulation};
use crate::spot::packing;
use std::fs;
use std::io::Write;
use std::path::PathBuf;

/// A model whose spheres start in a packing, which is made when a simulation is built.
pub(super) struct Packed(pub(super) &'static dyn Model);

impl Model for Packed {
    fn work_unit(&self) -> &'static str {
        self.0.work_unit()
    }

    fn work_of(&self, scene: &Scene) -> u64 {
        self.0.work_of(scene)
    }

    fn parts_of(&self, scene: &Scene) -> Vec<PartOfStep> {
        self.0.parts_of(scene)
    }

    fn simplifications(&self, scene: &Scene) -> Vec<Simplification> {
        self.0.simplifications(scene)
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let floor = scene.tank.as_ref().and_then(|tank| tank.floor);
        let floor = floor.unwrap_or(0.0);
        let places = places(scene)?.into_iter();
        let spheres = places.map(|[x, y, z]| StartSphere::at([x, y, z + floor]));
        self.0.build(&Scene {
            start: Start::list(spheres.collect()),
            ..scene.clone()
        })
    }
}

/// The centres of the packing above the floor (m): stored before, or made now and stored.
fn places(scene: &Scene) -> Result<Vec<[f64; 3]>, BuildError> {
    let kept = file_of(scene);
    if let Some(places) = kept.as_ref().and_then(|it| read(it, scene.spheres.count)) {
        return Ok(places);
    }
    let places = packing::make(scene, 1).map_err(BuildError::new)?;
    if let Some(file) = kept {
        // A packing that cannot be stored is made again next time.
        let _ = write(&file, &places);
    }
    Ok(places)
}

/// The file in which the packing of a scene is stored, in the cache folder of the system or user.
/// `None` if there is none.
fn file_of(scene: &Scene) -> Option<PathBuf> {
    let folder = |name: &str| std::env::var_os(name).filter(|it| !it.is_empty());
    let cache = folder("XDG_CACHE_HOME").map(PathBuf::from);
    let cache = cache.or_else(|| Some(PathBuf::from(folder("HOME")?).join(".cache")))?;
    let packings = cache.join("phase").join(FOLDER);
    Some(packings.join(packing::name(scene)))
}

/// Folder of the packings. The earlier `packings` may hold heights above another floor.
const FOLDER: &str = "packings-above-floor";

/// Number of bytes of the checksum in front of the places.
const CHECKSUM: usize = blake3::OUT_LEN;

/// The places in a file, if it is intact.
fn read(file: &PathBuf, count: usize) -> Option<Vec<[f64; 3]>> {
    let bytes = fs::read(file).ok()?;
    let (checksum, data) = bytes.split_at_checked(CHECKSUM)?;
    if blake3::hash(data).as_bytes() != checksum || data.len() != 24 * count {
        return None;
    }
    let number = |bytes: &[u8]| bytes.try_into().map(f64::from_le_bytes).ok();
    let numbers: Vec<f64> = data.chunks_exact(8).map(number).collect::<Option<_>>()?;
    Some(
        numbers
            .chunks_exact(3)
            .map(|it| [it[0], it[1], it[2]])
            .collect(),
    )
}

/// Writes a file atomically: another process that reads it finds all of it or none.
fn write(file: &PathBuf, places: &[[f64; 3]]) -> std::io::Result<()> {
    let folder = file.parent().ok_or(std::io::ErrorKind::NotFound)?;
    fs::create_dir_all(folder)?;
    let data: Vec<u8> = places
        .iter()
        .flatten()
        .flat_map(|it| it.to_le_bytes())
        .collect();
    let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
    temporary.write_all(blake3::hash(&data).as_bytes())?;
    temporary.write_all(&data)?;
    temporary
        .persist(file)
        .map(drop)
        .map_err(|error| error.error)
}
