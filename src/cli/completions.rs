//! `fretwear completions` and `fretwear man`: what shells and `man` know of the command line, made from its definition.

use std::path::PathBuf;

use crate::data::{Mark, check_own, make_folder};
use crate::report::TableFile;
use crate::{Error, Result};
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;

#[derive(Args)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Args)]
pub struct Man {
    /// Directory for fretwear.1 and a page of each subcommand, made if it is missing; without it the main page goes to stdout
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Overwrite pages that exist
    #[arg(long, requires = "output")]
    force: bool,
}

/// The script that a shell reads.
pub fn completions<C: CommandFactory>(arguments: &Completions) -> String {
    let mut script = vec![];
    clap_complete::generate(arguments.shell, &mut C::command(), "fretwear", &mut script);
    String::from_utf8(script).expect("made of UTF-8 strings")
}

/// Writes the pages; the main one is returned where no directory is given.
pub fn man<C: CommandFactory>(arguments: &Man) -> Result<String> {
    let mut command = C::command();
    command.build();
    let Some(folder) = &arguments.output else { return page(command) };
    let subcommands = command.get_subcommands().filter(|it| !it.is_hide_set() && it.get_name() != "help");
    let pages: Vec<(String, Command)> = subcommands
        .map(|it| (format!("fretwear-{}.1", it.get_name()), it.clone()))
        .chain([("fretwear.1".to_owned(), command.clone())])
        .collect();
    make_folder(folder)?;
    let file = |name: &String| {
        let path = folder.join(name);
        let file = TableFile::new(&path, arguments.force)?;
        check_own(&path, Mark::Words(".TH fretwear")).map(|()| file)
    };
    let files: Vec<TableFile> = pages.iter().map(|(name, _)| file(name)).collect::<Result<_>>()?;
    for (file, (_, command)) in files.into_iter().zip(pages) {
        file.write(&page(command)?)?;
    }
    Ok(String::new())
}

fn page(command: Command) -> Result<String> {
    let mut text = vec![];
    clap_mangen::Man::new(command)
        .render(&mut text)
        .map_err(|error| Error::File { path: "manual page".into(), why: error.to_string() })?;
    Ok(String::from_utf8(text).expect("made of UTF-8 strings"))
}
