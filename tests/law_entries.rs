//! Every law of the tables: it is built from the examples of its keys, and its slopes are those of its values.

use std::sync::Arc;

use fretwear::laws::entry::{Entry, Value, Values};
use fretwear::laws::wear::{Rubbing, Scales};
use fretwear::laws::{friction, wear};
use fretwear::units::{self, Kind};

/// The law of the examples.
fn example<L: ?Sized>(law: &'static Entry<L>) -> Arc<L> {
    let value = |kind: Kind, example: &str| match kind {
        Kind::Quantity(dimension) => Value::Number(
            units::parse(example, dimension).unwrap_or_else(|why| panic!("{}: {why}", law.name)),
        ),
        Kind::Word(words) => Value::Word(words[0]),
        other => panic!("{}: {other:?}", law.name),
    };
    let mut values = Values::new(law.keys, law.keys.iter().map(|key| value(key.kind, key.example)).collect());
    values.frequency = Some(10.0);
    (law.build)(&values).unwrap_or_else(|wrong| panic!("{}: {wrong:?}", law.name))
}

fn close(name: &str, found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-6, "{name}: {found:e} for {expected:e}");
}

fn slope(value: impl Fn(f64) -> f64, at: f64) -> f64 {
    let difference = 1e-5 * at;
    (value(at + difference) - value(at - difference)) / (2.0 * difference)
}

#[test]
fn examples_are_in_their_ranges_and_every_key_says_what_it_is() {
    let wear = wear::ENTRIES.iter().flat_map(|law| law.keys.iter().map(move |key| (law.name, key)));
    let friction = friction::ENTRIES.iter().flat_map(|law| law.keys.iter().map(move |key| (law.name, key)));
    for (law, key) in wear.chain(friction) {
        assert!(key.about.ends_with('.'), "{law}.{}: {}", key.name, key.about);
        if let Kind::Quantity(dimension) = key.kind {
            let value = units::parse(key.example, dimension).expect("a quantity");
            assert!(key.range.contains(value), "{law}.{}: {value} in {}", key.name, key.range);
        }
    }
}

#[test]
fn a_wear_law_has_the_slopes_of_its_values_and_scales_with_its_coefficient() {
    for entry in wear::ENTRIES {
        let law = example(entry);
        let name = entry.name;
        assert_eq!(law.entry().name, name);
        assert_eq!(law.values().len(), entry.keys.len(), "{name}");
        let at = |pressure: f64| Rubbing { pressure, mean_pressure: 1e8 };
        let (pressure, path) = (2.3e8, 1.7e-6);
        let rate = law.rate(&at(pressure));
        close(name, rate.by_pressure, slope(|p| law.rate(&at(p)).depth, pressure));
        let by_path = slope(|l| law.by_path(l), path) * path / law.by_path(path);
        assert!((law.path_exponent() - by_path).abs() < 1e-6, "{name}: {by_path}");
        if let Some([_, by_depth]) = law.of_cycle(3e3) {
            let worn = |depth: f64| law.of_cycle(depth).expect("at every depth")[0];
            close(name, by_depth, slope(worn, 3e3));
        }
        let scales = Scales { pressure: 2e8, path: 5e-6, friction: 0.7 };
        close(name, law.scaled(3.0).reference(&scales), 3.0 * law.reference(&scales));
        let words: String = law.words();
        assert!(!words.is_empty());
    }
}

#[test]
fn a_friction_law_has_the_slopes_of_its_values_and_an_inverse() {
    for entry in friction::ENTRIES {
        let law = example(entry);
        let name = entry.name;
        assert_eq!((law.entry().name, law.values().len()), (name, entry.keys.len()));
        let q = 2.3e-6;
        close(name, law.kinetic_strength_slope(q), slope(|q| law.kinetic_strength(q), q));
        close(name, law.compression_at(law.static_strength(q)), q);
        close(name, law.static_strength(q) / law.kinetic_strength(q), law.static_factor());
        close(name, law.scaled(3.0).kinetic_strength(q), 3.0 * law.kinetic_strength(q));
        assert_eq!([law.kinetic_strength(-q), law.kinetic_strength_slope(-q)], [0.0; 2], "{name}");
        if let Some(coefficient) = law.coefficient() {
            close(name, law.kinetic_strength(q), coefficient * q);
        }
    }
}
