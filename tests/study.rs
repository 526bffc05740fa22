//! Studies: how they expand, and what is refused.

use std::path::Path;

use fretwear::laws::loading::Amplitude;
use fretwear::scene::{Input, Study, Task};

const BASE: &str = include_str!("support/base.toml");

fn study(text: &str) -> fretwear::Result<Study> {
    Study::from_texts(text, "study.toml", BASE, Path::new("base.toml"))
}

fn refusal(text: &str) -> String {
    study(text).expect_err(text).to_string()
}

#[test]
fn the_last_axis_runs_fastest_and_the_samples_faster_still() {
    let study = study(
        r#"
        scene = "base.toml"
        task = "limit"
        [[axes]]
        key = "friction.coulomb.coefficient"
        values = [0.3, 0.5]
        [[axes]]
        keys = ["half_space.grading", "loading.stick_ratio"]
        rows = [[0.0, 0.9], [0.2, 0.8], [0.4, 0.7]]
        [sampling]
        count = 5
        method = "latin-hypercube"
        seed = 4
        [[sampling.variables]]
        key = "wear.archard.coefficient"
        distribution = "log-normal"
        median = "1e-14 1/Pa"
        factor = 1.5
        "#,
    )
    .unwrap();
    assert_eq!((study.count(), study.task()), (30, Task::Limit));
    let inputs = study.inputs(17);
    // 17 = (1 * 3 + 0) * 5 + 2
    assert_eq!(inputs[..3], [Input::Number(0.5), Input::Number(0.0), Input::Number(0.9)]);
    let scene = study.scene(17).unwrap();
    assert_eq!(scene.friction().coefficient, 0.5);
    assert_eq!(scene.loading().amplitude, Amplitude::StickRatio(0.9));
    let Input::Number(sampled) = inputs[3] else { panic!("{inputs:?}") };
    assert!((scene.wear().coefficient / sampled - 1.0).abs() < 1e-15);
    // the sample is the same along the axes
    assert_eq!(study.inputs(2)[3], inputs[3]);
    assert_ne!(study.inputs(3)[3], inputs[3]);
    assert_eq!(study.keys().len(), 4);
}

#[test]
fn ranges_keep_their_unit_and_meet_their_ends() {
    let study = study(
        r#"
        scene = "base.toml"
        [[axes]]
        key = "loading.initial_force"
        from = "1 N"
        to = "100 N"
        count = 3
        spacing = "geometric"
        [[axes]]
        key = "indenter.paraboloid.radius"
        from = "5 mm"
        to = "20 mm"
        count = 4
        "#,
    )
    .unwrap();
    let of = |scene: u64, key: usize| match study.inputs(scene)[key] {
        Input::Number(number) => number,
        Input::Text(ref text) => panic!("{text}"),
    };
    let forces = [0, 4, 8].map(|scene| of(scene, 0));
    assert!(forces[0] == 1.0 && (forces[1] / 10.0 - 1.0).abs() < 1e-14 && forces[2] == 100.0, "{forces:?}");
    assert_eq!([0, 1, 2, 3].map(|scene| of(scene, 1)), [0.005, 0.01, 0.015, 0.02]);
    study.scene(11).unwrap();
}

#[test]
fn words_may_vary_too() {
    let study =
        study("scene = \"base.toml\"\n[[axes]]\nkey = \"numerics.stepper\"\nvalues = [\"implicit\", \"cycle-jump\"]")
            .unwrap();
    assert_eq!(study.inputs(1), [Input::Text("cycle-jump".into())]);
    assert_eq!(study.kinds(), [[false, true]]);
    study.scene(1).unwrap();
}

#[test]
fn the_hash_changes_with_study_and_scene() {
    let text = "scene = \"base.toml\"\n[[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [0.3]";
    let one = study(text).unwrap().hash();
    assert_eq!(one, study(text).unwrap().hash());
    assert_eq!(one.len(), 64);
    assert_ne!(one, study(&text.replace("0.3", "0.4")).unwrap().hash());
    let other = Study::from_texts(text, "study.toml", &BASE.replace("50 N", "51 N"), Path::new("base.toml"));
    assert_ne!(one, other.unwrap().hash());
}

#[test]
fn an_empty_study_is_its_base_scene() {
    let study = study("scene = \"base.toml\"").unwrap();
    assert_eq!((study.count(), study.inputs(0)), (1, vec![]));
    assert_eq!(study.scene(0).unwrap().friction().coefficient, 0.6);
}

