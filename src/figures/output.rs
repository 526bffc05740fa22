//! The file of a figure.

use std::path::Path;

use crate::data::AtomicFile;
use crate::error::{Error, Result};
use crate::figures::drawing::{Drawing, Figure, png};

/// Forms of pictures, by the ending of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Svg,
    Png,
}

/// A file for a figure, written as a whole or not at all.
#[derive(Debug)]
pub struct FigureFile {
    file: AtomicFile,
    form: Form,
}

impl FigureFile {
    /// Checks that a picture can be written; creates nothing.
    ///
    /// # Errors
    /// [`Error::File`] if the name does not end in `.svg` or `.png`, the file exists and `overwrite` is not given, or its directory is
    /// missing or cannot be written.
    pub fn new(path: &Path, overwrite: bool) -> Result<Self> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let form = match ending.to_ascii_lowercase().as_str() {
            "svg" => Form::Svg,
            "png" => Form::Png,
            _ => {
                let why = "ends neither in .svg nor in .png; give it the ending of one".into();
                return Err(Error::File { path: path.to_owned(), why });
            }
        };
        Ok(Self { file: AtomicFile::new(path, overwrite)?, form })
    }

    /// Draws and writes.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written, [`Error::Inconsistent`] if the picture is too large.
    pub fn write(mut self, figure: &Figure) -> Result<()> {
        let drawing = Drawing::new(figure, "f");
        match self.form {
            Form::Svg => self.file.write(drawing.svg.as_bytes()),
            Form::Png => self.file.write(&png(&drawing)?),
        }
    }

    /// Where the file is.
    pub fn path(&self) -> &Path {
        self.file.path()
    }
}
