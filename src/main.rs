//! The program `fretwear`.

fn main() -> std::process::ExitCode {
    fretwear::cli::main(std::env::args_os()).into()
}
