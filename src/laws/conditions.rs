//! Everything that may differ from plain tangential oscillation under the laws of Coulomb and Archard.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::laws::friction::{Coulomb, FrictionLaw};
use crate::laws::history::History;
use crate::laws::loading::{Block, Clock, TangentialControl, has_come};
use crate::laws::motion::{Mode, Tangential, ToAndFro};
use crate::laws::wear::{Archard, WearLaw};

/// Laws, mode, blocks and control of a run, beside its contact.
#[derive(Debug, Clone, Serialize)]
pub struct Conditions {
    /// The law of friction at the start.
    #[serde(serialize_with = "law")]
    pub friction: Arc<dyn FrictionLaw>,
    /// Factor on its coefficients along the cycles.
    pub friction_history: History,
    /// The law of wear at the start.
    #[serde(serialize_with = "law")]
    pub wear: Arc<dyn WearLaw>,
    /// Factor on its coefficient along the cycles.
    pub wear_history: History,
    /// Unit of the times of histories and blocks.
    pub clock: Clock,
    /// What the indenter does over one period.
    #[serde(serialize_with = "law")]
    pub mode: Arc<dyn Mode>,
    /// Blocks, one after the other; none is one block without end. After the last one it goes on, or all start again.
    pub blocks: Vec<Block>,
    /// Whether the blocks are repeated without end.
    pub repeat: bool,
    /// What decides the tangential amplitude.
    pub tangential_control: TangentialControl,
    /// Whether the normal force is held instead of the indentation.
    pub holds_normal_force: bool,
    /// Whether the first loading from rest wears too, instead of cycles after frictional shakedown alone.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub wears_from_rest: bool,
    /// Cycles per second, Hz, where the scene tells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f64>,
}

/// What of a contact tells whether a condition changes anything.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    /// Indentation `d`, m.
    pub indentation: f64,
    /// Tangential amplitude `U`, m.
    pub amplitude: f64,
    /// Mean pressure, Pa.
    pub mean_pressure: f64,
    /// Width of the slip annulus, m, and over the contact radius.
    pub slip_width: f64,
    pub slip_share: f64,
    /// Tangential stiffness, N/m.
    pub tangential_stiffness: f64,
}

/// Relative change of the worn volume of the limit by forces that are held, over the share of the contact radius that slips, at most: it is `0.9 (1+k) (3-k)/2` for
/// n = 0.5 to 10 and k = -0.6 to 0.6 (`tests/same_scene.rs`).
const BY_HELD_FORCES: f64 = 2.0;

/// The larger distance of two factors from one.
fn off(factors: [f64; 2]) -> f64 {
    factors.map(|factor| (factor - 1.0).abs()).into_iter().fold(0.0, f64::max)
}

/// A law itself, whoever else holds it.
fn law<L: Serialize + ?Sized, S: Serializer>(law: &Arc<L>, serializer: S) -> Result<S::Ok, S::Error> {
    law.as_ref().serialize(serializer)
}

impl PartialEq for Conditions {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            friction,
            friction_history,
            wear,
            wear_history,
            clock,
            mode,
            blocks,
            repeat,
            tangential_control,
            holds_normal_force,
            wears_from_rest,
            frequency,
        } = self;
        **friction == *other.friction
            && *friction_history == other.friction_history
            && **wear == *other.wear
            && *wear_history == other.wear_history
            && *clock == other.clock
            && **mode == *other.mode
            && *blocks == other.blocks
            && *repeat == other.repeat
            && *tangential_control == other.tangential_control
            && *holds_normal_force == other.holds_normal_force
            && *wears_from_rest == other.wears_from_rest
            && *frequency == other.frequency
    }
}

impl Conditions {
    /// The words for forces that are held among [`Conditions::departures`].
    pub const HELD_FORCES: [&str; 2] = ["a held tangential force", "a held normal force"];

    const BLOCKS: &str = "blocks";
    const RIG: &str = "a compliant rig";
    const CHANGING_FRICTION: &str = "friction that changes along the cycles";
    const CHANGING_WEAR: &str = "a wear coefficient that changes along the cycles";

    /// The coefficient of friction where the law is Coulomb's and does not change.
    pub fn constant_friction(&self) -> Option<f64> {
        let constant = self.friction_history == History::Constant
            && self.friction.along_energy() == History::Constant
            && self.friction.static_factor() == 1.0;
        self.friction.coefficient().filter(|_| constant)
    }

