//! Calibrations: published regressions, made data whose truth is known, what data cannot tell, and files that cannot be.

mod support;

use std::fs;
use std::path::Path;

use fretwear::Stop;
use fretwear::scene::sampling::{Method, UnitCube};
use fretwear::scene::{Calibration, Measured};
use fretwear::study::calibration::{Outcome, calibrate};
use rayon::prelude::*;
use serde_json::Value;
use support::calibration::{AMPLITUDE, BALL, FRICTION, SCAR, WEAR, csv, found, holds, noise, scar, truth};
use support::command::{done, run, text};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The two regressions through the origin of van Peteghem, Fouvry, Petit, Wear 271 (2011) 1535, with their standard errors.
#[test]
fn the_published_regressions_of_energies_are_reproduced() {
    for (group, slope, error) in [("5Hz", 97_429.0, 5_311.0), ("0.11Hz", 535_365.0, 21_895.0)] {
        let text = fs::read_to_string(root().join("data/calibration/ti6al4v_5hz.toml")).expect("readable");
        let text = text.replace("group = 5Hz", &format!("group = {group}"));
        let read =
            Calibration::from_toml(&text, "calibration", &root().join("data/calibration")).expect("valid");
        let outcome = calibrate(&read, &Stop::default()).expect("found").expect("not stopped");
        let it = &outcome.parameters[0];
        assert!((it.estimate * 1e18 - slope).abs() < 1.0, "{group}: {}", it.estimate);
        assert!((it.standard_error * 1e18 - error).abs() < 2.0, "{group}: {}", it.standard_error);
        // Student's interval of a linear problem, of as many degrees of freedom as there are values less one.
        let quantile = [2.776_445, 2.570_582][read.data()[0].values.len() - 5];
        for (end, side) in it.interval.iter().zip([-1.0, 1.0]) {
            let exact = it.estimate + side * quantile * it.standard_error;
            assert!((end.expect("told") / exact - 1.0).abs() < 1e-3, "{group}: {end:?} {exact}");
        }
    }
}

#[test]
fn a_wear_coefficient_from_volumes_costs_few_runs_and_is_right() {
    let cycles = [1e4, 3e4, 1e5, 2e5, 4e5, 7e5, 1e6];
    let volumes = truth(BALL, &[], &cycles).worn_volume();
    for factor in [0.1, 1.0, 7.0] {
        let scaled = cycles.map(|it| it / factor);
        let table = csv("N,V", &[&scaled, &volumes[1..]]);
        let data =
            "[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\nwear_volume = \"V\"\nrelative_deviation = 0.01\n";
        let outcome = found(BALL, &[("v.csv", &table)], &format!("{WEAR}{data}"));
        let it = &outcome.parameters[0];
        assert!((it.estimate / (factor * 1e-14) - 1.0).abs() < 1e-3, "{factor}: {}", it.estimate);
        assert!(
            outcome.runs <= 5 && outcome.accuracy_met,
            "{factor}: {} runs, {}",
            outcome.runs,
            outcome.run_error
        );
    }
}

#[test]
fn columns_are_read_however_they_are_written() {
    let tables = [
        "N,V [mm^3],s\n1000,1.5,0.1\n2000,3.25,0.1\n",
        "# comment\n\nN;V (mm3);s (mm3)\n1000;1,5;0,1 # here\n2000;3,25;0,1\n",
        "\u{feff}N\tV [mm^3]\ts\r\n1e3\t1,5\t1,0e-1\r\n2e3\t3,25\t0,1\r\n",
        "  N    V [mm^3]   s\n 1000  1.5  0.1\n 2000  3.25 0.1\n",
        "\"N\",\"V [mm^3]\",\"s\",note\n1000,1.5,0.1,\"a, b\"\n1500,,0.1,no volume\n2000,3.25,0.1,\n",
    ];
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), BALL).expect("written");
    for (number, table) in tables.iter().enumerate() {
        fs::write(folder.path().join("v.csv"), table).expect("written");
        let text = format!(
            "scene = \"scene.toml\"\n{WEAR}[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\nwear_volume = \"V\"\ndeviation = \"s\"\n"
        );
        let read = Calibration::from_toml(&text, "calibration", folder.path())
            .unwrap_or_else(|it| panic!("{number}: {it}"));
        let data = &read.data()[0];
        assert_eq!((data.measured, &data.at[..]), (Measured::WearVolume, &[1e3, 2e3][..]), "{number}");
        assert_eq!(data.values, [1.5e-9, 3.25e-9], "{number}");
        assert_eq!(data.deviation, fretwear::scene::Deviation::Known(vec![1e-10, 1e-10]), "{number}");
        assert_eq!(read.notes().len(), usize::from(number == 4));
    }
}

