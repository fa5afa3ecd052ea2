//! Scenes and sweeps as dicts and paths.

use crate::error::Failure;
use phase::document::LoadError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// How errors call the text of a dict. Its paths are relative to the current folder.
const NAME: &str = "<dict>";

/// Where a scene or a sweep is stated.
pub(crate) enum Source {
    File(PathBuf),
    Text(String),
}

impl<'py> FromPyObject<'_, 'py> for Source {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match object.cast::<PyDict>() {
            Ok(dict) => Ok(Self::Text(to_toml(&dict)?)),
            Err(_) => Ok(Self::File(object.extract()?)),
        }
    }
}

impl Source {
    /// Reads what is stated, by one function for a file and one for a text.
    pub(crate) fn read<T>(
        &self,
        file: impl FnOnce(&Path) -> Result<T, LoadError>,
        text: impl FnOnce(&str, &Path) -> Result<T, LoadError>,
    ) -> Result<T, Failure> {
        let read = match self {
            Self::File(path) => file(path),
            Self::Text(content) => text(content, Path::new(NAME)),
        };
        read.map_err(Failure::of_text)
    }
}

/// The TOML text of a dict: what a scene or a sweep in a dict stands for.
#[pyfunction]
pub(crate) fn to_toml(dict: &Bound<'_, PyDict>) -> PyResult<String> {
    let table = table_of(dict, "")?;
    Ok(toml::to_string(&table).map_err(Failure::refused)?)
}

/// Tables and lists inside each other, at most. A dict that holds itself has no end.
const DEEPEST: usize = 40;

fn table_of(dict: &Bound<'_, PyDict>, path: &str) -> PyResult<Table> {
    let entries = dict.iter().map(|(key, value)| {
        let Ok(name) = key.extract::<String>() else {
            let message = format!("{NAME}: `{path}` has a key that is no text: {key}");
            return Err(Failure::refused(message).into());
        };
        let path = match path {
            "" => name.clone(),
            path => format!("{path}.{name}"),
        };
        Ok((name, value_of(&value, &path)?))
    });
    entries.collect()
}

fn value_of(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Value> {
    if path.matches(['.', '[']).count() > DEEPEST {
        let message = format!("{NAME}: more than {DEEPEST} tables lie inside each other");
        return Err(Failure::refused(message).into());
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        return Ok(Value::Table(table_of(dict, path)?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let entries = value.try_iter()?.enumerate();
        let entries = entries.map(|(place, entry)| value_of(&entry?, &format!("{path}[{place}]")));
        return Ok(Value::Array(entries.collect::<PyResult<_>>()?));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        // Beyond 64 bits: valid as a number, but refused as an integer.
        let integer = value.extract().map(Value::Integer);
        return integer.or_else(|_| Ok(Value::Float(value.extract()?)));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::String(value.extract()?));
    }
    // Numbers and arrays of numpy.
    if value.hasattr("tolist")? {
        return value_of(&value.call_method0("tolist")?, path);
    }
    if value.hasattr("__fspath__")? {
        return value_of(&value.call_method0("__fspath__")?, path);
    }
    let kind = value.get_type().name()?;
    let help = match value.is_none() {
        true => "leave the key out",
        false => "give a number, a text, a truth value, a list or a dict",
    };
    Err(
        Failure::refused(format_args!("{NAME}: `{path}` is of type {kind}"))
            .help(help)
            .into(),
    )
}
