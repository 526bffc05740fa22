//! Everything that may differ from plain tangential oscillation under the laws of Coulomb and Archard.

use crate::friction::{Coulomb, FrictionLaw};
use crate::history::History;
use crate::loading::{Block, Clock, Mode, TangentialControl};
use crate::wear::{Archard, WearLaw};

/// Laws, mode, blocks and control of a run, beside its contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    /// The law of friction at the start.
    pub friction: FrictionLaw,
    /// Factor on its coefficients along the cycles.
    pub friction_history: History,
    /// The law of wear at the start.
    pub wear: WearLaw,
    /// Factor on its coefficient along the cycles.
    pub wear_history: History,
    /// Unit of the times of histories and blocks.
    pub clock: Clock,
    /// What the indenter does over one period.
    pub mode: Mode,
    /// Blocks, one after the other; none is one block without end. After the last one it goes on, or all start again.
    pub blocks: Vec<Block>,
    /// Whether the blocks are repeated without end.
    pub repeat: bool,
    /// What decides the tangential amplitude.
    pub tangential_control: TangentialControl,
    /// Whether the normal force is held instead of the indentation.
    pub holds_normal_force: bool,
}

impl Conditions {
    /// Plain tangential oscillation under Coulomb's and Archard's laws.
    pub fn plain(friction: Coulomb, wear: Archard) -> Self {
        Self {
            friction: FrictionLaw::Coulomb(friction),
            friction_history: History::default(),
            wear: WearLaw::Archard(wear),
            wear_history: History::default(),
            clock: Clock::default(),
            mode: Mode::default(),
            blocks: Vec::new(),
            repeat: false,
            tangential_control: TangentialControl::default(),
            holds_normal_force: false,
        }
    }
}
