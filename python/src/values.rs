//! Values of Python as those of TOML.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};
use toml::{Table, Value};

use crate::errors::refused;

/// A dictionary as a table; keys may be dotted, and what is None is left out.
pub fn table(given: &Bound<PyDict>, path: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in given {
        if value.is_none() {
            continue;
        }
        let key: String = key.extract().map_err(|_| PyTypeError::new_err("keys of a scene are strings"))?;
        let name = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let mut inner = &mut table;
        let (tables, last) = key.rsplit_once('.').unwrap_or(("", &key));
        for part in tables.split('.').filter(|part| !part.is_empty()) {
            let found = inner.entry(part).or_insert_with(|| Value::Table(Table::new()));
            let found = found.as_table_mut();
            inner = found.ok_or_else(|| refused(given.py(), &name, "stands below a key with a value"))?;
        }
        let value = self::value(&value, &name)?;
        match (inner.get_mut(last), value) {
            // A dotted key may have come before its table.
            (Some(Value::Table(before)), Value::Table(more)) => before.extend(more),
            (_, value) => drop(inner.insert(last.to_owned(), value)),
        }
    }
    Ok(table)
}

/// A number, text, truth value, list or dictionary; NumPy's scalars and arrays are those of Python.
pub fn value(given: &Bound<PyAny>, name: &str) -> PyResult<Value> {
    if given.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(given.extract()?));
    }
    if given.is_instance_of::<PyInt>() {
        let whole: Result<i64, _> = given.extract();
        return whole.map(Value::Integer).map_err(|_| refused(given.py(), name, "is too large a number"));
    }
    if given.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(given.extract()?));
    }
    if given.is_instance_of::<PyString>() {
        return Ok(Value::String(given.extract()?));
    }
    if let Ok(inner) = given.cast::<PyDict>() {
        return table(inner, name).map(Value::Table);
    }
    if let Ok(plain) = given.call_method0("tolist") {
        return value(&plain, name);
    }
    if let Ok(path) = given.call_method0("__fspath__") {
        return value(&path, name);
    }
    let entries = given
        .try_iter()
        .map_err(|_| refused(given.py(), name, &format!("cannot be a {}", given.get_type())))?;
    let entries = entries.enumerate().map(|(at, entry)| value(&entry?, &format!("{name}[{at}]")));
    entries.collect::<PyResult<_>>().map(Value::Array)
}
