//! Folders of results, and the cells of tables in them.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::atomic::{AtomicFile, failure};
use super::reader::format_of;
use super::scratch::Scratch;
use crate::error::{Error, Result};

/// How a file is known for this program's own.
#[derive(Debug, Clone, Copy)]
pub enum Mark {
    /// A result file of any kind.
    Results,
    /// These words stand at its beginning.
    Words(&'static str),
}

/// Bytes among which the words of a mark stand.
const BEGINNING: u64 = 4096;

impl Mark {
    /// Whether a regular file bears it.
    fn is_on(self, path: &Path) -> bool {
        match self {
            Self::Results => format_of(path).is_ok(),
            Self::Words(words) => {
                let mut start = vec![];
                let file = File::open(path).map(|file| file.take(BEGINNING));
                file.is_ok_and(|mut file| file.read_to_end(&mut start).is_ok())
                    && start.windows(words.len()).any(|it| it == words.as_bytes())
            }
        }
    }
}

/// Refuses to replace a file whose name the user did not give, unless this program wrote it.
///
/// # Errors
/// [`Error::File`] names it and the cure.
pub fn check_own(path: &Path, mark: Mark) -> Result<()> {
    match path.is_file() && !mark.is_on(path) {
        false => Ok(()),
        true => Err(Error::File {
            path: path.to_owned(),
            why: "exists and was not written by fretwear, so that it is replaced only where it is named; move it away, or choose another output"
                .into(),
        }),
    }
}

/// Refuses an output that is the file it is made from.
///
/// # Errors
/// [`Error::File`] names it.
pub fn check_distinct(output: &Path, input: &Path) -> Result<()> {
    match output.canonicalize().is_ok_and(|output| input.canonicalize().is_ok_and(|input| input == output)) {
        false => Ok(()),
        true => Err(Error::File {
            path: output.to_owned(),
            why: "is the very file that is read, which its output would replace; name another output".into(),
        }),
    }
}

/// Makes a directory if it is missing.
///
/// # Errors
/// [`Error::File`] names it.
pub fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| {
        let why = match folder.symlink_metadata() {
            Ok(found) if found.is_symlink() && !folder.exists() => "is a link that leads nowhere",
            Ok(_) if !folder.is_dir() => "is no directory; name one",
            _ => return failure(folder, &error),
        };
        Error::File { path: folder.to_owned(), why: why.into() }
    })
}

/// Makes a directory if it is missing, and checks that all files can be written there; creates no file. Those that exist are replaced only with
/// `overwrite`, and only if they are this program's own.
///
/// # Errors
/// [`Error::File`] names the file or the directory and the cure.
pub(crate) fn check_folder(folder: &Path, files: &[(&str, Mark)], overwrite: bool) -> Result<()> {
    make_folder(folder)?;
    files.iter().try_for_each(|(name, mark)| {
        let path = folder.join(name);
        AtomicFile::new(&path, overwrite)?;
        check_own(&path, *mark)
    })
}

/// Checks that a directory that may be missing can be made and written; makes nothing.
///
/// # Errors
/// [`Error::File`] names it and the cure.
pub(crate) fn check_can_be_made(folder: &Path) -> Result<()> {
    let parents = folder.ancestors().map(|it| if it == Path::new("") { Path::new(".") } else { it });
    let there = parents.into_iter().find(|it| it.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
    if !there.is_dir() {
        return make_folder(there);
    }
    Scratch::new(there, "a check").map(drop).map_err(|error| failure(there, &error))
}
