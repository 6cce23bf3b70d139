//! The commands of the service: `serve`, `worker`, `key`.

use crate::service::store::{Store, StoreError};
use crate::service::{Limits, ServeOptions, ServiceError, WorkerOptions, serve, serve_jobs};
use clap::{Args, Subcommand, ValueEnum};
use std::net::SocketAddr;
use std::time::Duration;
use tracing_subscriber::EnvFilter;

/// Database if nothing else is said.
const DATABASE: &str = "sqlite:stribeck.db";

#[derive(Debug, Args)]
pub(super) struct DatabaseArguments {
    /// sqlite:FILE, or postgres://USER:PASSWORD@HOST/NAME.
    #[arg(long, env = "STRIBECK_DATABASE", default_value = DATABASE, hide_env_values = true)]
    database: String,
}

/// Form of the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum LogFormat {
    /// For people.
    Text,
    /// For programs, a JSON object a line.
    Json,
}

#[derive(Debug, Args)]
pub(super) struct LogArguments {
    /// Form of the log on standard error.
    #[arg(long, value_enum, default_value = "text")]
    log_format: LogFormat,
    /// What is logged: error, warn, info, debug, or a filter like info,tower_http=debug.
    #[arg(long, default_value = "info", value_parser = filter)]
    log: String,
}

#[derive(Debug, Args)]
pub(super) struct SlotArguments {
    /// Jobs at a time.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u16).range(..=256))]
    slots: u16,
    /// Seconds a job may take.
    #[arg(long, default_value_t = 3600, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..))]
    wall_time: u64,
    /// Seconds after which a job of a worker that is not heard of goes to another.
    #[arg(long, default_value_t = 15, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..))]
    lease: u64,
}

#[derive(Debug, Args)]
pub(super) struct ServeArguments {
    /// Where to listen. Beyond this machine only with keys.
    #[arg(long, default_value = "127.0.0.1:8080", value_parser = address)]
    address: SocketAddr,
    #[command(flatten)]
    database: DatabaseArguments,
    /// Ask for keys on this machine, too.
    #[arg(long, conflicts_with = "no_keys")]
    keys: bool,
    /// Ask for no keys (on this machine that is the default).
    #[arg(long)]
    no_keys: bool,
    #[command(flatten)]
    slots: SlotArguments,
    /// Requests a second and key; 0 for any number.
    #[arg(long, value_name = "COUNT")]
    rate: Option<u32>,
    /// Jobs of one key that may wait or run.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..))]
    open_jobs: Option<u32>,
    #[command(flatten)]
    log: LogArguments,
}

#[derive(Debug, Args)]
pub(super) struct WorkerArguments {
    #[command(flatten)]
    database: DatabaseArguments,
    #[command(flatten)]
    slots: SlotArguments,
    #[command(flatten)]
    log: LogArguments,
}

#[derive(Debug, Args)]
pub(super) struct KeyArguments {
    #[command(flatten)]
    database: DatabaseArguments,
    #[command(subcommand)]
    command: KeyCommand,
}

#[derive(Debug, Subcommand)]
enum KeyCommand {
    /// Makes a key and prints it, once.
    Create {
        /// Whose it is.
        #[arg(value_parser = key_name)]
        name: String,
    },
    /// Lists keys by id.
    List,
    /// Takes a key back; its jobs stay.
    Revoke {
        /// Id, as in the list.
        id: String,
    },
    /// Prints the last entries of the log of who did what.
    Log {
        /// How many.
        #[arg(long, default_value_t = 50)]
        last: u32,
    },
}

impl SlotArguments {
    fn options(&self) -> WorkerOptions {
        WorkerOptions {
            slots: usize::from(self.slots),
            lease: Duration::from_secs(self.lease),
            wall_time: Duration::from_secs(self.wall_time),
            ..WorkerOptions::default()
        }
    }
}

impl LogArguments {
    fn start(&self) {
        let filter = EnvFilter::new(&self.log);
        let colours = std::io::IsTerminal::is_terminal(&std::io::stderr());
        let log =
            tracing_subscriber::fmt().with_env_filter(filter).with_ansi(colours).with_writer(std::io::stderr);
        match self.log_format {
            LogFormat::Text => log.with_target(false).init(),
            LogFormat::Json => log.json().init(),
        }
    }
}

