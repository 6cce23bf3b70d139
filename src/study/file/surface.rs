//! Roughness and shapes of a bearing's surfaces as written.

use crate::study::Given;
use crate::study::table::TableFile;
use crate::units::{Angle, Length, Pressure, WearCoefficient};

words! {
    /// One of the two surfaces.
    SurfaceName {
        /// The shell, which stands still in the bearing's frame.
        Shell,
        /// The journal, which turns.
        Journal,
    }
}

words! {
    /// What touching asperities do.
    ContactName {
        /// They carry load and rub (Greenwood and Tripp).
        GreenwoodTripp,
        /// Nothing: roughness only changes the flow.
        None,
    }
}

words! {
    /// How the height integrals of the contact are evaluated.
    ContactIntegralName {
        /// The integrals themselves.
        Exact,
        /// 4.4086e-5 (4 - u)^6.804, in common use; for comparison.
        PowerFit,
        /// Polynomials of degree five; for comparison.
        PolynomialFit,
        /// Exponentials; for comparison.
        ExponentialFit,
    }
}

section! {
    /// Rough surfaces: flow factors after Patir and Cheng, contact after Greenwood and Tripp.
    RoughnessFile {
        /// Root mean square roughness of the journal.
        journal: Length,
        /// Root mean square roughness of the shell.
        shell: Length,
        /// Peklenik number of the journal, 1/9 (ridges across the motion) to 9 (ridges along it). Default 1: no lay.
        journal_peklenik: f64,
        /// Peklenik number of the shell. Default 1.
        shell_peklenik: f64,
        /// "greenwood-tripp" (default) or "none".
        contact: ContactName,
        /// "exact" (default), "power-fit", "polynomial-fit" or "exponential-fit". For contact = "greenwood-tripp", like all below.
        contact_integral: ContactIntegralName,
        /// Elastic factor K of the contact pressure K E F_5/2; or give asperity_product and sigma_over_beta.
        elastic_factor: f64,
        /// Summit density times summit radius times roughness, measured 0.03 to 0.05. Default 0.04.
        asperity_product: f64,
        /// Roughness over summit radius, measured 1e-4 to 1e-2. Default 1e-3.
        sigma_over_beta: f64,
        /// Composite modulus E, 1/E = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2. Default "58.61 GPa": steel (210 GPa, 0.3) on aluminium-tin (70 GPa, 0.33).
        modulus: Pressure,
        /// Spread of the summit heights over the roughness. Default 1: summits taken for all heights.
        summit_sigma_ratio: f64,
        /// Mean height of the summits above the mean plane over the roughness. Default 0.
        summit_height_ratio: f64,
        /// Volume worn off per load and way, K / H of Archard (1953), for the quantity wear-rate. Default "1e-8 mm3/(N m)": lubricated metals under mild wear lie between 1e-10 and 1e-6.
        wear_coefficient: WearCoefficient,
        /// Friction coefficient of touching asperities. Default 0.08: boundary lubrication by an engine oil with usual additives, 0.05 to 0.12.
        boundary_friction: f64,
    }
}

words! {
    /// Kind of a shape. Each says what it adds to the gap; x is the angle from its own angle, zeta runs from -1 to 1 across.
    ShapeKind {
        /// Lemon bore, offset (1 - |cos x|): offset, angle.
        Lemon,
        /// Halves displaced along the split line, offset (1 + sign(sin x) cos x): offset, angle.
        Offset,
        /// Crowned over the width, height zeta^2: height.
        Barrel,
        /// Tapered over the width, height (1 + zeta)/2: height.
        Cone,
        /// Both edges fall off as parabolas: depth, length_share.
        EdgeRelief,
        /// Free form of cubic B-splines: around, across, symmetric, coefficients.
        Spline,
        /// Measured surface: table.
        Table,
    }
}

section! {
    /// What one shape adds to the gap; removed material counts positive.
    ShapeFile {
        /// Name, for parameters and reports.
        name: String,
        /// "lemon", "offset", "barrel", "cone", "edge-relief", "spline" or "table".
        kind: ShapeKind,
        /// "shell" (default) or "journal". On the journal it turns; angles are those in the shell's frame at firing top dead centre.
        on: SurfaceName,
        /// Displacement of each half. For lemon and offset.
        offset: Length,
        /// Middle of one half (lemon), one split line (offset). Default "0 deg".
        angle: Angle,
        /// What is added at both edges (barrel), at the edge zeta = 1 (cone).
        height: Length,
        /// What is added at both edges. For edge-relief.
        depth: Length,
        /// Length of one relief as a share of half the width. For edge-relief.
        length_share: f64,
        /// Coefficients around, 1 or at least 4. For spline.
        around: usize,
        /// Coefficients across: from the mid-plane to the edge if symmetric (at least 3), else from edge to edge (at least 4); 1 is constant across. For spline.
        across: usize,
        /// Whether the spline is symmetric about the mid-plane, which halves the mesh. Default true.
        symmetric: bool,
        /// The coefficients, those across first. Default: all "0 um". For spline.
        coefficients: Vec<Given<Length>>,
        /// Heights on a full grid: columns angle_deg (or angle_rad), zeta and height_um (or height_m). For table.
        table: TableFile,
    }
}
