//! The one proof every law must pass: its slope is the derivative of its value.

/// Asserts that `f(x + d) - f(x) - slope d` falls with the square of `d` (or faster), down to rounding.
///
/// `step` is the largest `d`; a remainder below `1e-13` of the values is rounding and passes (a linear law has nothing
/// else).
#[track_caller]
pub fn assert_slope(f: impl Fn(f64) -> f64, x: f64, slope: f64, step: f64) {
    let value = f(x);
    let remainder = |d: f64| (f(x + d) - value - slope * d).abs();
    let mut previous = remainder(step);
    let mut order = f64::NAN;
    for k in 1..=3 {
        let d = step * 0.5f64.powi(k);
        let next = remainder(d);
        if next <= 1e-13 * (value.abs() + (slope * d).abs()) {
            return;
        }
        order = (previous / next).log2();
        previous = next;
    }
    assert!(order > 1.9, "order {order}, remainder {previous:e} at {x}: value {value}, slope {slope}");
}

#[test]
fn a_wrong_slope_is_found() {
    assert_slope(f64::sin, 0.3, 0.3f64.cos(), 1e-2);
    assert_slope(|x| 3.0 * x - 1.0, 0.3, 3.0, 1e-2);
    for wrong in [0.3f64.cos() * 1.001, 0.0] {
        assert!(std::panic::catch_unwind(|| assert_slope(f64::sin, 0.3, wrong, 1e-2)).is_err());
    }
}