#[test]
fn a_scar_tells_its_coefficient_centre_offset_tilt_and_roughness() {
    let results = truth(BALL, &[], &[2e5]);
    let roughness = 0.02 * results.wear_depth()[1].iter().fold(0.0, |a: f64, b| a.max(*b));
    let outcome = found(
        BALL,
        &[("s.csv", &scar(&results, 11, roughness, 2.2e-5))],
        &format!("{WEAR}{SCAR}cycles = 2e5\n"),
    );
    let (it, data) = (&outcome.parameters[0], &outcome.data[0]);
    assert!(it.is_identifiable() && holds(&outcome, &[1e-14])[0], "{it:?}");
    assert!((it.estimate / 1e-14 - 1.0).abs() < 0.03, "{}", it.estimate);
    assert!((data.centre.expect("one") - 2.2e-5).abs() < 1e-6, "{:?}", data.centre);
    assert!(
        (data.ground[0] - 3e-7).abs() < 3.0 * roughness / 10.0 && (data.ground[1] - 1e-4).abs() < 2e-6,
        "{:?}",
        data.ground
    );
    assert!((data.deviations[0] / roughness - 1.0).abs() < 0.2, "{} {roughness}", data.deviations[0]);
    assert!((outcome.reduced_chi_squared - 1.0).abs() < 0.4, "{}", outcome.reduced_chi_squared);
}

/// The ground of McColl, Ding, Leen, Wear 256 (2004) 1114 is rough to 0.20 to 0.25 µm, and neighbours are alike; the contact was a plane one, so that the
/// coefficient means nothing here.
#[test]
fn a_measured_scar_is_read_with_its_roughness() {
    let table = fs::read_to_string(root().join("data/calibration/mccoll2004.csv")).expect("readable");
    let document = "[[unknowns]]\nkey = \"wear.archard.coefficient\"\nfrom = 2e-15\nto = 5e-14\n\
                    [[data]]\nfile = \"m.csv\"\nposition = \"position_mm [mm]\"\nheight = \"height_um [um]\"\ncycles = 18000\n\
                    set = { \"loading.amplitude\" = \"25 um\", \"indenter.paraboloid.radius\" = \"13 mm\", \"loading.normal_force\" = 18 }\n";
    let outcome = found(BALL, &[("m.csv", &table)], document);
    let data = &outcome.data[0];
    assert!((1.8e-7..2.8e-7).contains(&data.deviations[0]), "{}", data.deviations[0]);
    assert!(data.centre.expect("one").abs() < 5e-5, "{:?}", data.centre);
    assert!(outcome.warnings.iter().any(|it| it.contains("alike")), "{:?}", outcome.warnings);
}

