//! Result files of every kind, small ones.

use std::fs;
use std::path::{Path, PathBuf};

use super::command::{done, run};

const UNIVERSALITY: &str = r#"
title = "Two cases"
[scene.indenter.paraboloid]
radius = 1
[scene.half_space]
grading = 0
normal_stiffness = 1
stiffness_ratio = 1
[scene.friction.coulomb]
coefficient = 0.5
[scene.wear.archard]
coefficient = 1e-3
[scene.loading]
indentation = 1
amplitude_ratio = 0.45
tau = 60
[scene.numerics]
springs = 20
tolerance = 1e-3
[[wear]]
name = "p s"
[[cases]]
name = "stopped early"
predicted = "outside"
patch = { loading = { tau = 1 } }
"#;

const STUDY: &str = r#"
title = "Six scenes"
scene = "scenes/paraboloid.toml"
[[axes]]
key = "friction.coulomb.coefficient"
values = [0.5, 0.6, 0.7]
[[axes]]
keys = ["numerics.accuracy", "wear.archard.coefficient", "half_space.poisson_ratio"]
rows = [[1e-2, "1e-8 1/MPa", 0.3], [1e-2, "2e-8 1/MPa", "similar"]]
[output]
snapshots = [1, 4]
"#;

/// A path that changes x, y and the indentation.
const PATH: &str = "0,0,0\n0.2,0.05,0.01\n0.3,0,0\n0,-0.1,0\n-0.3,0,0.01\n-0.1,0.05,0\n";

/// Makes a file of every kind in a folder: runs of different parts, shards, their merging, a map, a universality study, a trade-off.
pub fn every_kind(folder: &Path) -> Vec<PathBuf> {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let copies = folder.join("scenes");
    fs::create_dir(&copies).expect("a fresh folder");
    for entry in fs::read_dir(&scenes).expect("the scenes") {
        let path = entry.expect("readable").path();
        fs::copy(&path, copies.join(path.file_name().expect("a file"))).expect("copied");
    }
    let main = fs::read_to_string(scenes.join("paraboloid.toml")).expect("the main scene");
    let along = main
        .replace("amplitude = \"0.325 um\"", "path = { file = \"path.csv\", displacement_unit = \"um\" }");
    fs::write(copies.join("path.csv"), PATH).expect("written");
    fs::write(copies.join("along_path.toml"), along).expect("written");
    let mut files = vec![];
    // Each has a part that others have not: the limit, an edge of stick that moves, a table, loops along y, a path.
    for name in ["paraboloid", "normal_force", "measured_profile", "orbit", "along_path"] {
        let path = copies.join(format!("{name}.toml"));
        let scene = fs::read_to_string(&path).expect("the scene");
        let shorter = scene.replace("cycles = 1e6", "tau = 1").replace("tau = 30", "tau = 1");
        let few = "\n[numerics]\nsprings = 16\ntolerance = 1e-2\n[output]\nsnapshots = 5\n";
        let own = shorter.split("[numerics]").next().unwrap_or_default();
        fs::write(&path, own.to_owned() + few).expect("written");
        done(folder, &["run", &format!("scenes/{name}.toml"), "--quiet"]);
        files.push(folder.join(format!("{name}.h5")));
    }
    fs::write(copies.join("paraboloid.toml"), main).expect("written");
    fs::write(folder.join("study.toml"), STUDY).expect("written");
    for shard in ["0/2", "1/2"] {
        done(folder, &["sweep", "study.toml", "-o", "sweep", "--shard", shard, "--quiet"]);
    }
    done(folder, &["merge", "sweep", "-o", "merged.h5"]);
    files.extend(
        ["sweep/shard-0-of-2.h5", "sweep/shard-1-of-2.h5", "merged.h5"].map(|name| folder.join(name)),
    );
    let map = "[map]\ngrading = [-0.5, 0, 0.5]\namplitude_ratio = { from = 0.01, to = 1, count = 9 }\n";
    fs::write(folder.join("map.toml"), map).expect("written");
    done(folder, &["map", "map.toml", "-o", "map"]);
    fs::write(folder.join("universality.toml"), UNIVERSALITY).expect("written");
    let output = run(folder, &["universality", "universality.toml", "-o", "universality", "--quiet"]);
    assert!(output.status.code().is_some_and(|code| code < 2), "{}", super::command::text(&output.stderr));
    let ladders =
        ["--springs", "12", "--tolerances", "1e-2", "--accuracies", "1e-2", "--steppers", "implicit"];
    let command = ["tradeoff", "scenes/paraboloid.toml", "-o", "tradeoff", "--quiet", "--repeats", "1"];
    done(folder, &[&command[..], &ladders].concat());
    files.extend(
        ["map/map.h5", "universality/universality.h5", "tradeoff/tradeoff.h5"].map(|name| folder.join(name)),
    );
    files
}
