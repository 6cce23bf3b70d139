//! Laws of rough surfaces: flow between them, contact.
//!
//! Deliberately not here: wear.

use super::entry::{Choice, Entry};

const CONTACT: &str = "contact";
const INTEGRAL: &str = "bearings.NAME.roughness.contact_integral";
const LAW: &str = "bearings.NAME.roughness.contact";

/// Flow between rough surfaces.
pub(in crate::study) static PATIR_CHENG: Entry = Entry {
    topic: "roughness",
    name: "average flow between rough surfaces",
    equation: "flow/width = -phi_x h^3/(12 eta) dp/dx + (u1 + u2)/2 h_T + (u1 - u2)/2 sigma phi_s",
    words: "flow and shear factors of Patir and Cheng (1978, 1979), average gap after Wu and Zheng (1989)",
    sources: &[
        "Patir and Cheng 1978",
        "Patir and Cheng 1979",
        "Wu and Zheng 1989",
        "Fritsch and Carlson 1980",
    ],
    chosen: Choice::Given("[bearings.NAME.roughness]"),
    remark: "Peklenik numbers from 1/9 (ridges across) to 9 (along), coefficients interpolated monotonically \
             between those tabulated; below the validity of a published formula it goes on with the same \
             value and slope, which is no measurement",
    ..Entry::PLAIN
};

/// Greenwood and Tripp.
pub(in crate::study) static GREENWOOD_TRIPP: Entry = Entry {
    topic: CONTACT,
    name: "Greenwood and Tripp",
    equation: "p = K E F_5/2(u), real over nominal area = pi^2 (eta beta sigma)^2 F_2(u), u = (h - \
               delta_s)/sigma_s, tau = mu p",
    words: "Greenwood and Tripp (1971), elastic summits; constant boundary friction coefficient",
    sources: &["Greenwood and Tripp 1971"],
    chosen: Choice::Key(LAW, "greenwood-tripp"),
    default: true,
    remark: "Gaussian heights; sound while the real area is a small share; no cap on the pressure",
};

/// No contact.
static NO_CONTACT: Entry = Entry {
    topic: CONTACT,
    name: "no contact",
    equation: "p = 0",
    chosen: Choice::Key(LAW, "none"),
    remark: "roughness only changes the flow",
    ..Entry::PLAIN
};

/// The integrals themselves.
pub(in crate::study) static EXACT_INTEGRAL: Entry = Entry {
    topic: CONTACT,
    name: "height integrals, exact",
    equation: "F_n(u) = (2 pi)^(-1/2) Int_u^inf (s - u)^n exp(-s^2/2) ds",
    chosen: Choice::Key(INTEGRAL, "exact"),
    default: true,
    remark: "within 3e-6 for -1 <= u <= 5, brought to zero from 5 to 6",
    ..Entry::PLAIN
};

/// Power fit.
pub(in crate::study) static POWER_FIT: Entry = Entry {
    topic: CONTACT,
    name: "height integrals, power fit",
    equation: "F_5/2 = 4.4086e-5 (4 - u)^6.804, F_2 = 3.5e-5 (4 - u)^6.9",
    words: "integral by the power fit of Hu, Cheng, Arai, Kobayashi and Aoyama (1994)",
    sources: &["Hu et al. 1994"],
    chosen: Choice::Key(INTEGRAL, "power-fit"),
    remark: "for comparison: 11 % low at u = 0, 74 % low at u = 3",
    ..Entry::PLAIN
};

/// Polynomial fit.
pub(in crate::study) static POLYNOMIAL_FIT: Entry = Entry {
    topic: CONTACT,
    name: "height integrals, polynomial fit",
    equation: "F_5/2 = 0.6167 - 1.0776 u + 0.7844 u^2 - 0.2958 u^3 + 0.0574 u^4 - 0.0046 u^5",
    words: "integral by a polynomial fit",
    chosen: Choice::Key(INTEGRAL, "polynomial-fit"),
    remark: "for comparison, 0 to 2; zero past the root near 2.25, with a kink there",
    ..Entry::PLAIN
};

/// Exponential fit.
pub(in crate::study) static EXPONENTIAL_FIT: Entry = Entry {
    topic: CONTACT,
    name: "height integrals, exponential fit",
    equation: "F_5/2 = 0.6189 exp(-1.973 u), F_2 = 0.5025 exp(-1.844 u)",
    words: "integral by an exponential fit",
    chosen: Choice::Key(INTEGRAL, "exponential-fit"),
    remark: "for comparison, 0 to 1; 121 % high at u = 2",
    ..Entry::PLAIN
};

/// All of them.
pub(super) static TABLE: &[&Entry] = &[
    &PATIR_CHENG,
    &GREENWOOD_TRIPP,
    &NO_CONTACT,
    &EXACT_INTEGRAL,
    &POWER_FIT,
    &POLYNOMIAL_FIT,
    &EXPONENTIAL_FIT,
];
