//! Progress of one study or of many: lines on a terminal with what is running, objective and violation so far and the time left; for
//! programs every event as a line of JSON; silence elsewhere.

use crate::report::short;
use crate::run::{Event, Pace, Progress};
use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::io::Write;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Where progress goes.
pub(super) enum Display {
    /// To people at a terminal.
    Terminal(MultiProgress),
    /// To a program, on standard output.
    JsonLines,
}

impl Display {
    /// That of a run.
    pub fn new(json_lines: bool) -> Self {
        match json_lines {
            true => Self::JsonLines,
            // indicatif draws on standard error and only if that is a terminal.
            false => Self::Terminal(MultiProgress::with_draw_target(ProgressDrawTarget::stderr())),
        }
    }

    /// A line of its own for a study; `named`: with its name, because there are others.
    pub fn study(&self, name: &str, named: bool, most_iterations: u64, tolerance: f64) -> Bars {
        let out = match self {
            Self::JsonLines => Out::Lines { study: name.to_owned() },
            Self::Terminal(all) => {
                let bar = all.add(ProgressBar::no_length());
                if let Ok(style) = ProgressStyle::with_template("{spinner} {elapsed} {prefix}{msg}") {
                    bar.set_style(style);
                }
                if named {
                    bar.set_prefix(format!("{name}: "));
                }
                bar.enable_steady_tick(Duration::from_millis(120));
                Out::Bar(bar)
            }
        };
        Bars { out, most_iterations, news: Mutex::new((News::default(), Pace::new(tolerance))) }
    }

    /// Tells the end of a study to a program.
    pub fn end(&self, study: &str, of: Value) {
        if let Self::JsonLines = self {
            let mut line = json!({ "event": "end", "study": study });
            if let (Some(line), Value::Object(of)) = (line.as_object_mut(), of) {
                line.extend(of);
            }
            print_line(&line);
        }
    }
}

/// One whole line; a closed pipe is the reader's choice, not an error.
fn print_line(line: &Value) {
    let _ = writeln!(std::io::stdout().lock(), "{line}");
}

enum Out {
    Bar(ProgressBar),
    Lines { study: String },
}

/// The news of one study.
pub(super) struct Bars {
    out: Out,
    most_iterations: u64,
    news: Mutex<(News, Pace)>,
}

#[derive(Default)]
struct News {
    stage: String,
    simulations: u64,
    film_um: Option<f64>,
    search: String,
}

impl Bars {
    /// For a computation that is alone.
    pub fn alone(most_iterations: u64, tolerance: f64) -> Self {
        Display::new(false).study("", false, most_iterations, tolerance)
    }

    pub fn finish(&self) {
        if let Out::Bar(bar) = &self.out {
            bar.finish_and_clear();
        }
    }
}

impl News {
    fn take(&mut self, event: &Event, most_iterations: u64) {
        match event {
            Event::Stage { name } => self.stage.clone_from(name),
            Event::Part { done, total } => self.stage = format!("{done} of {total} runs done"),
            Event::Simulated { simulations, .. } => self.simulations = *simulations,
            Event::Film { min_thickness_um } => self.film_um = Some(*min_thickness_um),
            Event::Iteration(i) => {
                self.search = format!(
                    ", iteration {} of at most {most_iterations}: {} W, violation {:.1e}, KKT {:.1e}",
                    i.iteration,
                    short(i.objective_w),
                    i.violation,
                    i.kkt
                );
            }
        }
    }

    fn text(&self, left_s: Option<f64>) -> String {
        let simulated = match self.simulations {
            0 => String::new(),
            n => format!(", {n} cycles simulated"),
        };
        let film = self.film_um.map_or_else(String::new, |um| format!(", film {} um", short(um)));
        let left =
            left_s.filter(|s| *s >= 1.0).map_or_else(String::new, |s| format!(", about {} left", span(s)));
        format!("{}{simulated}{}{film}{left}", self.stage, self.search)
    }
}

/// A time people wait.
pub(super) fn span(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 5400.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

impl Progress for Bars {
    fn tell(&self, event: &Event) {
        let mut state = self.news.lock().unwrap_or_else(PoisonError::into_inner);
        let (news, pace) = &mut *state;
        pace.watch(event);
        match &self.out {
            Out::Bar(bar) => {
                news.take(event, self.most_iterations);
                bar.set_message(news.text(pace.left_s()));
            }
            Out::Lines { study } => {
                let mut line = serde_json::to_value(event).unwrap_or_default();
                line["study"] = json!(study);
                line["seconds"] = json!((1e3 * pace.elapsed_s()).round() / 1e3);
                line["seconds_left"] = json!(pace.left_s());
                print_line(&line);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::span;

    #[test]
    fn times_are_told_as_people_do() {
        assert_eq!([7.4, 130.0, 5000.0, 9000.0].map(span), ["7 s", "2 min", "83 min", "2.5 h"]);
    }
}
