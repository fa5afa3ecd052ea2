//! Lists of VTK files and their times: collections (`.pvd`) and series of ParaView (`.series`).

use super::vtk_numbers::Spheres;
use super::{line_at, vtk_legacy, vtk_xml};
use crate::document::text;
use crate::replay::{StateTime, WrittenState};
use crate::store::StoreError;
use roxmltree::{Document, Node};
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// A file that is named.
struct Entry {
    time: f64,
    part: u64,
    name: String,
    /// Where the list names it: bytes from its start.
    at: usize,
}

/// Reads the states of a collection (`.pvd`): of the files of one time, that of the lowest part.
/// The further parts are things that spheres move in, such as walls.
pub(super) fn collection(path: &Path) -> Result<Vec<WrittenState>, StoreError> {
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
    let entries = data_sets.map(|data_set| {
        entry(data_set).map_err(|reason| {
            StoreError::text(path, line_at(&text, data_set.range().start), reason)
        })
    });
    states(path, &text, entries.collect::<Result<_, _>>()?)
}

fn entry(data_set: Node<'_, '_>) -> Result<Entry, String> {
    let attribute = |name: &str| {
        let value = data_set.attribute(name);
        value.ok_or_else(|| format!("`{name}` is missing: a `DataSet` has `timestep` and `file`"))
    };
    let time = attribute("timestep")?;
    let is_finite = |it: &f64| it.is_finite();
    let part = data_set.attribute("part").unwrap_or("0");
    Ok(Entry {
        time: (time.trim().parse().ok().filter(is_finite))
            .ok_or_else(|| format!("`timestep` is `{time}`, but must be a time"))?,
        part: (part.trim().parse().ok())
            .ok_or_else(|| format!("`part` is `{part}`, but must be a whole number from 0"))?,
        name: attribute("file")?.to_owned(),
        at: data_set.range().start,
    })
}

/// What is read of a series.
#[derive(Deserialize)]
struct Series {
    files: Vec<Listed>,
}

#[derive(Deserialize)]
struct Listed {
    name: String,
    time: f64,
}

/// Reads the states of a series of ParaView.
pub(super) fn series(path: &Path) -> Result<Vec<WrittenState>, StoreError> {
    let text = text::read(path).map_err(|error| StoreError::reading(path, error))?;
    let series: Series = serde_json::from_str(&text).map_err(|error| {
        let reason = format!(
            "it is no series, `{{\"files\": [{{\"name\": \"a.vtp\", \"time\": 0.5}}]}}`: {error}"
        );
        StoreError::text(path, error.line().max(1) as u64, reason)
    })?;
    // Names stand in the order of the text.
    let mut from = 0;
    let entries = series.files.into_iter().map(|Listed { name, time }| {
        let at = text[from..].find(&name).map_or(from, |place| from + place);
        from = at;
        Entry {
            time,
            part: 0,
            name,
            at,
        }
    });
    states(path, &text, entries.collect())
}

/// Reads the states that a list names, by time.
fn states(
    path: &Path,
    text: &str,
    mut entries: Vec<Entry>,
) -> Result<Vec<WrittenState>, StoreError> {
    if entries.is_empty() {
        let reason = "it names no files; name two or more with their times";
        return Err(StoreError::text(path, 1, reason));
    }
    entries.sort_by(|one, other| {
        let time = one.time.total_cmp(&other.time);
        time.then(one.part.cmp(&other.part))
    });
    let is_same = |two: &[Entry]| two[0].time == two[1].time && two[0].part == two[1].part;
    if let Some([one, other]) = entries.windows(2).find(|two| is_same(two)) {
        let reason = format!(
            "`{}` has the time and the part of `{}`; give each file a time of its own, or number \
             the files of a time with `part` in a collection, that of the spheres first",
            other.name, one.name
        );
        return Err(StoreError::text(path, line_at(text, other.at), reason));
    }
    entries.dedup_by(|later, first| later.time == first.time);
    let folder = path.parent().unwrap_or(Path::new(""));
    let state = |entry: &Entry| {
        let spheres = spheres(&folder.join(&entry.name), path)?;
        Ok(WrittenState {
            moment: StateTime::Time(entry.time),
            are_numbered: spheres.are_numbered,
            spheres: spheres.all,
        })
    };
    entries.iter().map(state).collect()
}

