//! The `jurist` program: hands the command line to [`jurist::cli`] and returns its exit status.

fn main() -> std::process::ExitCode {
    jurist::cli::main()
}
