//! The integrals against quadrature and tables, the fits against their published errors.

use super::*;
use crate::laws::taylor::assert_slope;

/// `u`, `F_1`, `F_2`, `F_5/2`: adaptive quadrature of the definition to 1e-12, made independently of this crate.
const TABLE: [[f64; 4]; 19] = [
    [0.0, 0.398_942_280_401_432_7, 0.5, 0.616_634_218_996_844],
    [0.25, 0.286_344_698_223_580_16, 0.329_707_499_761_181_3, 0.391_978_458_618_314_5],
    [0.5, 0.197_796_557_401_306_06, 0.209_639_260_025_333_92, 0.240_401_570_674_072_2],
    [0.75, 0.131_166_917_872_153_26, 0.128_252_163_972_753_27, 0.141_962_113_996_199],
    [1.0, 0.083_315_470_587_686_29, 0.075_339_783_343_770_77, 0.080_562_335_570_811_45],
    [1.25, 0.050_586_868_305_452_844, 0.042_416_188_285_039_215, 0.043_856_131_178_713_904],
    [1.5, 0.029_306_793_762_604_637, 0.022_847_010_624_951_123, 0.022_863_056_020_818_076],
    [1.75, 0.016_173_794_314_831_607, 0.011_755_016_812_861_783, 0.011_396_323_941_100_699],
    [2.0, 0.008_490_702_616_829_639, 0.005_768_726_714_519_933, 0.005_423_705_197_484_415],
    [2.25, 0.004_234_588_361_816_834, 0.002_696_648_840_956_828, 0.002_461_241_374_907_523],
    [2.5, 0.002_004_137_179_128_199_7, 0.001_199_322_377_955_636_7, 0.001_063_688_950_133_278_8],
    [2.75, 0.000_899_213_605_191_021_7, 0.000_506_925_820_779_247, 0.000_437_319_996_168_743_3],
    [3.0, 0.000_382_154_317_047_723_74, 0.000_203_435_080_486_923_79, 0.000_170_872_996_214_424_35],
    [3.25, 0.000_153_716_669_529_774_94, 7.744_586_641_899_864e-5, 6.339_309_602_076_971e-5],
    [3.5, 5.848_091_842_142_245e-5, 2.794_586_456_054_65e-5, 2.231_240_719_823_469e-5],
    [3.75, 2.103_086_286_443_089_4e-5, 9.551_549_459_188_047e-6, 7.444_946_246_515_686e-6],
    [4.0, 7.145_258_432_405_664e-6, 3.090_208_103_497_253e-6, 2.353_381_052_587_606_7e-6],
    [4.5, 6.942_120_456_202_023e-7, 2.737_189_194_391_484_5e-7, 1.994_588_387_868_403_6e-7],
    [5.0, 5.346_165_533_832_813e-8, 1.934_329_518_755_315_3e-8, 1.352_592_002_282_947_1e-8],
];

const ALL: [ContactIntegral; 4] = [
    ContactIntegral::Exact,
    ContactIntegral::PowerFit,
    ContactIntegral::PolynomialFit,
    ContactIntegral::ExponentialFit,
];

/// `F_n(u)` by the trapezoidal rule in the root of `s - u`, where the integrand is smooth.
fn exact_integral(n: f64, u: f64) -> f64 {
    let steps = 20_000;
    let width = (12.0 + (-u).max(0.0)).sqrt() / f64::from(steps);
    let integrand = |w: f64| 2.0 * w.powf(2.0 * n + 1.0) * (-0.5 * (u + w * w).powi(2)).exp();
    let sum: f64 = (1..=steps).map(|k| integrand(f64::from(k) * width)).sum();
    sum * width / std::f64::consts::TAU.sqrt()
}

#[test]
fn exact_integrals_meet_the_table_and_the_quadrature() {
    for [u, f1, f2, f52] in TABLE {
        let close = |found: f64, expected: f64, tolerance: f64| {
            assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected} at {u}");
        };
        for (n, expected) in [(1.0, f1), (2.0, f2), (2.5, f52)] {
            close(exact_integral(n, u), expected, 1e-10);
        }
        let (area, slope) = ContactIntegral::Exact.area_integral(u);
        close(area, f2, 1e-10);
        close(-0.5 * slope, f1, 1e-10);
        close(ContactIntegral::Exact.at(u).0, f52, 3e-6);
    }
    for step in 0..=120 {
        let u = -1.0 + 0.05 * f64::from(step);
        let found = ContactIntegral::Exact.at(u).0;
        assert!((found / exact_integral(2.5, u) - 1.0).abs() < 3e-6, "{u}");
    }
}

