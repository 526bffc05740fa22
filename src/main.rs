//! The program `fretwear`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::main()
}
