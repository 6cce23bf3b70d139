//! What is minimised, varied and limited, and how, as written.

use super::QuantityText;
use crate::gradient::EngineName;
use crate::optimise::Method;
use crate::study::{Given, QuantityName};
use crate::units::{Duration, Heat, Length, Power, Rotation, Temperature, Volume};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

section! {
    /// One operating point of the duty cycle.
    OperatingPointFile {
        /// Name in reports.
        name: String,
        /// Speed of the crankshaft.
        speed: Rotation,
        /// Share of this point in the objective. Default 1; shares are normalised to the sum 1.
        weight: f64,
        /// Factor on the cylinder pressure (or on the tabulated load). Default 1.
        load_factor: f64,
    }
}

words! {
    /// What becomes of the losses at the operating points.
    AggregateName {
        /// Their weighted mean.
        WeightedMean,
        /// The largest of the losses times their weights.
        WorstCase,
    }
}

section! {
    /// Objective: what becomes of the mean friction losses of all bearings at the operating points.
    ObjectiveFile {
        /// "weighted-mean" (default) or "worst-case": the largest loss times weight, weights as written.
        aggregate: AggregateName,
        /// Operating points with their weights.
        operating_points: Vec<Given<OperatingPointFile>>,
    }
}

section! {
    /// One design parameter.
    ParameterFile {
        /// "<bearing>.width", ".diameter", ".diametral_clearance", ".tilt_x", ".tilt_y", ".roughness.journal", ".roughness.shell", ".supply.pressure", ".shapes.<shape>.<key>" (all coefficients of a spline: "coefficients[*]"), or "oil.inlet_temperature".
        name: String,
        /// Smallest allowed value, with unit; a share is a number in quotes, like "0.2".
        lower: QuantityText,
        /// Largest allowed value, with unit.
        upper: QuantityText,
        /// Value the search starts from, with unit. Default: the value of that key in the study.
        start: QuantityText,
    }
}

section! {
    /// One limit; give either at_least or at_most.
    ConstraintFile {
        /// Limited quantity.
        quantity: QuantityName,
        /// Bearing it applies to. Default: every bearing.
        bearing: String,
        /// Smallest allowed value, with unit.
        at_least: QuantityText,
        /// Largest allowed value, with unit.
        at_most: QuantityText,
    }
}

section! {
    /// A front: the least loss for each of a list of limits on another quantity, beside the search itself.
    ParetoFile {
        /// The quantity. A limit of [[constraints]] on the same one gives way to the list.
        quantity: QuantityName,
        /// Name of the bearing; all of them if absent.
        bearing: String,
        /// Smallest values allowed, one search each, with unit.
        at_least: Vec<QuantityText>,
        /// Largest values allowed, one search each, with unit.
        at_most: Vec<QuantityText>,
    }
}

section! {
    /// Gradient engine.
    GradientFile {
        /// "ADJ" (default), "TRA", "CEN", "FW" or "BW".
        engine: EngineName,
        /// Relative perturbation of the finite differences. Default 1e-6.
        perturbation: f64,
    }
}

section! {
    /// A term of a linear constraint.
    TermFile {
        /// Name of a design parameter.
        parameter: String,
        /// What its value is multiplied with.
        factor: f64,
    }
}

section! {
    /// A limit on a sum of design parameters times factors, met by every design that is tried; give one of at_least, at_most, equals.
    LinearConstraintFile {
        /// The terms; parameters that are measured in different units cannot be added.
        terms: Vec<Given<TermFile>>,
        /// Smallest sum allowed, with unit.
        at_least: QuantityText,
        /// Largest sum allowed, with unit.
        at_most: QuantityText,
        /// The sum, with unit.
        equals: QuantityText,
    }
}

section! {
    /// How a quantity scatters from one bearing, or one day, to the next.
    ToleranceFile {
        /// Name as of a design parameter; it need not be one.
        parameter: String,
        /// Standard deviation, with unit (of temperatures "K").
        standard_deviation: QuantityText,
    }
}

section! {
    /// A robust design: loss and limits carry a margin of some standard deviations for what scatters.
    RobustFile {
        /// Standard deviations in each margin. Default 3.
        sigmas: f64,
        /// What scatters.
        tolerances: Vec<Given<ToleranceFile>>,
        /// Bearings that are drawn in the end to check the margins. Default 50.
        samples: u64,
        /// Seed of the draw. Default 1.
        seed: u64,
    }
}

section! {
    /// One operating point of a running-in programme.
    StageFile {
        /// Name in reports.
        name: String,
        /// How long it lasts.
        duration: Duration,
        /// Speed of the crankshaft.
        speed: Rotation,
        /// Factor on the cylinder pressure (or on the tabulated load). Default 1.
        load_factor: f64,
        /// Temperature of the oil at the inlet. Default: that of the design.
        oil_inlet_temperature: Temperature,
    }
}