/// Data whose truth is known: name, columns and document, truth, and whether the data tell all unknowns.
fn made_cases() -> Vec<(&'static str, String, String, Vec<f64>, bool)> {
    let seven = [1e4, 3e4, 1e5, 2e5, 4e5, 7e5, 1e6];
    let early = [500.0, 1e3, 2e3, 3e3, 4e3, 6e3, 8e3];
    let late = [1e6, 1.2e6, 1.4e6, 1.6e6, 1.8e6, 2e6];
    let table = |name: &str, cycles: &[f64], values: &[f64], part: f64, seed: u64| {
        let noisy: Vec<f64> =
            values[1..].iter().zip(noise(seed, cycles.len())).map(|(v, e)| v * (1.0 + part * e)).collect();
        csv(&format!("N,{name}"), &[cycles, &noisy])
    };
    let data = |key: &str, deviation: &str| {
        format!(
            "[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\n{key} = \"V\"\nrelative_deviation = {deviation}\n"
        )
    };
    let gross = ["loading.normal_force=10", "loading.amplitude=2e-6"];
    let slide = "set = { \"loading.normal_force\" = 10 }\n";
    let wide = "[[unknowns]]\nkey = \"loading.amplitude\"\nfrom = \"1.2 um\"\nto = \"4 um\"\n";
    let moduli = "[[unknowns]]\nkey = \"half_space.modulus\"\nfrom = \"70 GPa\"\nto = \"150 GPa\"\n";
    let volumes = |settings: &[&str], cycles: &[f64], part, seed| {
        table("V", cycles, &truth(BALL, settings, cycles).worn_volume(), part, seed)
    };
    let (plain, first, last) =
        (volumes(&[], &seven, 0.02, 1), volumes(&[], &early, 0.02, 2), volumes(&[], &late, 0.02, 3));
    let sliding = volumes(&gross, &early, 0.02, 4);
    let far =
        volumes(&["loading.normal_force=10", "loading.amplitude=40e-6"], &early.map(|it| it / 20.0), 0.05, 8);
    let forces = table("V", &early, &truth(BALL, &gross, &early).tangential_force(), 0.02, 5);
    let energies = table("V", &early, &truth(BALL, &gross, &early).cycle_energy(), 0.02, 6);
    let radii = table("V", &seven, &truth(BALL, &[], &seven).contact_radius(), 0.002, 7);
    let gross_data = |key: &str| data(key, "0.02") + &slide.replace(" }", ", \"loading.amplitude\" = 2e-6 }");
    let over_energy = "E,V\n1,2e-14\n2,3.9e-14\n3,6.1e-14\n5,1e-13\n".to_owned();
    let by_energy = "[[data]]\nfile = \"v.csv\"\ndissipated_energy = \"E\"\nwear_volume = \"V\"\n".to_owned();
    let volume = data("wear_volume", "0.02");
    vec![
        ("volumes in partial slip", plain.clone(), format!("{WEAR}{volume}"), vec![1e-14], true),
        (
            "volumes and amplitude to the limit",
            plain.clone(),
            format!("{WEAR}{AMPLITUDE}{volume}"),
            vec![1e-14, 3.25e-7],
            true,
        ),
        (
            "deviation estimated",
            plain.clone(),
            format!("{WEAR}{}", data("wear_volume", "\"estimated\"")),
            vec![1e-14],
            true,
        ),
        ("amplitude alone", last.clone(), format!("{AMPLITUDE}{volume}"), vec![3.25e-7], true),
        ("coefficient early", first.clone(), format!("{WEAR}{volume}"), vec![1e-14], true),
        ("gross slip", sliding.clone(), format!("{WEAR}{}", gross_data("wear_volume")), vec![1e-14], true),
        (
            "friction from forces",
            forces,
            format!("{FRICTION}{}", gross_data("tangential_force")),
            vec![0.7],
            true,
        ),
        (
            "friction from energies",
            energies,
            format!("{FRICTION}{}", gross_data("cycle_energy")),
            vec![0.7],
            true,
        ),
        ("radii", radii, format!("{WEAR}{}", data("contact_radius", "0.002")), vec![1e-14], true),
        ("volumes over energies", over_energy.clone(), format!("{WEAR}{by_energy}"), vec![2e-14 * 0.7], true),
        (
            "coefficient and amplitude, early",
            first.clone(),
            format!("{WEAR}{AMPLITUDE}{volume}"),
            vec![1e-14, 3.25e-7],
            false,
        ),
        (
            "coefficient and amplitude, gross slip",
            sliding.clone(),
            format!("{WEAR}{wide}{volume}{slide}"),
            vec![1e-14, 2e-6],
            false,
        ),
        ("coefficient from the limit", last.clone(), format!("{WEAR}{volume}"), vec![1e-14], false),
        (
            "friction and amplitude from the limit",
            last.clone(),
            format!("{FRICTION}{AMPLITUDE}{volume}"),
            vec![0.7, 3.25e-7],
            false,
        ),
        (
            "coefficient and friction over energies",
            over_energy,
            format!("{WEAR}{FRICTION}{by_energy}"),
            vec![1.4e-14, 0.7],
            false,
        ),
        (
            "coefficient and force, gross slip",
            sliding.clone(),
            format!(
                "{WEAR}[[unknowns]]\nkey = \"loading.normal_force\"\nfrom = 5\nto = 20\n{volume}set = {{ \"loading.amplitude\" = 2e-6 }}\n"
            ),
            vec![1e-14, 10.0],
            false,
        ),
        (
            "modulus from wide gross slip",
            far,
            format!("{moduli}{volume}{}", slide.replace(" }", ", \"loading.amplitude\" = 40e-6 }")),
            vec![105e9],
            false,
        ),
        (
            "threshold never reached",
            first.clone(),
            format!(
                "[[unknowns]]\nkey = \"wear.threshold.coefficient\"\nfrom = 1e-16\nto = 1e-12\n[[unknowns]]\nkey = \"wear.threshold.pressure\"\nfrom = \"1 Pa\"\nto = \"400 MPa\"\n{volume}"
            ),
            vec![1e-14, 1.0],
            false,
        ),
        (
            "coefficient and friction, early",
            first,
            format!("{WEAR}{FRICTION}{volume}"),
            vec![1e-14, 0.7],
            false,
        ),
        (
            "two moduli",
            plain,
            format!(
                "[[unknowns]]\nkey = \"half_space.modulus\"\nfrom = \"190 GPa\"\nto = \"230 GPa\"\n[[unknowns]]\nkey = \"counter_body.modulus\"\nfrom = \"190 GPa\"\nto = \"230 GPa\"\n{volume}set = {{ \"counter_body.poisson_ratio\" = 0.3 }}\n"
            ),
            vec![210e9, 210e9],
            false,
        ),
    ]
}

