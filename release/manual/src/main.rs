//! Writes the manual pages of `jurist`, one for the program and one for each command, into a folder.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

use clap::Command;
use clap_mangen::Man;
use std::io::{Error, Write};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut arguments = std::env::args_os().skip(1);
    let (Some(folder), None) = (arguments.next(), arguments.next()) else {
        eprintln!("usage: jurist-manual FOLDER");
        return ExitCode::from(2);
    };
    match write(Path::new(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", Path::new(&folder).display());
            ExitCode::FAILURE
        }
    }
}

fn write(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder)?;
    let mut program = jurist::cli::command();
    // Commands get the names of their pages, `jurist-map`, and options that all of them share.
    program.build();
    // `jurist-check` is the checker of certificates, a program of its own; the command that reads models has another page.
    program = program.mut_subcommand("check", |command| command.name("check-model").display_name("jurist-check-model"));
    page(folder, "jurist", &program)?;
    for command in program.get_subcommands().filter(|command| !command.is_hide_set()) {
        page(folder, &format!("jurist-{}", command.get_name()), command)?;
    }
    Ok(())
}

fn page(folder: &Path, name: &str, command: &Command) -> Result<(), Error> {
    let mut text = Vec::new();
    Man::new(command.clone())
        .title(name)
        .source(format!("jurist {}", env!("CARGO_PKG_VERSION")))
        .manual("jurist")
        .render(&mut text)?;
    std::fs::File::create(folder.join(format!("{name}.1")))?.write_all(&text)
}
