//! Wear by energy whose coefficient depends on the power of friction per area, as debris that oxidises between two passes makes it.
//!
//! ```text
//! exponential   α(φ) = (α_ab - α_ad) e^(-εφ) + α_ad      [Arnaud, Baydoun, Fouvry 2021]
//! power law     α(φ) = K (φ/φ_0)^n,  at most α_max       [Fouvry 2017]
//! ```
//!
//! The power is that of the whole contact over its area (`scope = "global"`, as the laws were measured), or that of each place (`"local"`).
//! The global form changes the time that wear takes, not the shapes it passes. The local form is well posed only where wear rises with the
//! power, `(φ α)' > 0`. Both end at the limit of the paper.

use std::sync::Arc;

use super::law::{Rate, Rubbing, Scales, WearLaw};
use crate::laws::entry::{Built, Entry, Value, Values, Wrong};
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, number};

/// `[wear.friction-power]`.
pub static ENTRY: Entry<dyn WearLaw> = Entry::<dyn WearLaw>::new(
    "friction-power",
    "Volume by energy, with a coefficient that depends on the power of friction per area; needs loading.frequency.",
    &KEYS,
    build,
)
.departs("wear that depends on the friction power")
.rules(&[Rule::Forms(&FORMS)]);

const EXPONENTIAL: [&str; 3] = ["abrasive_coefficient", "adhesive_coefficient", "decay"];
const POWER: [&str; 4] = ["coefficient", "exponent", "reference_power", "largest_coefficient"];
const FORMS: [Form; 2] = [
    Form::new(&EXPONENTIAL),
    Form::new(&["coefficient", "exponent"]).may(&["reference_power", "largest_coefficient"]),
];
const SCOPES: [&str; 2] = ["global", "local"];

const KEYS: [Key; 8] = [
    Key::new(
        "scope",
        Kind::Word(&SCOPES),
        "Whether the power is that of the whole contact over its area or that of each place.",
    )
    .example("global"),
    coefficient(EXPONENTIAL[0], "Volume per energy α_ab at no power, m³/J."),
    coefficient(EXPONENTIAL[1], "Volume per energy α_ad at high power, m³/J."),
    Key::quantity(EXPONENTIAL[2], Dimension::AREA_PER_POWER, "Decay ε of the exponential form, m²/W.")
        .range(Range::POSITIVE)
        .example("11 mm^2/W")
        .optional(),
    coefficient(POWER[0], "Volume per energy K of the power law at its reference power, m³/J."),
    Key::number(POWER[1], "Exponent n of the power law.")
        .range(Range::above(-1.0))
        .because("with less, wear would grow without bound as the power falls")
        .example("-0.25")
        .optional(),
    Key::quantity(
        POWER[2],
        Dimension::POWER_PER_AREA,
        "Reference power φ_0 of the power law, W/m²; 1 W/mm² if left out.",
    )
    .range(Range::POSITIVE)
    .example("1 W/mm^2")
    .optional(),
    coefficient(POWER[3], "Volume per energy that the power law does not exceed, m³/J."),
];

const fn coefficient(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::INVERSE_PRESSURE, about)
        .range(Range::POSITIVE)
        .unit("m3 J-1")
        .example("1e-4 mm^3/J")
        .optional()
}

/// Power, W/m², to which the coefficient of a power law refers by default.
const REFERENCE_POWER: f64 = 1e6;

/// Power over that of reference below which a power law goes on in proportion: else wear would end at an instant, in a root.
const LEAST_POWER: f64 = 1e-9;

/// Volume per energy, m³/J, as a function of the power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coefficient {
    /// Between two values.
    Exponential {
        /// `α_ab`, m³/J.
        abrasive: f64,
        /// `α_ad`, m³/J.
        adhesive: f64,
        /// `ε`, m²/W.
        decay: f64,
    },
    /// A power law.
    Power {
        /// `K`, m³/J.
        coefficient: f64,
        /// `n > -1`.
        exponent: f64,
        /// `φ_0`, W/m².
        reference: f64,
        /// `α_max`, m³/J.
        largest: Option<f64>,
    },
}

impl Coefficient {
    /// The coefficient at a power, W/m², and its derivative.
    pub fn at(&self, power: f64) -> (f64, f64) {
        match *self {
            Self::Exponential { abrasive, adhesive, decay } => {
                let fallen = (abrasive - adhesive) * (-decay * power).exp();
                (fallen + adhesive, -decay * fallen)
            }
            Self::Power { coefficient, exponent, reference, largest } => {
                let relative = power / reference;
                let squared = relative * relative + LEAST_POWER * LEAST_POWER;
                let value = coefficient * squared.powf(0.5 * exponent);
                match largest.filter(|largest| value > *largest) {
                    Some(largest) => (largest, 0.0),
                    None => (value, exponent * value * relative / (squared * reference)),
                }
            }
        }
    }

    fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Exponential { abrasive, adhesive, decay } => {
                Self::Exponential { abrasive: abrasive * factor, adhesive: adhesive * factor, decay }
            }
            Self::Power { coefficient, exponent, reference, largest } => Self::Power {
                coefficient: coefficient * factor,
                exponent,
                reference,
                largest: largest.map(|largest| largest * factor),
            },
        }
    }
}