#[test]
fn what_the_data_do_not_tell_is_said_and_nothing_else() {
    let cases = made_cases();
    assert_eq!(cases.iter().filter(|it| it.4).count(), 10);
    assert_eq!(cases.len(), 20);
    let results: Vec<(String, bool)> = cases
        .par_iter()
        .map(|(name, table, document, truths, told)| {
            let outcome = found(BALL, &[("v.csv", table)], document);
            let all = outcome.parameters.iter().all(|it| it.is_identifiable());
            let shown: Vec<String> = outcome
                .parameters
                .iter()
                .map(|it| format!("{} = {:e} ({:?})", it.key, it.estimate, it.interval))
                .collect();
            let inside = holds(&outcome, truths).iter().all(|it| *it);
            let line = format!(
                "{name}: told {all}, truth inside {inside}, {} runs, {:.2} s; {}; {:?}",
                outcome.runs,
                outcome.wall_seconds,
                shown.join("; "),
                outcome.warnings
            );
            (line, all == *told)
        })
        .collect();
    results.iter().for_each(|(line, _)| println!("{line}"));
    let wrong: Vec<&String> = results.iter().filter(|(_, right)| !right).map(|(line, _)| line).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_product_that_gross_slip_tells_is_named() {
    let cycles = [500.0, 1e3, 2e3, 3e3, 4e3];
    let results = truth(BALL, &["loading.normal_force=10", "loading.amplitude=20e-6"], &cycles);
    let table = csv("N,V", &[&cycles, &results.worn_volume()[1..]]);
    let document = format!(
        "{WEAR}[[unknowns]]\nkey = \"loading.amplitude\"\nfrom = \"15 um\"\nto = \"30 um\"\n[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\n\
         wear_volume = \"V\"\nrelative_deviation = 0.02\nset = {{ \"loading.normal_force\" = 10 }}\n"
    );
    let outcome = found(BALL, &[("v.csv", &table)], &document);
    // V = 4 k_w F U N while the elastic part of the stroke is small.
    let product = &outcome.combinations[0];
    let exponents: Vec<f64> = product.factors.iter().map(|(_, exponent)| *exponent).collect();
    assert!(exponents.len() == 2 && exponents.iter().all(|it| (it - 1.0).abs() < 0.08), "{product:?}");
    assert!(product.relative < 0.03, "{product:?}");
}

/// Volumes by a power of the pressure, and Archard's law beside it: with errors of 1 % the data tell, by eight numbers.
#[test]
fn laws_are_told_apart_by_akaikes_criterion() {
    let cycles = [2e3, 1e4, 3e4, 1e5, 2e5, 4e5, 7e5, 1e6];
    let power = [
        "wear.power-law.coefficient=3.3e-27",
        "wear.power-law.pressure_exponent=2.5",
        "wear.power-law.slip_exponent=1",
    ];
    let volumes = truth(BALL, &power, &cycles).worn_volume();
    let noisy: Vec<f64> = volumes[1..].iter().zip(noise(4, 8)).map(|(v, e)| v * (1.0 + 0.01 * e)).collect();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), BALL).expect("written");
    fs::write(folder.path().join("v.csv"), csv("N,V", &[&cycles, &noisy])).expect("written");
    let document = "scene = \"scene.toml\"\n[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\nwear_volume = \"V\"\nrelative_deviation = 0.01\n\
                    [[models]]\nname = \"Archard\"\n[[models.unknowns]]\nkey = \"wear.archard.coefficient\"\nfrom = 1e-17\nto = 1e-11\n\
                    [[models]]\nname = \"power\"\nset = { \"wear.power-law.pressure_exponent\" = 2.5, \"wear.power-law.slip_exponent\" = 1 }\n\
                    [[models.unknowns]]\nkey = \"wear.power-law.coefficient\"\nfrom = 1e-29\nto = 1e-25\n";
    fs::write(folder.path().join("laws.toml"), document).expect("written");
    let printed = done(folder.path(), &["calibrate", "laws.toml", "-o", "out", "--json"]);
    let json: Value = serde_json::from_str(&printed).expect("one JSON object");
    let models = json["models"].as_array().expect("two");
    assert_eq!((models.len(), models[0]["name"].as_str()), (2, Some("power")), "{models:?}");
    assert!(
        models[0]["weight"].as_f64() > Some(0.99) && models[1]["aicc"].as_f64() > models[0]["aicc"].as_f64(),
        "{models:?}"
    );
    let estimate = json["parameters"][0]["estimate"].as_f64().expect("a number");
    assert!((estimate / 3.3e-27 - 1.0).abs() < 0.03, "{estimate}");
    assert!(folder.path().join("out/models.csv").exists());
}

