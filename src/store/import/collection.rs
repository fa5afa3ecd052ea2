//! Collections (`.pvd`): lists of VTK files and their times.

use super::line_at;
use super::vtk;
use crate::document::{advice, text};
use crate::replay::{StateTime, WrittenState};
use crate::store::StoreError;
use roxmltree::{Document, Node};
use std::fs;
use std::path::Path;

/// A file that a collection names.
struct NamedFile<'a> {
    time: f64,
    part: u64,
    name: &'a str,
    line: u64,
}

/// Reads the states of a collection: of the files of one time, only the one of the lowest part.
/// The further parts are things that spheres move in, such as walls.
pub(super) fn states(path: &Path) -> Result<Vec<WrittenState>, StoreError> {
    let text = text::read(path).map_err(|error| StoreError::reading(path, error))?;
    let document = Document::parse(&text).map_err(|error| {
        let reason = format!("it is no collection, which is XML: {error}");
        StoreError::text(path, error.pos().row.into(), reason)
    })?;
    let root = document.root_element();
    if root.attribute("type") != Some("Collection") {
        let reason = "it is no collection: `<VTKFile type=\"Collection\">` is expected";
        return Err(StoreError::text(path, 1, reason));
    }
    let data_sets = root.descendants().filter(|it| it.has_tag_name("DataSet"));
    let files = data_sets.map(|data_set| {
        let line = line_at(&text, data_set.range().start);
        named_file(data_set, line).map_err(|reason| StoreError::text(path, line, reason))
    });
    let mut files: Vec<NamedFile<'_>> = files.collect::<Result<_, _>>()?;
    if files.is_empty() {
        let reason = "it names no files; name two or more with their times";
        return Err(StoreError::text(path, 1, reason));
    }
    files.sort_by(|one, other| {
        let time = one.time.total_cmp(&other.time);
        time.then(one.part.cmp(&other.part))
    });
    let is_same = |two: &[NamedFile<'_>]| two[0].time == two[1].time && two[0].part == two[1].part;
    if let Some([one, other]) = files.windows(2).find(|two| is_same(two)) {
        let reason = format!(
            "`{}` has the time and the part of `{}`; give each file a time of its own, or number \
             the files of a time with `part`, the one of the spheres first",
            other.name, one.name
        );
        return Err(StoreError::text(path, other.line, reason));
    }
    files.dedup_by(|later, first| later.time == first.time);
    let folder = path.parent().unwrap_or(Path::new(""));
    let state = |file: &NamedFile<'_>| {
        let named = folder.join(file.name);
        let bytes = fs::read(&named).map_err(|error| {
            StoreError::Read(format!(
                "cannot read {}, which {} names: {error}{}",
                named.display(),
                path.display(),
                advice(&error)
            ))
        })?;
        let spheres = vtk::read(&named, &bytes)?;
        Ok(WrittenState {
            moment: StateTime::Time(file.time),
            are_numbered: spheres.are_numbered,
            spheres: spheres.all,
        })
    };
    files.iter().map(state).collect()
}

fn named_file<'a>(data_set: Node<'a, '_>, line: u64) -> Result<NamedFile<'a>, String> {
    let attribute = |name: &str| {
        let value = data_set.attribute(name);
        value.ok_or_else(|| format!("`{name}` is missing: a `DataSet` has `timestep` and `file`"))
    };
    let time = attribute("timestep")?;
    let is_finite = |it: &f64| it.is_finite();
    let part = data_set.attribute("part").unwrap_or("0");
    Ok(NamedFile {
        time: (time.trim().parse().ok().filter(is_finite))
            .ok_or_else(|| format!("`timestep` is `{time}`, but must be a time"))?,
        part: (part.trim().parse().ok())
            .ok_or_else(|| format!("`part` is `{part}`, but must be a whole number from 0"))?,
        name: attribute("file")?,
        line,
    })
}

#[cfg(test)]
mod tests {
    use crate::replay::{StateTime, WrittenState};
    use crate::store::read_states;
    use std::fs;