/// A filter of the log.
fn filter(text: &str) -> Result<String, String> {
    let word = |w: &str| ["off", "error", "warn", "info", "debug", "trace"].contains(&w);
    let all = text.split(',').all(|part| match part.split_once('=') {
        Some((target, level)) => !target.is_empty() && word(level),
        None => word(part),
    });
    if all {
        Ok(text.to_owned())
    } else {
        Err("give error, warn, info or debug, or a filter like info,tower_http=debug".to_owned())
    }
}

/// The name of a key.
fn key_name(text: &str) -> Result<String, String> {
    let fits = (1..=100).contains(&text.chars().count()) && !text.chars().any(char::is_control);
    if fits { Ok(text.to_owned()) } else { Err("give 1 to 100 visible characters".to_owned()) }
}

/// An address with its port, by number or by name.
fn address(text: &str) -> Result<SocketAddr, String> {
    use std::net::ToSocketAddrs;
    let words = |e: std::io::Error| format!("{e}; give one like 127.0.0.1:8080");
    let mut found = text.to_socket_addrs().map_err(words)?;
    found.next().ok_or_else(|| "names no machine".to_owned())
}

/// Runs something asynchronous to its end.
fn wait<T>(work: impl Future<Output = Result<T, ServiceError>>) -> Result<T, ServiceError> {
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let found = runtime.block_on(work);
    // A computation that did not come to a safe place in time is left behind.
    runtime.shutdown_timeout(Duration::from_millis(100));
    found
}

fn code(found: Result<(), ServiceError>) -> u8 {
    match found {
        Ok(()) => 0,
        Err(e) => {
            eprintln!("error: {e}");
            match e {
                ServiceError::Open(_) => super::EXIT_STUDY,
                _ => super::EXIT_FILE,
            }
        }
    }
}

pub(super) fn run_service(a: &ServeArguments) -> u8 {
    a.log.start();
    let keys = if a.keys { Some(true) } else { a.no_keys.then_some(false) };
    let mut limits = Limits::default();
    // Without keys all requests of this machine count as one caller's.
    limits.requests_per_s = match a.rate {
        Some(rate) => Some(rate).filter(|rate| *rate > 0),
        None => limits.requests_per_s.filter(|_| keys.unwrap_or(!a.address.ip().is_loopback())),
    };
    if let Some(most) = a.open_jobs {
        limits.open_jobs = i64::from(most);
    }
    let options = ServeOptions {
        address: a.address,
        database: a.database.database.clone(),
        keys,
        workers: a.slots.options(),
        limits,
    };
    code(wait(serve(options, |address| println!("stribeck serves at http://{address}/"))))
}

pub(super) fn run_worker(a: &WorkerArguments) -> u8 {
    a.log.start();
    code(wait(serve_jobs(&a.database.database, a.slots.options())))
}

pub(super) fn run_keys(a: &KeyArguments) -> u8 {
    let mut missing = false;
    let found = wait(async {
        let store = Store::open(&a.database.database).await?;
        let found = keys(&store, &a.command).await;
        store.close().await;
        match found? {
            Some(text) => print!("{text}"),
            None => missing = true,
        }
        Ok(())
    });
    if missing {
        eprintln!("error: there is no valid key of this id; 'stribeck key list' tells which there are");
        return super::EXIT_STUDY;
    }
    code(found)
}

/// What a command tells; none if its key does not exist.
async fn keys(store: &Store, command: &KeyCommand) -> Result<Option<String>, StoreError> {
    let time = |ms: i64| jiff::Timestamp::from_millisecond(ms).map(|t| t.to_string()).unwrap_or_default();
    match command {
        KeyCommand::Create { name } => {
            let key = store.new_key(name).await?;
            Ok(Some(format!("{}\n", key.secret)))
        }
        KeyCommand::List => {
            let row = |k: crate::service::store::KeyRow| {
                let state =
                    k.revoked_ms.map_or_else(|| "valid".to_owned(), |ms| format!("revoked {}", time(ms)));
                format!("{}  {}  {state}  {}\n", k.id, time(k.created_ms), k.name)
            };
            Ok(Some(store.keys().await?.into_iter().map(row).collect()))
        }
        KeyCommand::Revoke { id } => {
            let done = store.revoke_key(id).await?;
            Ok(done.then(|| format!("revoked {id}\n")))
        }
        KeyCommand::Log { last } => {
            let row = |(ms, owner, action, job): (i64, String, String, Option<String>)| {
                format!("{}  {owner}  {action}  {}\n", time(ms), job.unwrap_or_default())
            };
            Ok(Some(store.audited(i64::from(*last)).await?.into_iter().map(row).collect()))
        }
    }
}
