//! How long a computation will still take, judged by how fast it came so far. An estimate for people who wait, no number of a report.

use super::Event;
use std::time::Instant;

/// Watches the events of one computation.
#[derive(Debug, Clone)]
pub struct Pace {
    began: Instant,
    tolerance: f64,
    first_kkt: Option<f64>,
    left: Option<f64>,
}

impl Pace {
    /// For a search to a tolerance of the residual.
    pub fn new(tolerance: f64) -> Self {
        Self { began: Instant::now(), tolerance, first_kkt: None, left: None }
    }

    /// Takes one piece of news.
    pub fn watch(&mut self, event: &Event) {
        match event {
            Event::Part { done, total } if *done > 0 && total >= done => {
                let each = self.began.elapsed().as_secs_f64() / *done as f64;
                self.left = Some(each * (total - done) as f64);
            }
            // What came before says nothing about what comes now.
            Event::Stage { .. } => self.left = None,
            Event::Iteration(i) if i.kkt.is_finite() => {
                self.left = self.by_residual(i.kkt);
                self.first_kkt.get_or_insert(i.kkt);
            }
            _ => {}
        }
    }

    /// Time since the beginning, s.
    pub fn elapsed_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Time left, s; none while there is nothing to judge by.
    pub fn left_s(&self) -> Option<f64> {
        self.left.map(|s| (10.0 * s).round() / 10.0)
    }

    /// Time left, s, if the residual goes on falling as it did.
    fn by_residual(&self, kkt: f64) -> Option<f64> {
        let first = self.first_kkt.filter(|first| kkt > 0.0 && kkt < *first)?;
        let (done, missing) = ((first / kkt).ln(), (kkt / self.tolerance).max(1.0).ln());
        Some(self.began.elapsed().as_secs_f64() * missing / done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::IterationEvent;

    #[test]
    fn time_left_is_told_once_there_is_something_to_judge_by() {
        let mut pace = Pace::new(1e-6);
        let at = |kkt| {
            let zero = IterationEvent {
                iteration: 0,
                objective_w: 0.0,
                violation: 0.0,
                kkt,
                step: 0.0,
                simulations: 0,
            };
            Event::Iteration(zero)
        };
        pace.watch(&at(1.0));
        assert_eq!(pace.left_s(), None);
        pace.watch(&at(1e-3));
        assert!(pace.left_s().is_some());
        pace.watch(&at(1e-6));
        assert_eq!(pace.left_s(), Some(0.0));
        pace.watch(&Event::Stage { name: "checking the design".to_owned() });
        assert_eq!(pace.left_s(), None);
        pace.watch(&Event::Part { done: 0, total: 4 });
        pace.watch(&Event::Part { done: 4, total: 4 });
        assert_eq!(pace.left_s(), Some(0.0));
    }
}
