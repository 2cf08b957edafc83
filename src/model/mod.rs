//! The nouns that two or more stages share: data and invariants, no algorithm, no file access.
//! SI units throughout; n FE degrees of freedom, m modes, r kept modes, k kept degrees of freedom.

mod dof;
mod fe;
mod interface;
mod modes;
mod progress;
mod ranking;
mod reduced;
mod rigid_body;
mod source;
mod state_space;
mod trajectory;

pub use dof::{Axis, Dof, DofMap, NodeId, RepeatedDof};
pub use fe::FeModel;
pub use interface::{InterfaceError, InterfaceNode, Role};
pub use modes::{Completeness, ModeNo, Modes, Origin};
pub use progress::{Progress, Silent};
pub use ranking::{Ranking, Score, Selection};
pub use reduced::{KeptDof, KeptMode, KeptNode, ReducedModel, Residual, RigidPart};
pub use rigid_body::{RigidBody, rigid_motions};
pub use source::Source;
pub use state_space::StateSpace;
pub use trajectory::{Channel, Energy, Extreme, Stats, Trajectory};
