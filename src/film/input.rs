//! What a film depends on and what it answers, as values, as changes and as derivatives.

/// Number of scalars in a [`FilmInput`].
pub const INPUTS: usize = 14;
/// Number of scalars in a [`FilmOutput`].
pub const OUTPUTS: usize = 12;

/// Everything the film depends on at one instant, apart from the shape of its surfaces; the same shape carries changes
/// and derivatives of these quantities.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FilmInput {
    /// Position of the journal's centre in the shell frame, m.
    pub eccentricity_m: [f64; 2],
    /// Inclination of the journal's axis against the shell's: at `z` the centre stands at `e + z tilt`, rad.
    pub tilt_rad: [f64; 2],
    /// Velocity of the journal's centre in the shell frame, m/s. Films with a content take their squeeze from its rate.
    pub velocity_m_s: [f64; 2],
    /// Angular speed of the journal relative to the shell, rad/s.
    pub speed_rad_s: f64,
    /// Width of the bearing, m.
    pub width_m: f64,
    /// Diameter of the bearing, m.
    pub diameter_m: f64,
    /// Radial clearance, m.
    pub clearance_m: f64,
    /// Dynamic viscosity at the film's temperature, at ambient pressure and low shear, Pa s.
    pub viscosity_pa_s: f64,
    /// Root mean square roughness of the journal, m. Used by films with rough surfaces.
    pub journal_roughness_m: f64,
    /// Root mean square roughness of the shell, m.
    pub shell_roughness_m: f64,
    /// Pressure of the oil supply above the surroundings, Pa.
    pub supply_pressure_pa: f64,
}

/// What the film answers; the same shape carries changes and weights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct FilmOutput {
    /// Force of film and contact on the journal, N.
    pub force_n: [f64; 2],
    /// Moment of film and contact about the shell's centre, against the two tilts, N m.
    pub moment_n_m: [f64; 2],
    /// Hydrodynamic friction loss: power of the wall shear stress on the journal, W.
    pub loss_w: f64,
    /// Friction loss of asperity contact, W.
    pub contact_loss_w: f64,
    /// Power dissipated in the oil: the wall power less the squeeze power, W.
    pub dissipation_w: f64,
    /// Smallest gap, m.
    pub gap_min_m: f64,
    /// Smooth maximum of the film pressure over the bearing (above the exact one), Pa.
    pub pressure_peak_pa: f64,
    /// Smooth maximum of the contact pressure, Pa.
    pub contact_peak_pa: f64,
    /// Net flow of oil out of both edges, m3/s.
    pub side_flow_m3_s: f64,
    /// Contact pressure times sliding speed, W/m2, summed over the cells with the site's marks as weights.
    pub rubbing_w_m2: f64,
}

impl FilmInput {
    /// The scalars in a fixed order.
    pub fn to_array(&self) -> [f64; INPUTS] {
        let ([ex, ey], [tx, ty], [vx, vy]) = (self.eccentricity_m, self.tilt_rad, self.velocity_m_s);
        [
            ex,
            ey,
            tx,
            ty,
            vx,
            vy,
            self.speed_rad_s,
            self.width_m,
            self.diameter_m,
            self.clearance_m,
            self.viscosity_pa_s,
            self.journal_roughness_m,
            self.shell_roughness_m,
            self.supply_pressure_pa,
        ]
    }

    /// The input from scalars in the order of [`Self::to_array`].
    pub fn from_array(a: [f64; INPUTS]) -> Self {
        Self {
            eccentricity_m: [a[0], a[1]],
            tilt_rad: [a[2], a[3]],
            velocity_m_s: [a[4], a[5]],
            speed_rad_s: a[6],
            width_m: a[7],
            diameter_m: a[8],
            clearance_m: a[9],
            viscosity_pa_s: a[10],
            journal_roughness_m: a[11],
            shell_roughness_m: a[12],
            supply_pressure_pa: a[13],
        }
    }

    /// `self + t change`.
    pub fn moved(&self, change: &Self, t: f64) -> Self {
        let (a, d) = (self.to_array(), change.to_array());
        Self::from_array(std::array::from_fn(|k| a[k] + t * d[k]))
    }

    /// Sum of the products of all scalars.
    pub fn dot(&self, other: &Self) -> f64 {
        self.to_array().iter().zip(other.to_array()).map(|(a, b)| a * b).sum()
    }

    /// A journal at eccentricity ratio `eps` in the direction `(1, 0)`, turning at `speed_rad_s`, at rest otherwise.
    pub fn at_rest(
        eps: f64,
        width_m: f64,
        diameter_m: f64,
        clearance_m: f64,
        viscosity_pa_s: f64,
        speed_rad_s: f64,
    ) -> Self {
        Self {
            eccentricity_m: [eps * clearance_m, 0.0],
            speed_rad_s,
            width_m,
            diameter_m,
            clearance_m,
            viscosity_pa_s,
            ..Self::default()
        }
    }

    /// Sommerfeld number `F Psi^2 / (B D eta omega)` of a force, with `Psi = 2 C / D`.
    pub fn sommerfeld(&self, force_n: f64, rate_rad_s: f64) -> f64 {
        let psi = 2.0 * self.clearance_m / self.diameter_m;
        force_n * psi * psi / (self.width_m * self.diameter_m * self.viscosity_pa_s * rate_rad_s.abs())
    }
}

impl FilmOutput {
    /// The scalars in a fixed order.
    pub fn to_array(&self) -> [f64; OUTPUTS] {
        let ([fx, fy], [mx, my]) = (self.force_n, self.moment_n_m);
        [
            fx,
            fy,
            mx,
            my,
            self.loss_w,
            self.contact_loss_w,
            self.dissipation_w,
            self.gap_min_m,
            self.pressure_peak_pa,
            self.contact_peak_pa,
            self.side_flow_m3_s,
            self.rubbing_w_m2,
        ]
    }

    /// The output from scalars in the order of [`Self::to_array`].
    pub fn from_array(a: [f64; OUTPUTS]) -> Self {
        Self {
            force_n: [a[0], a[1]],
            moment_n_m: [a[2], a[3]],
            loss_w: a[4],
            contact_loss_w: a[5],
            dissipation_w: a[6],
            gap_min_m: a[7],
            pressure_peak_pa: a[8],
            contact_peak_pa: a[9],
            side_flow_m3_s: a[10],
            rubbing_w_m2: a[11],
        }
    }

    /// Forces and moments as one vector, in the order of eccentricity and tilt.
    pub fn loads(&self) -> [f64; 4] {
        [self.force_n[0], self.force_n[1], self.moment_n_m[0], self.moment_n_m[1]]
    }

    /// The integrals over the bearing, multiplied; extrema and sums over cells stay.
    pub(super) fn integrals_times(mut self, copies: f64) -> Self {
        self.force_n = self.force_n.map(|f| f * copies);
        self.moment_n_m = self.moment_n_m.map(|f| f * copies);
        self.loss_w *= copies;
        self.contact_loss_w *= copies;
        self.dissipation_w *= copies;
        self.side_flow_m3_s *= copies;
        self
    }
}