#[test]
fn an_outlier_is_named_and_pulls_less_under_hubers_loss() {
    let energies: Vec<f64> = (1..=20).map(f64::from).collect();
    let mut volumes: Vec<f64> =
        energies.iter().zip(noise(5, 20)).map(|(it, e)| 1e-14 * it + 1e-15 * e).collect();
    volumes[12] *= 3.0;
    let data =
        "[[data]]\nfile = \"v.csv\"\ndissipated_energy = \"E\"\nwear_volume = \"V\"\ndeviation = 1e-15\n";
    let document = format!("{}{data}", WEAR.replace("archard", "dissipated-energy"));
    let table = csv("E,V", &[&energies, &volumes]);
    let [squares, huber] = ["squares", "huber"]
        .map(|loss| found("", &[("v.csv", &table)], &format!("loss = \"{loss}\"\n{document}")));
    let error = |it: &Outcome| (it.parameters[0].estimate / 1e-14 - 1.0).abs();
    assert!(
        error(&huber) < 0.02 && error(&squares) > 5.0 * error(&huber),
        "{} {}",
        error(&huber),
        error(&squares)
    );
    assert!(squares.warnings.iter().any(|it| it.contains("v.csv:14 ")), "{:?}", squares.warnings);
}

/// Edits of a text: a piece taken out, doubled, or replaced by what does not belong there.
fn damaged(text: &str, seed: u64) -> String {
    const STRANGE: [&str; 14] = [
        "\"",
        "[[",
        "= =",
        "-1",
        "1e999",
        "nan",
        "\u{0}",
        ";;;",
        "\t",
        "☃",
        "\"\"",
        "{}",
        "99999999999999999999",
        ",,",
    ];
    let cube = UnitCube::new(Method::Random, 4, 1, seed);
    let pick = |i: u64, count: usize| (cube.coordinate(i, 0) * count as f64) as usize;
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).chain([text.len()]).collect();
    let (one, two) = (pick(0, places.len()), pick(1, places.len()));
    let (from, to) =
        (places[one.min(two)], places[one.max(two).min(one.min(two) + 12).min(places.len() - 1)]);
    let strange = STRANGE[pick(2, STRANGE.len())];
    match pick(3, 3) {
        0 => format!("{}{}", &text[..from], &text[to..]),
        1 => format!("{}{strange}{}", &text[..from], &text[to..]),
        _ => format!("{}{}", &text[..to], &text[from..]),
    }
}

