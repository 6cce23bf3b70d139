//! Laws of a single-zone working cycle: burnt fraction and heat capacity ratio.

/// Burnt fraction over crank angle, `x = 1 - exp(-a y^(m+1))` with `y = (angle - start) / duration` (Wiebe 1970).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wiebe {
    /// Crank angle at which combustion starts, after firing top dead centre.
    pub start_rad: f64,
    /// Crank angle from start to the nominal end of combustion.
    pub duration_rad: f64,
    /// Shape exponent `m >= 0`: small burns early, large burns late.
    pub shape: f64,
}

impl Wiebe {
    /// `a = ln 1000`: 99.9 % of the fuel has burnt at the nominal end.
    const EFFICIENCY: f64 = 6.907_755_278_982_137;

    /// Burnt fraction at an angle and its derivative by the angle (1/rad).
    pub fn at(&self, angle_rad: f64) -> (f64, f64) {
        let y = (angle_rad - self.start_rad) / self.duration_rad;
        if y <= 0.0 {
            return (0.0, 0.0);
        }
        let power = y.powf(self.shape);
        let rest = (-Self::EFFICIENCY * power * y).exp();
        (1.0 - rest, Self::EFFICIENCY * (self.shape + 1.0) * power * rest / self.duration_rad)
    }
}

/// Ratio of heat capacities of the charge at a temperature, and its derivative by the temperature:
/// `1.338 - 6.0e-5 T + 1.0e-8 T^2` (Brunt, Rai and Emtage 1998, SAE 981052), 300 K to 3000 K.
pub fn heat_capacity_ratio(temperature_k: f64) -> (f64, f64) {
    let t = temperature_k.clamp(300.0, 3000.0);
    let slope = if t == temperature_k { -6.0e-5 + 2.0e-8 * t } else { 0.0 };
    (1.338 - 6.0e-5 * t + 1.0e-8 * t * t, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wiebe_rate_is_the_slope_of_the_burnt_fraction() {
        let law = Wiebe { start_rad: -0.2, duration_rad: 1.1, shape: 0.8 };
        for angle in [-0.1, 0.2, 0.7, 1.5] {
            let (x, rate) = law.at(angle);
            let remainder = |d: f64| (law.at(angle + d).0 - x - rate * d).abs();
            let order = (remainder(1e-3) / remainder(5e-4)).log2();
            assert!((order - 2.0).abs() < 0.05, "order {order}");
        }
        assert_eq!(law.at(-0.3), (0.0, 0.0));
        assert!((law.at(0.9).0 - 0.999).abs() < 1e-12);
    }

    #[test]
    fn heat_capacity_ratio_slope_passes_the_taylor_test() {
        let (value, slope) = heat_capacity_ratio(1200.0);
        let remainder = |d: f64| (heat_capacity_ratio(1200.0 + d).0 - value - slope * d).abs();
        assert!(((remainder(20.0) / remainder(10.0)).log2() - 2.0).abs() < 1e-3);
        assert_eq!(heat_capacity_ratio(100.0).1, 0.0);
    }
}
