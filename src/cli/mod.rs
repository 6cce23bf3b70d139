//! The command line: `stribeck run | check | schema | gradient | compare | describe | serve | worker | key`.
//!
//! Answers go to standard output, progress and errors to standard error. Colours and progress bars appear on terminals
//! only. Exit codes are part of the interface, see [`exit_code`].

mod commands;
mod compare;
mod describe;
mod design_tables;
mod dry_run;
mod experiment_tables;
mod faults;
mod progress;
mod proof_tables;
mod run;
mod serve;
mod stamp;
mod summaries;
mod tables;
mod told;

use crate::gradient::EngineName;
use crate::optimise::Outcome;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::process::ExitCode;

/// Exit code for files that cannot be read or written.
pub const EXIT_FILE: u8 = 1;
/// Exit code for a study (or command line) with mistakes.
pub const EXIT_STUDY: u8 = 2;

/// Exit code for a characteristic of which rows are missing, or a comparison of which something is.
pub const EXIT_INCOMPLETE: u8 = 8;

/// Exit code for a gradient that is wrong.
pub const EXIT_WRONG_GRADIENT: u8 = 9;

/// Exit code for a figure that the study expects and that was not found.
pub const EXIT_EXPECTED: u8 = 11;

/// Exit code of an outcome: 0 only for a converged design, and for a simulation that was asked for.
pub fn exit_code(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::Converged | Outcome::Simulated => 0,
        Outcome::AlmostConverged => 3,
        Outcome::IterationLimit => 4,
        Outcome::NoProgress => 5,
        Outcome::BudgetSpent => 10,
        Outcome::Infeasible => 6,
        Outcome::StartFailed => 7,
        Outcome::Cancelled => 130,
    }
}

/// Which journal bearing loses the least power to friction, and is still safe?
#[derive(Debug, Parser)]
#[command(
    name = "stribeck",
    version,
    after_help = "Exit codes: 0 converged (or simulated, where no more was asked), 1 file error, 2 mistakes in the study or command line, or reports that cannot be compared, \
3 almost converged, 4 iteration limit, 5 no progress, 6 infeasible, 7 start design cannot be simulated, 8 rows of a characteristic or parts of a comparison are missing, 9 a checked gradient is wrong, 10 budget spent, 11 a figure that the study expects is missed, 130 cancelled."
)]
struct Arguments {
    /// Threads to use [default: one per core]. The numbers do not depend on it.
    #[arg(long, global = true, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Finds the design with the least loss (or tabulates, experiments, or compares the gradient engines) and writes a report; for one study, several or a folder.
    Run(Box<run::RunArguments>),
    /// Checks a study and prints it with every default written out.
    Check(CheckArguments),
    /// Prints the JSON Schema of the study file, or of the report.
    Schema(SchemaArguments),
    /// Computes the gradient at the start design, with one engine or all five side by side, or checks it.
    Gradient(GradientArguments),
    /// Compares two reports of the same kind: what differs in the answer, and which inputs differ.
    Compare(compare::CompareArguments),
    /// Lists laws with their sources, gradient engines, quantities, parameters or search methods.
    Describe(describe::DescribeArguments),
    /// Serves jobs over HTTP, with workers inside.
    Serve(serve::ServeArguments),
    /// Works on the jobs of a database that other processes serve.
    Worker(serve::WorkerArguments),
    /// Makes, lists and takes back keys of the service.
    Key(serve::KeyArguments),
}

#[derive(Debug, Args)]
struct CheckArguments {
    /// Study file, TOML or JSON.
    file: PathBuf,
    /// Print the study, or the list of mistakes, as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct SchemaArguments {
    /// Print the schema of report.json instead: of a design (default), or of another kind of answer.
    #[arg(long, value_enum, num_args = 0..=1, default_missing_value = "design", value_name = "KIND")]
    report: Option<ReportChoice>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ReportChoice {
    Design,
    Characteristic,
    Experiments,
    Comparison,
}

#[derive(Debug, Args)]
struct GradientArguments {
    /// Study file, TOML or JSON.
    file: PathBuf,
    /// Engine [default: the one the study names].
    #[arg(long, value_enum, ignore_case = true)]
    engine: Option<EngineChoice>,
    /// Let the finite differences try perturbations from 1e-3 to 1e-8.
    #[arg(long)]
    sweep: bool,
    /// Check the gradient: TRA against ADJ, differences from 1e-3 to 1e-8 (or those of [comparison]), Taylor remainders both
    /// ways; says whether it is exact, at a kink, noisy or wrong. Ends with exit code 9 if it is wrong.
    #[arg(long, conflicts_with_all = ["engine", "sweep"])]
    check: bool,
    /// Print the comparison as JSON.
    #[arg(long)]
    json: bool,
    /// Write the comparison as JSON to a file.
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum EngineChoice {
    Fw,
    Bw,
    Cen,
    Tra,
    Adj,
    All,
}

impl EngineChoice {
    fn engines(self) -> Vec<EngineName> {
        match self {
            Self::Fw => vec![EngineName::Fw],
            Self::Bw => vec![EngineName::Bw],
            Self::Cen => vec![EngineName::Cen],
            Self::Tra => vec![EngineName::Tra],
            Self::Adj => vec![EngineName::Adj],
            Self::All => EngineName::ALL.to_vec(),
        }
    }
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(count) = arguments.threads.and_then(|n| std::num::NonZeroUsize::new(usize::from(n))) {
        crate::run::use_threads(count);
    }
    let code = match &arguments.command {
        Command::Run(a) => run::run(a),
        Command::Check(a) => commands::check(a),
        Command::Schema(a) => commands::schema(a),
        Command::Gradient(a) => commands::gradient(a),
        Command::Compare(a) => compare::compare(a),
        Command::Describe(a) => describe::describe(a),
        Command::Serve(a) => Ok(serve::run_service(a)),
        Command::Worker(a) => Ok(serve::run_worker(a)),
        Command::Key(a) => Ok(serve::run_keys(a)),
    };
    ExitCode::from(code.unwrap_or_else(|stop| stop.tell()))
}