fn survives_damage(count: u64) {
    let energies = "test,E [J],V [um^3],s\n1,17200,1.81e9,1e8\n2,7010,8.88e8,1e8\n3,10400,1.14e9,1e8\n4,1130,1.17e8,1e8\n";
    let document = "title = \"made\"\n[[unknowns]]\nkey = \"wear.dissipated-energy.coefficient\"\nfrom = \"1e2 um^3/J\"\nto = \"1e8 um^3/J\"\n\
                    scale = \"log\"\n[[data]]\nfile = \"v.csv\"\ndissipated_energy = \"E\"\nwear_volume = \"V\"\ndeviation = \"s\"\n";
    let mut refused = 0;
    for seed in 0..count {
        let folder = tempfile::tempdir().expect("a folder");
        let (table, text) = match seed % 2 {
            0 => (damaged(energies, seed), document.to_owned()),
            _ => (energies.to_owned(), damaged(document, seed)),
        };
        fs::write(folder.path().join("v.csv"), &table).expect("written");
        let read = Calibration::from_toml(&text, "calibration.toml", folder.path());
        let end =
            read.and_then(|it| calibrate(&it, &Stop::default()).map(|outcome| outcome.expect("not stopped")));
        match end {
            Ok(outcome) => assert!(outcome.parameters[0].estimate.is_finite(), "{table}\n{text}"),
            Err(error) => {
                refused += 1;
                let message = error.to_string();
                assert!(message.len() > 20, "{message}");
                assert!(
                    ["calibration", "v.csv", "data", "set"].iter().any(|it| message.contains(it)),
                    "{message}"
                );
            }
        }
    }
    assert!(refused > count / 3, "{refused} of {count}");
}

#[test]
fn damaged_files_are_refused_with_a_reason() {
    survives_damage(200);
}

#[test]
#[ignore = "2,000 files"]
fn two_thousand_damaged_files_are_refused_with_a_reason() {
    survives_damage(2000);
}

