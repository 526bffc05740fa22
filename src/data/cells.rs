//! The cells of tables of text.

/// A number with all its digits; nothing where it is not a number.
pub(crate) fn cell(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:e}") }
}

/// A cell of words; quotes where it needs them.
pub(crate) fn quoted(word: &str) -> String {
    match word.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", word.replace('"', "\"\"")),
        false => word.to_owned(),
    }
}

/// A table with its header.
///
/// # Arguments
/// * `names` -- of the columns
/// * `rows` -- as many cells each
pub(crate) fn table<'a>(
    names: impl Iterator<Item = &'a str>,
    rows: impl Iterator<Item = Vec<String>>,
) -> String {
    let mut table = names.collect::<Vec<_>>().join(",") + "\n";
    rows.for_each(|cells| table += &(cells.join(",") + "\n"));
    table
}