    /// Two files of one sphere, and lists of them.
    fn read(name: &str, list: &str) -> Result<Vec<WrittenState>, String> {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        fs::create_dir(place("states")).unwrap();
        let sphere = |x: f64| {
            format!(
                "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"><Points>\
                 <DataArray NumberOfComponents=\"3\">{x} 0 0</DataArray>\
                 </Points></Piece></PolyData></VTKFile>"
            )
        };
        fs::write(place("states/a.vtp"), sphere(1.0)).unwrap();
        fs::write(place("b.vtp"), sphere(2.0)).unwrap();
        fs::write(place("old.vtk"), "# vtk DataFile Version 3.0\n").unwrap();
        let empty = "<VTKFile type=\"PolyData\"><PolyData/></VTKFile>";
        fs::write(place("empty.vtp"), empty).unwrap();
        fs::write(place("other.vtm"), "<VTKFile type=\"vtkMultiBlock\"/>").unwrap();
        fs::write(place(name), list).unwrap();
        read_states(&place(name)).map_err(|error| {
            let folder = format!("{}/", folder.path().display());
            error.to_string().replace(&folder, "")
        })
    }

    fn pvd(data_sets: &str) -> Result<Vec<WrittenState>, String> {
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n{data_sets}\n\
             </Collection>\n</VTKFile>\n"
        );
        read("run.pvd", &text)
    }

    const THREE: &str = "\
        <DataSet timestep=\"0.5\" part=\"1\" file=\"walls.vtp\"/>\n\
        <DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"b.vtp\"/>\n\
        <DataSet timestep=\"0\" file=\"states/a.vtp\"/>\n\
        <DataSet timestep=\"7\" file=\"empty.vtp\"/>";

    #[test]
    fn collections_give_the_states_by_time() {
        let states = pvd(THREE).unwrap();
        let state = |time: f64, x: &[f64]| WrittenState {
            moment: StateTime::Time(time),
            are_numbered: x.is_empty(),
            spheres: x.iter().map(|x| (0, [*x, 0.0, 0.0])).collect(),
        };
        let expected = [state(0.0, &[1.0]), state(0.5, &[2.0]), state(7.0, &[])];
        assert_eq!(states, expected);
    }

    #[test]
    fn wrong_collections_are_refused() {
        for (data_sets, expected) in [
            ("", "run.pvd:1: it names no files; name two or more"),
            ("<DataSet", "it is no collection, which is XML: "),
            (
                "<DataSet file=\"b.vtp\"/>",
                "run.pvd:4: `timestep` is missing",
            ),
            (
                "\n<DataSet timestep=\"1\"/>",
                "run.pvd:5: `file` is missing",
            ),
            (
                "<DataSet timestep=\"inf\" file=\"b.vtp\"/>",
                "run.pvd:4: `timestep` is `inf`, but must be a time",
            ),
            (
                "<DataSet timestep=\"1\" part=\"x\" file=\"b.vtp\"/>",
                "run.pvd:4: `part` is `x`, but must be a whole number",
            ),
            (
                &format!("{THREE}\n<DataSet timestep=\"7.0\" file=\"b.vtp\"/>"),
                "run.pvd:8: `b.vtp` has the time and the part of `empty.vtp`; give each",
            ),
            (
                "<DataSet timestep=\"1\" file=\"c.vtp\"/>",
                "cannot read c.vtp, which run.pvd names: ",
            ),
            (
                "<DataSet timestep=\"1\" file=\"run.pvd\"/>",
                "run.pvd:2: it is a `Collection`; ",
            ),
            (
                "<DataSet timestep=\"1\" file=\"old.vtk\"/>",
                "old.vtk:1: it is a legacy file of VTK, which cannot be read; save it as XML",
            ),
            (
                "<DataSet timestep=\"1\" file=\"other.vtm\"/>",
                "other.vtm:1: it is a `vtkMultiBlock`; ",
            ),
        ] {
            let error = pvd(data_sets).unwrap_err();
            assert!(error.contains(expected), "{error}\n{expected}");
        }
        let error = read("run.pvd", "<VTKFile type=\"PolyData\"/>").unwrap_err();
        assert!(
            error.contains("run.pvd:1: it is no collection: "),
            "{error}"
        );
    }

    #[test]
    fn a_file_without_a_time_is_refused() {
        for name in ["one.vtk", "one.vtp", "one.vtu", "one.series"] {
            let error = read(name, "").unwrap_err();
            assert!(error.contains(".pvd"), "{error}");
        }
    }
}
