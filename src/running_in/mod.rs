//! Running-in: bearings that touch wear, and wear until they touch less.
//!
//! ```text
//! dw/dt = K/H share r(w),    r = 1/T Int_WC p_contact |U| dt    of every cell, shell and journal           Archard (1953)
//! E = Int P(w) dt            the energy lost,   P the mean friction loss of the settled cycle with the worn surfaces
//! ```
//!
//! Wear is slow: over one working cycle the surfaces stand still, and the settled cycle with the surfaces of the moment says how
//! fast they wear (cycle jump). [`march`] integrates over a programme of [`Stage`]s in blocks of many cycles, by the method of
//! Heun with that of Euler inside: their difference is the error of a block, and decides its length. [`march_gradient`] gives
//! derivatives by five engines; ADJ carries them back through the blocks: at each of them one adjoint of a cycle, whose weights on
//! the rubbing of every cell are what the depth there is worth later on. Block lengths are frozen in a derivative, like the steps
//! of a cycle.
//!
//! [`march_predicted`] solves fewer cycles: it predicts them from a basis of earlier ones and checks where it gets to. [`approximation`]
//! makes of a march one of few blocks, `P_alpha`. Where much is worn off the shell may become smooth (see
//! [`Smoothing`](crate::cranktrain::Smoothing)).
//!
//! Deliberately not here: study files, words, optimisation; derivatives of a predicted march, which would be those of its basis.

mod adjoint;
mod alpha;
mod basis;
mod field;
mod gradient;
mod march;
mod predicted;
mod quantity;
mod rate;
mod stage;
mod tangent;
mod walk;

pub use alpha::{approximation, weights};
pub use field::{largest, new_surfaces};
pub use gradient::{MarchEngine, RunningInGradient, march_gradient};
pub use march::{Block, Course, End, March, Moment, march, replay};
pub use predicted::{PredictedMarch, march_predicted};
pub use quantity::{RunningInQuantity, Worth, falls, worn_volume_m3};
pub use rate::{Rate, settled_with_wear};
pub use stage::{MarchError, MarchOptions, Settled, Stage};
