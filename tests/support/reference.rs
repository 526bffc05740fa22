//! Tables of `data/reference`, and the largest errors met against them.

/// Rows of a table in `data/reference`, by column name.
pub struct Table {
    names: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    pub fn read(file: &str) -> Self {
        Self::at(&format!("data/reference/{file}"))
    }

    /// A table of its own elsewhere in the repository.
    pub fn at(path: &str) -> Self {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        Self { names: lines.next().unwrap(), rows: lines.collect() }
    }

    pub fn text<'a>(&self, row: &'a [String], name: &str) -> &'a str {
        &row[self.names.iter().position(|known| known == name).unwrap_or_else(|| panic!("no column {name}"))]
    }

    pub fn number(&self, row: &[String], name: &str) -> f64 {
        self.text(row, name).parse().unwrap()
    }
}

/// Largest error met for each quantity, with the row it was met in.
#[derive(Default)]
pub struct Worst(Vec<(&'static str, f64, String)>);

impl Worst {
    pub fn note(&mut self, quantity: &'static str, error: f64, place: &[String]) {
        assert!(!error.is_nan(), "{quantity} is not a number at {place:?}");
        let place = place[..4.min(place.len())].join(", ");
        match self.0.iter_mut().find(|(known, ..)| *known == quantity) {
            Some(entry) if entry.1 < error => *entry = (quantity, error, place),
            Some(_) => {}
            None => self.0.push((quantity, error, place)),
        }
    }

    pub fn below(&self, quantity: &str, tolerance: f64) {
        let (_, error, place) = self.0.iter().find(|(known, ..)| *known == quantity).unwrap();
        println!("{quantity}: {error:.1e} at {place}");
        assert!(*error <= tolerance, "{quantity}: error {error:e} above {tolerance:e} at {place}");
    }
}

pub fn relative(found: f64, expected: f64) -> f64 {
    if found == expected { 0.0 } else { (found / expected - 1.0).abs() }
}
