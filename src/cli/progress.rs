//! Progress on a terminal: what is running, objective and violation so far. Silent elsewhere.

use crate::report::short;
use crate::run::{Event, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::Mutex;
use std::time::Duration;

/// A spinner with the latest news.
pub(super) struct Bars {
    bar: ProgressBar,
    most_iterations: u64,
    news: Mutex<News>,
}

#[derive(Default)]
struct News {
    stage: String,
    simulations: u64,
    film_um: Option<f64>,
    search: String,
}

impl Bars {
    pub fn new(most_iterations: u64) -> Self {
        // indicatif draws on standard error and only if that is a terminal.
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {msg}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Self { bar, most_iterations, news: Mutex::default() }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Progress for Bars {
    fn tell(&self, event: &Event) {
        let mut news = self.news.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        match event {
            Event::Stage { name } => news.stage.clone_from(name),
            Event::Simulated { simulations, .. } => news.simulations = *simulations,
            Event::Film { min_thickness_um } => news.film_um = Some(*min_thickness_um),
            Event::Iteration(i) => {
                news.search = format!(
                    ", iteration {} of at most {}: {} W, violation {:.1e}, KKT {:.1e}",
                    i.iteration,
                    self.most_iterations,
                    short(i.objective_w),
                    i.violation,
                    i.kkt
                );
            }
        }
        let simulated = match news.simulations {
            0 => String::new(),
            n => format!(", {n} cycles simulated"),
        };
        let film = news.film_um.map_or_else(String::new, |um| format!(", film {} um", short(um)));
        self.bar.set_message(format!("{}{simulated}{}{film}", news.stage, news.search));
    }
}
