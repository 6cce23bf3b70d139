//! The roof: joins the doors and hands the exit code to the system.

/// A gradient asks for the factors of a whole cycle, hundreds of megabytes, and gives them back; this allocator keeps them for
/// the next one, which spares the system a fresh page for each.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    stribeck::cli::main()
}
