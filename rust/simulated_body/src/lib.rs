//! The robot's body in the simulator. It knows the true state, so that nothing of the core may use it: only the bindings do.
//!
//! [`Servos`] turn joint targets into torques, within what a motor could do. [`BodySenses`] are what encoders, inertial unit and soles
//! measure of a [`TrueState`], each with errors from a seeded stream of its own ([`Normals`]). For the judge, [`TrueStance`] is where the
//! robot stands and [`Surfaces`] sort what it touches.

mod encoders;
mod error;
mod feet;
mod inertial;
mod normals;
mod senses;
mod servo;
mod soles;
mod touch;
mod truth;

pub use encoders::{Encoders, EncodersConfig, EncodersTuning};
pub use error::SimulatedBodyError;
pub use feet::{FootForces, FootForcesConfig, SensedSole};
pub use inertial::{InertialConfig, InertialTuning, InertialUnit};
pub use normals::Normals;
pub use senses::{BodyReading, BodySenses, BodySensesConfig};
pub use servo::{Motor, ServoTuning, Servos};
pub use soles::{TrueSole, TrueStance};
pub use touch::{Contact, GeomKind, Surfaces, Touches};
pub use truth::TrueState;
