//! What a data set of xarray is made of.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict, PyTuple};

/// One variable or coordinate.
pub(crate) struct Variable {
    name: String,
    dimensions: Vec<String>,
    shape: Vec<usize>,
    values: Values,
    attributes: Vec<(&'static str, Attribute)>,
}

/// The values of a variable, the last dimension fastest.
pub(crate) enum Values {
    Double(Vec<f64>),
    Single(Vec<f32>),
    Integer(Vec<i64>),
    Text(Vec<String>),
}

/// A value beside a variable or a data set.
#[derive(IntoPyObject)]
pub(crate) enum Attribute {
    Text(String),
    Number(f64),
    Integer(i64),
    Truth(bool),
    Integers(Vec<i64>),
}

impl From<&str> for Attribute {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl Variable {
    /// A variable on these dimensions.
    pub(crate) fn new(
        name: impl Into<String>,
        dimensions: &[(&str, usize)],
        values: Values,
    ) -> Self {
        Self {
            name: name.into(),
            dimensions: dimensions
                .iter()
                .map(|(name, _)| (*name).to_owned())
                .collect(),
            shape: dimensions.iter().map(|(_, extent)| *extent).collect(),
            values,
            attributes: Vec::new(),
        }
    }

    /// A coordinate: a variable on a dimension of its own name.
    pub(crate) fn coordinate(name: &str, values: Values) -> Self {
        Self::new(name, &[(name, values.len())], values)
    }

    /// The same with its unit, which is empty or `1` for a pure number, and what it is.
    pub(crate) fn of(self, unit: &str, description: &str) -> Self {
        let unit = if unit.is_empty() { "1" } else { unit };
        self.with("units", unit).with("long_name", description)
    }

    /// The same with a further attribute.
    pub(crate) fn with(mut self, name: &'static str, value: impl Into<Attribute>) -> Self {
        self.attributes.push((name, value.into()));
        self
    }

    /// Dimensions, array and attributes, as xarray takes them.
    fn into_python(self, py: Python<'_>) -> PyResult<(String, Py<PyAny>)> {
        let array = self.values.into_array(py, &self.shape)?;
        let attributes = dictionary(py, self.attributes)?;
        let parts = (PyTuple::new(py, self.dimensions)?, array, attributes);
        Ok((self.name, parts.into_py_any(py)?))
    }
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Double(values) => values.len(),
            Self::Single(values) => values.len(),
            Self::Integer(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// An array of numpy.
    fn into_array<'py>(self, py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
        let numpy = py.import("numpy")?;
        let bytes = |bytes: Vec<u8>, kind: &str| {
            numpy.call_method1("frombuffer", (PyByteArray::new(py, &bytes), kind))
        };
        let array = match self {
            Self::Double(values) => bytes(
                values.iter().flat_map(|it| it.to_ne_bytes()).collect(),
                "f8",
            ),
            Self::Single(values) => bytes(
                values.iter().flat_map(|it| it.to_ne_bytes()).collect(),
                "f4",
            ),
            Self::Integer(values) => bytes(
                values.iter().flat_map(|it| it.to_ne_bytes()).collect(),
                "i8",
            ),
            Self::Text(values) => numpy.call_method1("array", (values, "U")),
        };
        array?.call_method1("reshape", (PyTuple::new(py, shape)?,))
    }
}

/// The parts of a data set.
#[derive(Default)]
pub(crate) struct Table {
    pub(crate) variables: Vec<Variable>,
    pub(crate) coordinates: Vec<Variable>,
    pub(crate) attributes: Vec<(&'static str, Attribute)>,
}

/// As arguments of `xarray.Dataset`: variables, coordinates, attributes.
impl<'py> IntoPyObject<'py> for Table {
    type Target = PyTuple;
    type Output = Bound<'py, PyTuple>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Self::Output> {
        let collect = |variables: Vec<Variable>| {
            let entries = PyDict::new(py);
            for variable in variables {
                let (name, parts) = variable.into_python(py)?;
                entries.set_item(name, parts)?;
            }
            PyResult::Ok(entries)
        };
        let variables = collect(self.variables)?;
        let coordinates = collect(self.coordinates)?;
        (variables, coordinates, dictionary(py, self.attributes)?).into_pyobject(py)
    }
}

fn dictionary<'py>(
    py: Python<'py>,
    entries: Vec<(&'static str, Attribute)>,
) -> PyResult<Bound<'py, PyDict>> {
    let attributes = PyDict::new(py);
    for (name, value) in entries {
        attributes.set_item(name, value)?;
    }
    Ok(attributes)
}
