//! The roof: joins the doors and hands the exit code to the system.

fn main() -> std::process::ExitCode {
    stribeck::cli::main()
}