#[test]
fn hard_contact_is_near_the_integral() {
    for (u, tolerance) in [(-1.5, 2e-3), (-2.0, 0.015), (-3.0, 0.07), (-5.0, 0.3), (-10.0, 1.0)] {
        let ratio = ContactIntegral::Exact.at(u).0 / exact_integral(2.5, u);
        assert!(ratio > 1.0 && ratio < 1.0 + tolerance, "{ratio} at {u}");
    }
    let (value, slope) = ContactIntegral::Exact.at(-1e6);
    assert!(value.is_finite() && slope < 0.0);
}

#[test]
fn switches_are_twice_continuously_differentiable() {
    let slope = |u: f64| ContactIntegral::Exact.at(u).1;
    for u in [-1.0, 5.0, 6.0] {
        let d = 1e-5;
        let (left, here, right) = (slope(u - d), slope(u), slope(u + d));
        let jump = ((right - here) - (here - left)) / d;
        let scale = if u < 0.0 { 1.0 } else { 1e-6 };
        assert!(jump.abs() < 1e-3 * scale, "{jump} at {u}");
    }
    assert_eq!(ContactIntegral::Exact.at(6.0), (0.0, 0.0));
    assert_eq!(ContactIntegral::Exact.at(5.0).0, jet(&LOG_LOAD, 5.0)[0].exp());
    assert!(ContactIntegral::Exact.at(5.99).0 > 0.0);
}

#[test]
fn slopes_pass_the_taylor_test() {
    for integral in ALL {
        for u in [-20.0, -4.0, -1.02, -0.5, 0.0, 0.7, 1.9, 2.6, 3.3, 4.8, 5.4, 5.9, 7.0] {
            assert_slope(|u| integral.at(u).0, u, integral.at(u).1, 2e-3);
            assert_slope(|u| integral.area_integral(u).0, u, integral.area_integral(u).1, 2e-3);
        }
    }
}

#[test]
fn load_falls_and_is_convex() {
    let mut last = (f64::INFINITY, f64::NEG_INFINITY);
    for step in 0..=1500 {
        let now = ContactIntegral::Exact.at(-10.0 + 0.01 * f64::from(step));
        assert!(now.0 < last.0 && now.1 > last.1);
        last = now;
    }
}

#[test]
fn fits_have_their_published_values() {
    // u, F_5/2: PowerFit, PolynomialFit, ExponentialFit; F_2: PowerFit, PolynomialFit (to the digits printed).
    const PRINTED: [[f64; 6]; 9] = [
        [0.0, 5.505e-1, 6.167e-1, 6.189e-1, 4.992e-1, 5.003e-1],
        [0.5, 2.219e-1, 2.405e-1, 2.308e-1, 1.987e-1, 2.097e-1],
        [1.0, 7.774e-2, 8.050e-2, 8.605e-2, 6.858e-2, 7.530e-2],
        [1.5, 2.249e-2, 2.253e-2, 3.209e-2, 1.949e-2, 2.229e-2],
        [2.0, 4.926e-3, 3.900e-3, 1.196e-2, 4.180e-3, 4.500e-3],
        [2.5, 6.957e-4, 0.0, 4.461e-3, 5.742e-4, 0.0],
        [3.0, 4.409e-5, 0.0, 1.664e-3, 3.500e-5, 0.0],
        [3.5, 3.95e-7, 0.0, 6.20e-4, 2.93e-7, 0.0],
        [4.0, 0.0, 0.0, 2.31e-4, 0.0, 0.0],
    ];
    for [u, power, polynomial, exponential, area_power, area_polynomial] in PRINTED {
        let close = |found: f64, printed: f64| {
            let half_digit = if u < 3.4 { 6e-4 } else { 3e-3 };
            assert!((found - printed).abs() <= half_digit * printed, "{found} {printed} at {u}");
        };
        close(ContactIntegral::PowerFit.at(u).0, power);
        close(ContactIntegral::PolynomialFit.at(u).0, polynomial);
        close(ContactIntegral::ExponentialFit.at(u).0, exponential);
        close(ContactIntegral::PowerFit.area_integral(u).0, area_power);
        close(ContactIntegral::PolynomialFit.area_integral(u).0, area_polynomial);
    }
}