/// `dw = α(φ) τ |ds|`.
#[derive(Debug, Clone, Copy)]
pub struct FrictionPower {
    /// `α`.
    pub coefficient: Coefficient,
    /// Cycles per second, Hz.
    pub frequency: f64,
    /// Whether the power is that of each place; else that of the whole contact over its area.
    pub local: bool,
}

fn build(values: &Values) -> Built<dyn WearLaw> {
    let local = values.word("scope") == "local";
    let coefficient = match values.optional("decay") {
        Some(decay) => Coefficient::Exponential {
            abrasive: values.number(EXPONENTIAL[0]),
            adhesive: values.number(EXPONENTIAL[1]),
            decay,
        },
        None => Coefficient::Power {
            coefficient: values.number(POWER[0]),
            exponent: values.number(POWER[1]),
            reference: values.optional(POWER[2]).unwrap_or(REFERENCE_POWER),
            largest: values.optional(POWER[3]),
        },
    };
    if let (true, Coefficient::Exponential { abrasive, adhesive, .. }) = (local, coefficient) {
        let part = adhesive / (abrasive - adhesive);
        let least = (-2.0_f64).exp();
        if abrasive > adhesive && part <= least {
            return Err(Wrong::Value {
                key: EXPONENTIAL[1],
                why: format!(
                    "is {part:.3} of abrasive_coefficient - adhesive_coefficient; place by place wear must rise with the power, for which \
                     that must be above e^-2 = {least:.4}, or the contact would split into bands; give scope = \"global\", or a larger value"
                ),
            });
        }
    }
    let frequency = values.frequency.ok_or_else(|| Wrong::Value {
        key: "scope",
        why: "needs the power of friction, which cycles alone do not tell; give loading.frequency, for example \"10 Hz\"".into(),
    })?;
    Ok(Arc::new(FrictionPower { coefficient, frequency, local }))
}

impl WearLaw for FrictionPower {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        let scope = Value::Word(SCOPES[usize::from(self.local)]);
        let missing = Value::Missing;
        match self.coefficient {
            Coefficient::Exponential { abrasive, adhesive, decay } => {
                let [abrasive, adhesive, decay] = [abrasive, adhesive, decay].map(Value::from);
                vec![scope, abrasive, adhesive, decay, missing, missing, missing, missing]
            }
            Coefficient::Power { coefficient, exponent, reference, largest } => {
                let [coefficient, exponent, reference] = [coefficient, exponent, reference].map(Value::from);
                let largest = largest.map_or(missing, Value::from);
                vec![scope, missing, missing, missing, coefficient, exponent, reference, largest]
            }
        }
    }

    fn scaled(&self, factor: f64) -> Arc<dyn WearLaw> {
        Arc::new(Self { coefficient: self.coefficient.scaled(factor), ..*self })
    }

    fn words(&self) -> String {
        let coefficient = match self.coefficient {
            Coefficient::Exponential { abrasive, adhesive, decay } => {
                format!("{} to {} m³/J as e^(-φ {} m²/W)", number(abrasive), number(adhesive), number(decay))
            }
            Coefficient::Power { coefficient, exponent, reference, largest } => {
                let most = largest.map_or(String::new(), |it| format!(", at most {} m³/J", number(it)));
                format!(
                    "{} m³/J (φ/{} W/m²)^{}{most}",
                    number(coefficient),
                    number(reference),
                    number(exponent)
                )
            }
        };
        let scope = if self.local { "each place" } else { "the contact" };
        format!("by the friction power φ of {scope}, {coefficient}")
    }

    /// The energy that friction dissipates: [`WearLaw::of_cycle`] and [`WearLaw::at_contact`] make wear of it.
    fn rate(&self, at: &Rubbing) -> Rate {
        Rate { depth: at.pressure, by_pressure: 1.0 }
    }

    /// With the coefficient at the natural power of the contact.
    fn reference(&self, contact: &Scales) -> f64 {
        let energy = contact.friction * contact.pressure * contact.path;
        contact.friction * self.coefficient.at(self.frequency * energy).0
    }

    fn archard_coefficient(&self, friction: Option<f64>) -> Option<f64> {
        friction.filter(|_| !self.local)
    }

    fn volume_per_energy(&self, _: Option<f64>) -> Option<f64> {
        (!self.local).then_some(1.0)
    }

    fn slip_exponent(&self) -> f64 {
        match self.coefficient {
            Coefficient::Power { exponent, largest: None, .. } if self.local => 1.0 + exponent,
            _ => 1.0,
        }
    }

    fn takes_traction(&self) -> bool {
        true
    }

    fn of_cycle(&self, depth: f64) -> Option<[f64; 2]> {
        self.local.then(|| {
            let power = self.frequency * depth.abs();
            let (value, slope) = self.coefficient.at(power);
            [value * depth, value + slope * power]
        })
    }

    fn at_contact(&self, energy: f64) -> Option<f64> {
        (!self.local).then(|| self.coefficient.at(self.frequency * energy.max(0.0)).0)
    }
}