#[test]
fn what_cannot_be_is_refused_at_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), BALL).expect("written");
    fs::write(folder.path().join("v.csv"), "N,V [mm^3]\n1e3,1e-8\n2e3,x\n").expect("written");
    fs::write(folder.path().join("w.csv"), "N,V [mm^3]\n1e3,1e-8\n2e3,2e-8\n").expect("written");
    let data = "[[data]]\nfile = \"w.csv\"\ncycles = \"N\"\nwear_volume = \"V\"\n";
    let scene = "scene = \"scene.toml\"\n";
    for (document, told) in [
        (format!("{scene}{WEAR}{}", data.replace("w.csv", "v.csv")), "v.csv: line 3: V = \"x\""),
        (format!("{scene}{WEAR}{}", data.replace("w.csv", "u.csv")), "there is no such file"),
        (format!("{scene}{WEAR}{}", data.replace("\"N\"", "\"n\"")), "is no column of"),
        (format!("{scene}{WEAR}{data}unit = \"um^3\"\n"), "is not mm^3, which the header"),
        (format!("{WEAR}{data}"), "needs the scene"),
        (format!("{scene}{data}"), "unknowns is missing"),
        (format!("{scene}{WEAR}"), "data is missing"),
        (format!("{scene}{WEAR}{WEAR}{data}"), "is named twice"),
        (
            format!("{scene}{}{data}", WEAR.replace("archard.coefficient", "archard.coeficient")),
            "is not a key of a scene",
        ),
        (
            format!("{scene}{}{data}", WEAR.replace("wear.archard.coefficient", "loading.cycles")),
            "follows from the data",
        ),
        (format!("{scene}{}{data}", WEAR.replace("1e-17", "1e-10")), "is not above"),
        (format!("{scene}{}{data}", WEAR.replace("1e-17", "-1")), "outside"),
        (
            format!("{scene}{WEAR}{data}set = {{ \"wear.archard.coefficient\" = 1e-14 }}\n"),
            "exclude each other",
        ),
        (format!("{scene}{WEAR}{data}set = {{ \"loading.amplitude\" = \"2 kg\" }}\n"), "expected a length"),
        (format!("{scene}{WEAR}{data}height = \"z\"\n"), "height"),
        (format!("{scene}{WEAR}{data}where = \"N = 5\"\n"), "holds no row"),
        (format!("{scene}{WEAR}{AMPLITUDE}{data}"), "do not tell 2 numbers"),
    ] {
        let read = Calibration::from_toml(&document, "calibration.toml", folder.path());
        let end = read.and_then(|it| calibrate(&it, &Stop::default()));
        let message = end.err().unwrap_or_else(|| panic!("{document}")).to_string();
        assert!(message.contains(told), "{told:?} in {message}");
    }
}

#[test]
fn the_command_prints_json_writes_its_files_and_overwrites_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let source = root().join("data/calibration/ti6al4v_5hz.toml").display().to_string();
    let printed = done(folder.path(), &["calibrate", &source, "-o", "out", "--json"]);
    let json: Value = serde_json::from_str(&printed).expect("one JSON object");
    let parameter = &json["parameters"][0];
    for key in ["key", "unit", "estimate", "lower", "upper", "identifiable"] {
        assert!(!parameter[key].is_null(), "{key}: {parameter}");
    }
    for key in ["reduced_chi_squared", "correlation", "residuals", "warnings"] {
        assert!(!json[key].is_null(), "{key}");
    }
    assert_eq!(json["residuals"].as_array().map(Vec::len), Some(5));
    for name in ["calibration.h5", "parameters.csv", "residuals.csv"] {
        assert!(folder.path().join("out").join(name).exists(), "{name}");
    }
    let again = run(folder.path(), &["calibrate", &source, "-o", "out"]);
    assert_eq!(again.status.code(), Some(2), "{}", text(&again.stderr));
    assert!(text(&again.stderr).contains("--force"), "{}", text(&again.stderr));
    done(folder.path(), &["plot", "out/calibration.h5", "-o", "fit.svg"]);
    done(folder.path(), &["report", "out/calibration.h5", "-o", "fit.html"]);
    done(folder.path(), &["info", "out/calibration.h5"]);
    // A calibration to begin with, on the scene to begin with.
    done(folder.path(), &["init", "calibration", "-o", "begin.toml"]);
    done(folder.path(), &["init", "-o", "scene.toml"]);
    fs::write(folder.path().join("volumes.csv"), "N;V [um^3]\n1000;8,1\n2000;16,4\n4000;31,9\n")
        .expect("written");
    done(folder.path(), &["calibrate", "begin.toml", "-o", "begun"]);
    fs::write(folder.path().join("bad.toml"), "[[unknowns]]\nkey = \"wear\"\n").expect("written");
    let bad = run(folder.path(), &["calibrate", "bad.toml", "-o", "none"]);
    assert_eq!(bad.status.code(), Some(2));
    assert!(!folder.path().join("none").exists());
}