/// The spheres of a file that `list` names.
fn spheres(path: &Path, list: &Path) -> Result<Spheres, StoreError> {
    let bytes = fs::read(path).map_err(|source| StoreError::ReadNamed {
        path: path.to_owned(),
        list: list.to_owned(),
        source,
    })?;
    match bytes.starts_with(vtk_legacy::SIGNATURE) {
        true => vtk_legacy::read(path, &bytes),
        false => vtk_xml::read(path, &bytes),
    }
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
        let legacy = |x: f64| {
            format!(
                "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\n\
                 POINTS 1 float\n{x} 0 0\n"
            )
        };
        fs::write(place("states/a.vtk"), legacy(1.0)).unwrap();
        fs::write(place("b.vtk"), legacy(2.0)).unwrap();
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
        <DataSet timestep=\"0.5\" group=\"\" part=\"0\" file=\"b.vtk\"/>\n\
        <DataSet timestep=\"0\" file=\"states/a.vtk\"/>\n\
        <DataSet timestep=\"7\" file=\"empty.vtp\"/>";

    #[test]
    fn collections_and_series_give_the_same_states() {
        let states = pvd(THREE).unwrap();
        let state = |time: f64, x: &[f64]| WrittenState {
            moment: StateTime::Time(time),
            are_numbered: x.is_empty(),
            spheres: x.iter().map(|x| (0, [*x, 0.0, 0.0])).collect(),
        };
        let expected = [state(0.0, &[1.0]), state(0.5, &[2.0]), state(7.0, &[])];
        assert_eq!(states, expected);
        let series = "{\"file-series-version\": \"1.0\", \"files\": [\n\
                      {\"name\": \"states/a.vtk\", \"time\": 0},\n\
                      {\"time\": 0.5, \"name\": \"b.vtk\"},\n\
                      {\"name\": \"empty.vtp\", \"time\": 7.0}]}";
        assert_eq!(read("run.vtk.series", series).unwrap(), expected);
    }

    #[test]
    fn wrong_collections_are_refused() {
        for (data_sets, expected) in [
            ("", "run.pvd:1: it names no files; name two or more"),
            ("<DataSet", "it is no collection, which is XML: "),
            (
                "<DataSet file=\"b.vtk\"/>",
                "run.pvd:4: `timestep` is missing",
            ),
            (
                "\n<DataSet timestep=\"1\"/>",
                "run.pvd:5: `file` is missing",
            ),
            (
                "<DataSet timestep=\"inf\" file=\"b.vtk\"/>",
                "run.pvd:4: `timestep` is `inf`, but must be a time",
            ),
            (
                "<DataSet timestep=\"1\" part=\"x\" file=\"b.vtk\"/>",
                "run.pvd:4: `part` is `x`, but must be a whole number",
            ),
            (
                &format!("{THREE}\n<DataSet timestep=\"7.0\" file=\"b.vtk\"/>"),
                "run.pvd:8: `b.vtk` has the time and the part of `empty.vtp`; give each",
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
    fn wrong_series_are_refused() {
        for (text, expected) in [
            ("{\"files\": []}", "run.series:1: it names no files"),
            ("{\n\"files\": [1]}", "run.series:2: it is no series, `{"),
            ("", "run.series:1: it is no series"),
            (
                "{\"files\":[\n{\"name\": \"b.vtk\"}]}",
                "missing field `time`",
            ),
            (
                "{\"files\":[{\"name\": \"b.vtk\",\"time\":1},\n{\"name\": \"a.vtk\",\"time\":1}]}",
                "run.series:2: `a.vtk` has the time and the part of `b.vtk`",
            ),
        ] {
            let error = read("run.series", text).unwrap_err();
            assert!(error.contains(expected), "{error}\n{expected}");
        }
    }

    #[test]
    fn a_file_without_a_time_is_refused() {
        for name in ["one.vtk", "one.vtp", "one.vtu"] {
            let error = read(name, "").unwrap_err();
            assert!(error.contains(".pvd"), "{error}");
        }
    }
}