    /// Plain tangential oscillation under Coulomb's and Archard's laws.
    pub fn plain(friction: Coulomb, wear: Archard) -> Self {
        Self {
            friction: Arc::new(friction),
            friction_history: History::default(),
            wear: Arc::new(wear),
            wear_history: History::default(),
            clock: Clock::default(),
            mode: Arc::new(Tangential),
            blocks: Vec::new(),
            repeat: false,
            tangential_control: TangentialControl::default(),
            holds_normal_force: false,
            wears_from_rest: false,
            frequency: None,
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
        let control = match self.tangential_control {
            TangentialControl::Displacement => None,
            TangentialControl::Force => Some(Self::HELD_FORCES[0]),
            TangentialControl::Rig { .. } => Some(Self::RIG),
        };
        let given = |it: bool, words: &'static str| it.then_some(words);
        let changes = |history: &History, words| given(*history != History::Constant, words);
        let departures = [
            self.friction.entry().departure,
            changes(&self.friction_history, Self::CHANGING_FRICTION),
            self.wear.entry().departure,
            changes(&self.wear_history, Self::CHANGING_WEAR),
            self.mode.entry().and_then(|mode| mode.departure),
            given(!self.blocks.is_empty(), Self::BLOCKS),
            control,
            given(self.holds_normal_force, Self::HELD_FORCES[1]),
        ];
        departures.into_iter().flatten().collect()
    }

    /// The same without the blocks that begin no earlier than at some time, in the unit of their clock; all of them where nothing moves before.
    pub fn until(&self, time: f64) -> Self {
        let mut end = 0.0;
        let begun = self.blocks.iter().take_while(|block| {
            let begins = !has_come(time, end);
            end += block.duration;
            begins
        });
        let blocks: Vec<Block> = begun.copied().collect();
        if blocks.iter().all(|block| block.amplitude_factor == 0.0) {
            return self.clone();
        }
        let repeat = self.repeat && blocks.len() == self.blocks.len() && !has_come(time, end);
        let is_whole = |block: &Block| [block.amplitude_factor, block.indentation_factor] == [1.0; 2];
        match blocks[..] {
            [ref only] if is_whole(only) => Self { blocks: vec![], repeat: false, ..self.clone() },
            _ => Self { blocks, repeat, ..self.clone() },
        }
    }

    /// Takes a motion that differs by no more than a part from one to and fro along a line for that; none where it differs by more, or is one already.
    ///
    /// # Arguments
    /// * `contact` -- the first one, with the amplitude along x
    /// * `part` -- relative to amplitude and indentation
    pub fn straighten(&mut self, contact: &Extent, part: f64) -> Option<ToAndFro> {
        let motion = self.mode.to_and_fro(contact.amplitude, contact.indentation);
        let straight = !self.mode.is_tangential() && motion.departure <= part;
        straight.then(|| {
            self.mode = Arc::new(Tangential);
            motion
        })
    }

    /// Leaves out what changes a run by no more than a part of it; in words what of that changes it at all.
    ///
    /// # Arguments
    /// * `contact` -- the first one
    /// * `wear` -- Archard's law that stands for the law of wear
    /// * `part` -- relative
    pub fn simplify(&mut self, contact: &Extent, wear: Archard, part: f64) -> Vec<&'static str> {
        let mut left_out = vec![];
        let mut is_idle = |effect: f64, words: Option<&'static str>| {
            let idle = effect <= part;
            left_out.extend(words.filter(|_| idle && effect > 0.0));
            idle
        };
        let histories = [&mut self.friction_history, &mut self.wear_history];
        for (history, words) in histories.into_iter().zip([Self::CHANGING_FRICTION, Self::CHANGING_WEAR]) {
            if is_idle(off(history.range()), Some(words)) {
                *history = History::Constant;
            }
        }
        let factors = self.blocks.iter().map(|it| off([it.amplitude_factor, it.indentation_factor]));
        if is_idle(factors.fold(0.0, f64::max), Some(Self::BLOCKS)) {
            (self.blocks, self.repeat) = (vec![], false);
        }
        let coefficient = self.friction.reference_coefficient();
        if is_idle(self.friction.departure(contact.indentation), self.friction.entry().departure) {
            self.friction = Arc::new(Coulomb { coefficient });
        }
        if let TangentialControl::Rig { stiffness } = self.tangential_control
            && is_idle(contact.tangential_stiffness / stiffness, Some(Self::RIG))
        {
            self.tangential_control = TangentialControl::Displacement;
        }
        // Where next to nothing slips, it bears next to nothing of a force.
        let by_forces = BY_HELD_FORCES * contact.slip_share * self.widening();
        if self.tangential_control == TangentialControl::Force
            && is_idle(by_forces, Some(Self::HELD_FORCES[0]))
        {
            self.tangential_control = TangentialControl::Displacement;
        }
        if self.holds_normal_force && is_idle(by_forces, Some(Self::HELD_FORCES[1])) {
            self.holds_normal_force = false;
        }
        // Pressures go on falling elsewhere.
        let deep = !self.holds_normal_force && self.blocks.iter().all(|it| it.indentation_factor >= 1.0);
        let effect = self.wear.departure(contact.mean_pressure, contact.slip_width);
        if deep && is_idle(effect, self.wear.entry().departure) {
            self.wear = Arc::new(wear);
        }
        left_out
    }

    /// Largest amplitude over friction of any cycle, over those of the first; infinite where the indentation changes between blocks.
    fn widening(&self) -> f64 {
        if self.blocks.iter().any(|it| it.indentation_factor != 1.0) {
            return f64::INFINITY;
        }
        let amplitude = self.blocks.iter().map(|it| it.amplitude_factor).fold(1.0, f64::max);
        let histories = [self.friction_history.range(), self.friction.along_energy().range()];
        amplitude / histories.into_iter().flatten().fold(1.0, f64::min)
    }

    /// Whether the normal force and the amplitude of the tangential one are held. Under Coulomb's law the stick radius is then that of the first
    /// cycle for ever: no worn ground bears a part of `F_N - F_x/μ_f`.
    pub fn holds_both_forces(&self) -> bool {
        self.holds_normal_force && self.tangential_control == TangentialControl::Force
    }

    /// `∂ ln(wear)/∂ ln(slip)` of a cycle next to the edge of stick, at most one. Where slip sets in with a jump it is not small there.
    pub fn slip_exponent_at_edge(&self) -> f64 {
        let jumps = self.friction.remembers_slip() && self.wear.spreading().is_none();
        if jumps { 1.0 } else { self.wear.slip_exponent().min(1.0) }
    }

    /// Whether nothing differs from plain tangential oscillation under Coulomb's and Archard's laws.
    pub fn is_plain(&self) -> bool {
        self.departures().is_empty()
    }
}