#[test]
fn mistakes_are_named_with_place_and_cure() {
    let axis = |rest: &str| format!("scene = \"base.toml\"\n[[axes]]\n{rest}");
    let sampled = |rest: &str| {
        format!(
            "scene = \"base.toml\"\n[sampling]\ncount = 4\n[[sampling.variables]]\nkey = \"wear.archard.coefficient\"\n{rest}"
        )
    };
    for (text, expected) in [
        ("scene = \"base.toml\"\nsteps = 3".to_string(), "steps is not a key of a study"),
        (
            axis("key = \"friction\"\nvalues = [1]"),
            "is not a key of a scene; it is a table; name one of its keys",
        ),
        (
            axis("key = \"friction.coulomb.coefficient\""),
            "give exactly one of axes[0].values or axes[0].from; none is there",
        ),
        (axis("key = \"friction.coulomb.coefficient\"\nvalues = []"), "axes[0].values = [] is empty"),
        (
            axis("key = \"friction.coulomb.coefficient\"\nvalues = [{ x = 1 }]"),
            "is a table; vary its keys one by one",
        ),
        (
            axis("key = \"friction.coulomb.coefficient\"\nfrom = \"1 mm\"\nto = \"2 um\"\ncount = 3"),
            "has not the unit of axes[0].from, \"mm\"",
        ),
        (
            axis(
                "key = \"friction.coulomb.coefficient\"\nfrom = \"1 furlong\"\nto = \"2 furlong\"\ncount = 3",
            ),
            "\"furlong\" is no known unit",
        ),
        (
            axis(
                "key = \"friction.coulomb.coefficient\"\nfrom = 0\nto = 1\ncount = 3\nspacing = \"geometric\"",
            ),
            "must be above zero",
        ),
        (
            axis("key = \"friction.coulomb.coefficient\"\nfrom = 0\nto = 1\ncount = 1"),
            "axes[0].count = 1 is outside 2 to 10000000",
        ),
        (
            axis("keys = [\"friction.coulomb.coefficient\", \"loading.amplitude\"]\nrows = [[1, 2], [3]]"),
            "has 1 values for 2 keys",
        ),
        (
            axis(
                "key = \"friction.coulomb.coefficient\"\nvalues = [1]\n[[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [2]",
            ),
            "axes[1].key = \"friction.coulomb.coefficient\" is varied twice",
        ),
        (
            axis(
                "key = \"friction.coulomb.coefficient\"\nfrom = 0\nto = 1\ncount = 10000\n[[axes]]\nkey = \"loading.amplitude\"\nfrom = 0\nto = 1\ncount = 10000",
            ),
            "expands to 100000000 scenes, more than 10000000",
        ),
        (sampled("distribution = \"gaussian\""), "is none of the words it may be"),
        (
            sampled("distribution = \"normal\"\nmean = 1"),
            "distribution = \"normal\" needs mean and deviation",
        ),
        (sampled("distribution = \"normal\"\nmean = 1\ndeviation = 0"), "must be above zero"),
        (
            sampled("distribution = \"normal\"\nmean = 1\ndeviation = 1\nminimum = 2\nmaximum = 1"),
            "minimum is not below maximum",
        ),
        (sampled("distribution = \"uniform\"\nfrom = 2\nto = 1"), "is not above"),
        (sampled("distribution = \"log-normal\"\nmedian = 1\nfactor = 0.5"), "is outside (1, inf)"),
        ("scene = \"base.toml\"\n[output]\nsnapshots = [1]".to_string(), "is outside 0 to 0"),
        ("scene = \"base.toml\"\n[output]\nsnapshots = \"some\"".to_string(), "is none of the words"),
    ] {
        let message = refusal(&text);
        assert!(message.contains(expected) && message.starts_with("study.toml:"), "{text}\n{message}");
        assert!(message.contains("\n  |") && message.contains('^'), "no line is shown: {message}");
    }
    let missing = Study::read(Path::new("data/studies/no-such.toml")).unwrap_err().to_string();
    assert!(missing.contains("there is no such file"), "{missing}");
    let invalid = study(&axis("key = \"friction.coulomb.coefficient\"\nvalues = [-1]")).unwrap().scene(0);
    let message = invalid.unwrap_err().to_string();
    assert!(
        message.contains("study.toml, scene 0") && message.contains("friction.coulomb.coefficient"),
        "{message}"
    );
}
