//! A value of two rough surfaces with its slopes, and the chain rule from film units to the three lengths.
//!
//! Deliberately not here: any law; a law gives functions of `H = gap/sigma`, this file turns them.

/// A value with its partial derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partials {
    /// The value.
    pub value: f64,
    /// Partial derivatives by `[gap_m, sigma_journal_m, sigma_shell_m]`.
    pub by: [f64; 3],
}

/// A value and its slope by `H`.
pub(super) type Slope = (f64, f64);

/// Where two rough surfaces stand: `sigma^2 = sigma_journal^2 + sigma_shell^2`, `H = gap/sigma`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    sigma_m: f64,
    /// `1 / sigma`.
    per_sigma: f64,
    sigmas_m: [f64; 2],
    /// Variance shares of journal and shell, `(sigma_i/sigma)^2`.
    shares: [f64; 2],
    /// Gap over combined roughness.
    pub height: f64,
    /// Whether slopes by the roughnesses are wanted.
    whole: bool,
}

impl Place {
    /// From the nominal gap (any sign) and the two roughnesses, not both zero.
    #[inline(always)]
    pub fn new(gap_m: f64, sigma_journal_m: f64, sigma_shell_m: f64) -> Self {
        let sigma_m = (sigma_journal_m * sigma_journal_m + sigma_shell_m * sigma_shell_m).sqrt();
        let per_sigma = 1.0 / sigma_m;
        let share = |sigma: f64| sigma * sigma / (sigma_m * sigma_m);
        Self {
            sigma_m,
            per_sigma,
            sigmas_m: [sigma_journal_m, sigma_shell_m],
            shares: [share(sigma_journal_m), share(sigma_shell_m)],
            height: gap_m * per_sigma,
            whole: true,
        }
    }

    /// The same place where slopes by the roughnesses may stay zero: a Newton step needs none.
    #[inline(always)]
    pub fn by_gap_only(self) -> Self {
        Self { whole: false, ..self }
    }

    /// `sigma^power * common(H)`.
    #[inline(always)]
    pub fn scaled(&self, power: i32, common: Slope) -> Partials {
        self.shared(power, common, (0.0, 0.0), (0.0, 0.0))
    }

    /// `sigma^power * (common(H) + share_journal * journal(H) + share_shell * shell(H))`.
    #[inline(always)]
    pub fn shared(&self, power: i32, common: Slope, journal: Slope, shell: Slope) -> Partials {
        let mix = |common: f64, journal: f64, shell: f64| {
            common + self.shares[0] * journal + self.shares[1] * shell
        };
        let value = mix(common.0, journal.0, shell.0);
        let slope = mix(common.1, journal.1, shell.1);
        let scale = match power {
            0 => 1.0,
            1 => self.sigma_m,
            -1 => self.per_sigma,
            _ => self.sigma_m.powi(power),
        };
        if !self.whole {
            return Partials { value: scale * value, by: [scale * slope * self.per_sigma, 0.0, 0.0] };
        }
        let spread = f64::from(power) * value - self.height * slope;
        let contrast = 2.0 * (journal.0 - shell.0);
        let by_sigma = |own: usize, sign: f64| {
            scale
                * self.sigmas_m[own]
                * self.per_sigma
                * self.per_sigma
                * (spread + sign * contrast * self.shares[1 - own])
        };
        Partials {
            value: scale * value,
            by: [scale * slope * self.per_sigma, by_sigma(0, 1.0), by_sigma(1, -1.0)],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::taylor::assert_slope;

    #[test]
    fn chain_rule_passes_the_taylor_test() {
        let made = |x: [f64; 3], power: i32| {
            let place = Place::new(x[0], x[1], x[2]);
            let h = place.height;
            place.shared(power, (h.sin(), h.cos()), (h * h, 2.0 * h), (h.exp(), h.exp()))
        };
        for power in -1..=1 {
            let at = [0.7, 0.5, 0.3];
            let found = made(at, power);
            for k in 0..3 {
                let along = |x: f64| {
                    let mut moved = at;
                    moved[k] = x;
                    made(moved, power).value
                };
                assert_slope(along, at[k], found.by[k], 1e-3);
            }
        }
    }
}
