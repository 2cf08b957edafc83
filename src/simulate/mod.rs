//! Reduced models and a scene to a trajectory: small vibration about a moving frame
//! (Xue et al. 2014, section 3), joints eliminated, the linear part propagated exactly, contact
//! forces solved implicitly.

mod assemble;
mod assembly;
mod bodies;
mod body;
mod channels;
mod constraints;
mod contact;
mod effect;
mod energy;
mod error;
mod forces;
mod integrate;
mod joint;
mod record;
mod run;
mod scene;
mod statics;
mod system;
mod watch;

pub use assemble::assemble;
pub use effect::{EFFECTS, EffectInfo};
pub use error::SceneError;
pub use integrate::{INTEGRATORS, IntegratorInfo};
pub use joint::{PRESETS, Preset};
pub use run::{FORMULATIONS, FormulationInfo, simulate};
pub use scene::{Analysis, BodySpec, FlexibilityTable, Formulation, OtherValues, Reference, Scene};
pub use system::System;
