//! The indenter goes round.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use serde_json::{Value, json};

use super::mode::Mode;
use crate::laws::entry::{Built, Entry, Values, Wrong};
use crate::laws::path::PathPoint;
use crate::units::{Dimension, Key, Range, Rule, Scale, number};

/// `[loading.orbit]`.
pub static ENTRY: Entry<dyn Mode> =
    Entry::<dyn Mode>::new("orbit", "The indenter moves along x and y.", &KEYS, build)
        .rules(&[Rule::OneOf(&AMPLITUDES)])
        .departs("an orbit")
        .refers(|_| true);

const AMPLITUDES: [&str; 2] = ["transverse_amplitude", "transverse_ratio"];

const KEYS: [Key; 5] = [
    Key::quantity(AMPLITUDES[0], Dimension::LENGTH, "Amplitude along y, m.")
        .range(Range::POSITIVE)
        .example("0.1 um")
        .optional(),
    Key::number(AMPLITUDES[1], "Amplitude along y over that along x.")
        .range(Range::POSITIVE)
        .example("0.5")
        .optional(),
    Key::quantity(
        "phase",
        Dimension::ANGLE,
        "Phase of the motion along y, rad; 0 is an ellipse with the axes x and y.",
    )
    .example("35 deg")
    .default("0 deg"),
    centre("centre_x", "Where the indenter was pressed on, along x, m."),
    centre("centre_y", "Where the indenter was pressed on, along y, m."),
];

const fn centre(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::LENGTH, about).example("0.1 um").default("0 m")
}

fn build(values: &Values) -> Built<dyn Mode> {
    let along = values.contact.amplitude;
    let transverse_amplitude =
        values.optional(AMPLITUDES[0]).unwrap_or_else(|| along * values.number(AMPLITUDES[1]));
    if !(transverse_amplitude > 0.0 && transverse_amplitude.is_finite()) {
        return Err(Wrong::Value {
            key: AMPLITUDES[1],
            why: format!(
                "gives an amplitude of {transverse_amplitude:e} m beside one of {along:e} m along x; give loading.orbit.{}",
                AMPLITUDES[0]
            ),
        });
    }
    let centre = ["centre_x", "centre_y"].map(|key| values.number(key));
    Ok(Arc::new(Orbit { transverse_amplitude, phase: values.number("phase"), centre }))
}

/// `u = (o_x + U cos ωt, o_y + U_y sin(ωt + φ))`.
#[derive(Debug, Clone, Copy)]
pub struct Orbit {
    /// `U_y`, m, positive.
    pub transverse_amplitude: f64,
    /// `φ`, rad; zero is an ellipse with its axes along x and y.
    pub phase: f64,
    /// `o_x`, `o_y`, m: the centre, seen from where the indenter is pressed on.
    pub centre: [f64; 2],
}

impl Mode for Orbit {
    fn entry(&self) -> Option<&'static Entry<dyn Mode>> {
        Some(&ENTRY)
    }

    fn told(&self) -> Vec<(&'static str, Value)> {
        let Self { transverse_amplitude, phase, centre } = self;
        vec![
            ("transverse_amplitude", json!(transverse_amplitude)),
            ("phase", json!(phase)),
            ("centre", json!(centre)),
        ]
    }

    fn words(&self) -> String {
        let [transverse, x, y] =
            [self.transverse_amplitude, self.centre[0], self.centre[1]].map(|it| Scale::LENGTH.show(it));
        format!("orbit, {transverse} transverse, phase {} rad, centre {x}, {y}", number(self.phase))
    }

    /// Even steps of `ωt`, a multiple of four, shifted by less than an eighth of a turn such that the ends of both axes of the ellipse are
    /// points.
    fn period(&self, amplitude: f64, substeps: usize) -> Vec<PathPoint> {
        let Self { transverse_amplitude, phase, centre } = *self;
        let amplitudes = [amplitude, transverse_amplitude];
        // |u - o|² varies as the real part of (U² - U_y² e^(2iφ)) e^(2iωt); a quarter of a turn leads from one axis to the other.
        let [x2, y2] = amplitudes.map(|amplitude| amplitude * amplitude);
        let axis = -0.5 * (-y2 * (2.0 * phase).sin()).atan2(x2 - y2 * (2.0 * phase).cos());
        let start = axis - FRAC_PI_2 * (axis / FRAC_PI_2).round();
        let cosine = [amplitudes[0] * start.cos(), amplitudes[1] * (start + phase).sin()];
        let sine = [-amplitudes[0] * start.sin(), amplitudes[1] * (start + phase).cos()];
        let quarter = substeps.div_ceil(4).max(1);
        let at = |i: usize| {
            let (s, c) = (FRAC_PI_2 * (i % quarter) as f64 / quarter as f64).sin_cos();
            // Whole quarters are turned exactly, so that opposite points are opposite to the last bit.
            let (s, c) = [(s, c), (c, -s), (-s, -c), (-c, s)][i / quarter];
            let tangential = [0, 1].map(|axis| centre[axis] + c * cosine[axis] + s * sine[axis]);
            PathPoint { tangential, lift: 0.0 }
        };
        (0..4 * quarter).map(at).collect()
    }

    fn scaled(&self, factor: f64) -> Option<Arc<dyn Mode>> {
        Some(Arc::new(Self { transverse_amplitude: factor * self.transverse_amplitude, ..*self }))
    }
}
