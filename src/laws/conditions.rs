//! Everything that may differ from plain tangential oscillation under the laws of Coulomb and Archard.

use serde::Serialize;

use crate::laws::friction::{Coulomb, FrictionLaw};
use crate::laws::history::History;
use crate::laws::loading::{Block, Clock, Mode, TangentialControl};
use crate::laws::wear::{Archard, WearLaw};

/// Laws, mode, blocks and control of a run, beside its contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
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

    /// What differs from plain tangential oscillation under Coulomb's and Archard's laws, in words; nothing for a plain scene.
    ///
    /// ```
    /// use fretwear::laws::conditions::Conditions;
    /// use fretwear::laws::friction::Coulomb;
    /// use fretwear::laws::wear::Archard;
    ///
    /// let mut conditions = Conditions::plain(Coulomb { coefficient: 0.6 }, Archard { coefficient: 1e-14 });
    /// assert!(conditions.is_plain());
    /// conditions.holds_normal_force = true;
    /// assert_eq!(conditions.departures(), ["a held normal force"]);
    /// ```
    pub fn departures(&self) -> Vec<&'static str> {
        let friction = match self.friction {
            FrictionLaw::Coulomb(_) => None,
            FrictionLaw::StaticKinetic { .. } => Some("static and kinetic friction"),
            FrictionLaw::LoadDependent { .. } => Some("friction that depends on the load"),
        };
        let wear = match self.wear {
            // Under Coulomb's law that of the dissipated energy is Archard's.
            WearLaw::Archard(_) | WearLaw::DissipatedEnergy { .. } => None,
            WearLaw::PowerLaw { .. } => Some("wear by a power law"),
            WearLaw::Threshold { .. } => Some("wear above a threshold"),
            WearLaw::NonLocal { .. } => Some("wear that is not local"),
        };
        let mode = match self.mode {
            Mode::Tangential => None,
            Mode::NormalOscillation { .. } => Some("a normal oscillation"),
            Mode::Orbit { .. } => Some("an orbit"),
            Mode::Recorded(_) => Some("a recorded path"),
        };
        let control = match self.tangential_control {
            TangentialControl::Displacement => None,
            TangentialControl::Force => Some("a held tangential force"),
            TangentialControl::Rig { .. } => Some("a compliant rig"),
        };
        let given = |it: bool, words: &'static str| it.then_some(words);
        let changes = |history: &History, words| given(*history != History::Constant, words);
        let departures = [
            friction,
            changes(&self.friction_history, "friction that changes along the cycles"),
            wear,
            changes(&self.wear_history, "a wear coefficient that changes along the cycles"),
            mode,
            given(!self.blocks.is_empty(), "blocks"),
            control,
            given(self.holds_normal_force, "a held normal force"),
        ];
        departures.into_iter().flatten().collect()
    }

    /// Whether nothing differs from plain tangential oscillation under Coulomb's and Archard's laws.
    pub fn is_plain(&self) -> bool {
        self.departures().is_empty()
    }
}