words! {
    /// What a running-in design minimises.
    RunningInGoalName {
        /// The friction loss meant over the programme.
        MeanLoss,
        /// The energy lost over the programme, where its durations are design parameters.
        EnergyLost,
        /// The friction loss in the end, at the last stage.
        FinalLoss,
    }
}

words! {
    /// How a march through running-in saves cycles.
    AccelerationName {
        /// Predictions from a basis of earlier cycles by proper orthogonal decomposition.
        Pod,
        /// None: every cycle is computed.
        None,
    }
}

section! {
    /// Running-in of the design that is found: bearings wear by roughness.wear_coefficient where they touch.
    RunningInFile {
        /// The programme.
        stages: Vec<Given<StageFile>>,
        /// Searches a running-in design: "mean-loss" (over the programme), "energy-lost" or "final-loss" is minimised instead of the loss of new surfaces at the operating points, where the limits of [[constraints]] hold all the same. Default: the design is searched without regard to wear and run in afterwards.
        minimise: RunningInGoalName,
        /// Largest wear depth of any shell or journal. For a running-in design.
        max_wear_depth: Length,
        /// Largest volume worn off any bearing. For a running-in design.
        max_wear_volume: Volume,
        /// Most energy lost to friction over the programme by any bearing. For a running-in design.
        max_energy_lost: Heat,
        /// Largest friction loss of any bearing in the end of the programme. For a running-in design.
        max_final_loss: Power,
        /// Longest time constant of any bearing's loss in the last stage. For a running-in design.
        max_time_to_run_in: Duration,
        /// Limits on the cycle of the last stage with the surfaces in the end, in the form of [[constraints]], which hold with new surfaces. For a running-in design.
        constraints: Vec<Given<ConstraintFile>>,
        /// Whether the search of a running-in design begins with a cheap approximation of the march (P_alpha), where that has at most half of its blocks. Default false.
        approximate_first: bool,
        /// Share of the shell's roughness that is left where much was worn off. Default 1: the roughness stays.
        roughness_left: f64,
        /// Wear depth that takes the shell most of the way there: what goes falls by exp(-depth / smoothing_depth). Default: the shell's roughness.
        smoothing_depth: Length,
        /// A stage ends before its time when the friction loss changes by less than this share per hour, and the wear depth by less than settled_wear_per_hour. Default: no stage does.
        settled_loss_change_per_hour: f64,
        /// See settled_loss_change_per_hour.
        settled_wear_per_hour: Length,
        /// How cycles are saved where the found design is run in: "pod" predicts them from those before wherever the error it makes is within the tolerance, "none" computes all. Default "pod".
        acceleration: AccelerationName,
        /// Error of the wear depth that one block of the march may have. Default "0.02 um".
        wear_depth_tolerance: Length,
        /// Share of the wear that the journal takes. Default 0.
        journal_share: f64,
        /// Blocks at most. Default 500.
        max_blocks: usize,
    }
}

section! {
    /// One of the options of a choice.
    OptionFile {
        /// Name in reports.
        name: String,
        /// Keys of the study by their path, like "oil.grade", with the values they take.
        set: BTreeMap<String, Value>,
    }
}

section! {
    /// Something that is chosen from a list, such as the oil: every option is searched, the best design is reported.
    ChoiceFile {
        /// Name in reports.
        name: String,
        /// The options.
        options: Vec<Given<OptionFile>>,
    }
}

/// Another search for comparison.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RivalFile {
    /// Method.
    pub method: Method,
    /// Gradient engine. Default "ADJ".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub engine: Option<EngineName>,
}

section! {
    /// Optimiser.
    OptimiserFile {
        /// "sqp" (default), "augmented-lagrangian" or, without gradients, "cobyla".
        method: Method,
        /// Searches: the first from the start, the others from a Latin hypercube over the box. Default 1.
        starts: u64,
        /// Seed of the Latin hypercube. Default 1.
        seed: u64,
        /// Designs one search may simulate. No limit by default.
        max_simulations: u64,
        /// Wall time one search may take, like "10 min"; a search that ends by it gives other numbers on a rerun. No limit by default.
        max_time: Duration,
        /// Methods and gradient engines that search from the same start too, for comparison in the report. None by default.
        rivals: Vec<RivalFile>,
        /// Scaled KKT residual at which a design counts as optimal. Default 1e-6.
        tolerance: f64,
        /// Iterations at most. Default 60.
        max_iterations: u64,
        /// Longest change of a parameter in one iteration, as a share of its box. Default 0.4.
        step_limit: f64,
        /// Whether the optimum is polished by Newton's method, with second derivatives from differences of gradients. Default false.
        polish: bool,
        /// Sharpness of the smooth extrema of film thickness and pressure: larger is closer to the exact extremum and harder to optimise. Default 200.
        aggregate_sharpness: f64,
    }
}
