//! The command `submit`, as a script sees it: what it proposes, what it writes, what it refuses.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

const SCENE: &str = include_str!("support/base.toml");

/// A name with everything that a shell would take for something else.
const HOSTILE: &str = "it's a \"study\" $(touch bad) `touch bad` @SHARDS@ %j \\ *; exit 9 #";

struct Place(TempDir);

impl Place {
    fn new(scenes: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join(HOSTILE)).unwrap();
        let this = Self(folder);
        std::fs::write(this.path("base.toml"), SCENE).unwrap();
        let axis =
            format!("key = \"friction.coulomb.coefficient\"\nfrom = 0.3\nto = 0.6\ncount = {scenes}\n");
        std::fs::write(this.path("study.toml"), format!("scene = \"base.toml\"\n[[axes]]\n{axis}")).unwrap();
        this
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(HOSTILE).join(name)
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// `submit` with the study, into `out`, where no engine can be found.
    fn submit(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fretwear"));
        command.current_dir(self.0.path()).env("PATH", self.0.path());
        command.arg("submit").arg(self.path("study.toml")).arg("-o").arg(self.path("out"));
        command.args(arguments).output().unwrap()
    }

    fn object(&self, arguments: &[&str]) -> Value {
        let output = self.submit(&[&["--json", "--dry-run"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }

    fn refused(&self, arguments: &[&str]) -> String {
        let output = self.submit(arguments);
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        message
    }

    /// A program that the scripts find before all others.
    fn stand_in(&self, name: &str, script: &str) {
        use std::os::unix::fs::PermissionsExt;
        let path = self.0.path().join(name);
        std::fs::write(&path, format!("#!/bin/bash\n{script}\n")).unwrap();
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Runs a script with the stand-ins.
    fn bash(&self, script: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Output {
        let path = format!("{}:{}", self.0.path().display(), std::env::var("PATH").unwrap());
        let mut command = Command::new("bash");
        command.current_dir(self.0.path()).arg(self.path(script)).args(arguments);
        command.env("PATH", path).envs(variables.iter().copied()).output().unwrap()
    }
}

const SLURM: [&str; 2] = ["--engine", "slurm"];
const HYPERQUEUE: [&str; 2] = ["--engine", "hyperqueue"];

#[test]
fn a_dry_run_measures_a_few_scenes_and_writes_scripts() {
    let place = Place::new(40);
    let answer = place.object(&SLURM);
    assert_eq!((answer["scenes"].as_u64(), answer["task"].as_str()), (Some(40), Some("run")));
    let measured: Vec<_> = answer["measured"].as_array().unwrap().iter().collect();
    assert_eq!(measured.len(), 5, "{answer}");
    assert!(
        measured.iter().all(|it| it["seconds"].as_f64() > Some(0.0) && it["failure"].is_null()),
        "{answer}"
    );
    assert_eq!((answer["shards"].as_u64(), answer["largest_array"].as_u64()), (Some(1), Some(1001)));
    assert_eq!((answer["submitted"].as_bool(), answer["jobs"].as_array().unwrap().len()), (Some(false), 0));
    for name in ["sweep.sbatch", "merge.sbatch", "submit.sh"] {
        assert!(place.path(&format!("out/{name}")).exists(), "{name}");
    }
    let script = place.read("out/sweep.sbatch");
    assert!(script.contains("#SBATCH --array=0-0\n") && script.contains("#SBATCH --mem="), "{script}");
}

#[test]
fn the_closed_form_is_measured_too() {
    let place = Place::new(8);
    let study = format!("task = \"limit\"\n{}", place.read("study.toml"));
    std::fs::write(place.path("study.toml"), study).unwrap();
    let answer = place.object(&SLURM);
    assert_eq!(answer["task"], "limit");
    assert!(answer["seconds_per_scene"].as_f64().unwrap() > 0.0, "{answer}");
}

#[test]
fn what_is_asked_for_stands_in_the_scripts() {
    let place = Place::new(40);
    let asked = [
        &SLURM[..],
        &[
            "--shards",
            "16",
            "--cpus-per-task",
            "8",
            "--time-limit",
            "45",
            "--memory",
            "7G",
            "--max-requeues",
            "3",
        ],
        &[
            "--partition",
            "long",
            "--account",
            "wear",
            "--engine-option=--qos=low",
            "--seconds-per-scene",
            "9.5",
        ],
        &["--checkpoint-interval", "12.5"],
    ];
    let answer = place.object(&asked.concat());
    assert_eq!((answer["shards"].as_u64(), answer["measured"].as_array().unwrap().len()), (Some(16), 0));
    let script = place.read("out/sweep.sbatch");
    for line in [
        "#SBATCH --array=0-15",
        "#SBATCH --cpus-per-task=8",
        "#SBATCH --time=45",
        "#SBATCH --signal=B:USR1@70",
        "#SBATCH --mem=7G",
        "#SBATCH --partition=long",
        "#SBATCH --account=wear",
        "#SBATCH --qos=low",
        "shards=16",
        "most_requeues=3",
    ] {
        assert!(script.lines().any(|it| it == line), "{line} is not in\n{script}");
    }
    assert!(script.contains("--checkpoint-interval 12.5 "), "{script}");
    assert!(place.read("out/merge.sbatch").contains("#SBATCH --partition=long\n"));
    let left: Vec<_> = script.split('@').collect();
    assert_eq!(left.len(), 2 + HOSTILE.matches('@').count() * 2, "a name without a value in\n{script}");
}

#[test]
fn the_slurm_scripts_run_whatever_the_paths_are_called() {
    let place = Place::new(4);
    place.object(&[&SLURM[..], &["--shards", "2", "--cpus-per-task", "1"]].concat());
    // sbatch is called in the folder of the scripts, and answers like that of a cluster with a name.
    place.stand_in("sbatch", "echo \"$PWD $*\" >>\"${0%/*}/calls\"; echo '17;big'");
    let output = place.bash("out/submit.sh", &["--array=1"], &[]);
    assert_eq!(
        String::from_utf8(output.stdout).unwrap(),
        "17 17\n",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let calls = std::fs::read_to_string(place.0.path().join("calls")).unwrap();
    let folder = place.path("out").display().to_string();
    let expected = format!(
        "{folder} --parsable --array=1 sweep.sbatch\n{folder} --parsable --dependency=afterany:17 merge.sbatch\n"
    );
    assert_eq!(calls, expected);
    for shard in ["0", "1"] {
        let variables =
            [("SLURM_ARRAY_JOB_ID", "17"), ("SLURM_ARRAY_TASK_ID", shard), ("SLURM_ARRAY_TASK_COUNT", "1")];
        let output = place.bash("out/sweep.sbatch", &[], &variables);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let output = place.bash("out/merge.sbatch", &[], &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(place.path("out/merged.h5").exists());
    assert!(!place.0.path().join("bad").exists(), "a part of a name was run");
}

#[test]
fn the_hyperqueue_scripts_run_whatever_the_paths_are_called() {
    let place = Place::new(4);
    let option = "--engine-option=--pin=a b";
    place.object(&[&HYPERQUEUE[..], &["--shards", "2", "--cpus-per-task", "1", option]].concat());
    place.stand_in("hq", "printf '<%s>' \"$@\" >>\"${0%/*}/calls\"; echo 5");
    assert_eq!(place.bash("out/submit.sh", &[], &[]).stdout, b"5\n");
    assert_eq!(place.bash("out/submit.sh", &["--array=1"], &[]).stdout, b"5\n");
    let calls = std::fs::read_to_string(place.0.path().join("calls")).unwrap();
    let fixed = "<--cpus=1><--crash-limit=20><--stdout=none><--stderr=none><--pin=a b>";
    let call = |array| {
        format!(
            "<--output-mode=quiet><submit><--name=fretwear-study>{fixed}<--array={array}><--><bash><./sweep-hq.sh>"
        )
    };
    assert_eq!(calls, call("0-1") + &call("1"));
    let shard = |task| place.bash("out/sweep-hq.sh", &[], &[("HQ_TASK_ID", task)]).status.code();
    assert_eq!(shard("1"), Some(0));
    // The stand-in's job has ended with a failed task.
    place.stand_in("hq", "exit 1");
    let output = place.bash("out/merge-hq.sh", &["5"], &[]);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("hq job task-ids 5 --filter=failed,canceled"), "{message}");
    assert_eq!(shard("0"), Some(0));
    assert_eq!(place.bash("out/merge-hq.sh", &["5"], &[]).status.code(), Some(0));
    assert!(place.path("out/merged.h5").exists() && !place.0.path().join("bad").exists());
}

/// Runs the script of a shard with a program in place of `fretwear` that ends with 75, and what Slurm says of the job; what the script
/// printed and asked Slurm for.
fn after_75(state: &str, restarts: &str) -> (String, String) {
    let place = Place::new(4);
    place.object(&[&SLURM[..], &["--max-requeues", "2", "--seconds-per-scene", "1"]].concat());
    let script = place.read("out/sweep.sbatch");
    let program = script.lines().find(|line| line.starts_with("fretwear=")).unwrap();
    std::fs::write(place.path("out/sweep.sbatch"), script.replace(program, "fretwear=stopped")).unwrap();
    place.stand_in("stopped", "exit 75");
    place.stand_in("squeue", &format!("echo '{state}'"));
    place.stand_in("scontrol", "echo \"$*\" >\"${0%/*}/asked\"");
    place.stand_in("sleep", "exit 0");
    let variables =
        [("SLURM_ARRAY_JOB_ID", "17"), ("SLURM_ARRAY_TASK_ID", "0"), ("SLURM_RESTART_COUNT", restarts)];
    let output = place.bash("out/sweep.sbatch", &[], &variables);
    let asked = std::fs::read_to_string(place.0.path().join("asked")).unwrap_or_default();
    (String::from_utf8(output.stdout).unwrap(), asked)
}

#[test]
fn a_shard_is_queued_again_after_75_but_not_for_ever_and_not_when_cancelled() {
    assert_eq!(after_75("RUNNING 10:00", "1").1, "requeue 17_0\n");
    assert_eq!(after_75("COMPLETING 0:00", "0").1, "requeue 17_0\n");
    assert_eq!(after_75("COMPLETING INVALID", "0").1, "requeue 17_0\n");
    // squeue got no answer: scontrol tries again by itself.
    assert_eq!(after_75("", "0").1, "requeue 17_0\n");
    let (printed, asked) = after_75("COMPLETING 4:56", "0");
    assert!(printed.contains("left to it") && asked.is_empty(), "{printed}{asked}");
    let (printed, asked) = after_75("RUNNING 10:00", "2");
    assert!(printed.contains("queued again 2 times already") && asked.is_empty(), "{printed}{asked}");
}

#[test]
fn scripts_are_not_overwritten_unasked() {
    let place = Place::new(4);
    place.object(&SLURM);
    std::fs::write(place.path("out/sweep.sbatch"), "mine").unwrap();
    let message = place.refused(&[&SLURM[..], &["--dry-run"]].concat());
    assert!(message.contains("sweep.sbatch: exists already") && message.contains("--force"), "{message}");
    assert_eq!(place.read("out/sweep.sbatch"), "mine");
    // Nor is one that this program did not write.
    let message = place.refused(&[&SLURM[..], &["--dry-run", "--force"]].concat());
    assert!(message.contains("sweep.sbatch") && message.contains("not written by fretwear"), "{message}");
    let edited = place.read("out/merge.sbatch").replace("--time=60", "--time=90");
    std::fs::write(place.path("out/merge.sbatch"), &edited).unwrap();
    std::fs::remove_file(place.path("out/sweep.sbatch")).unwrap();
    place.object(&[&SLURM[..], &["--force"]].concat());
    assert_ne!(place.read("out/merge.sbatch"), edited);
}

#[test]
fn results_that_are_there_dictate_the_number_of_shards() {
    let place = Place::new(8);
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_fretwear"));
    sweep
        .arg("sweep")
        .arg(place.path("study.toml"))
        .arg("-o")
        .arg(place.path("out"))
        .args(["--shard", "1/4"]);
    assert!(sweep.output().unwrap().status.success());
    assert_eq!(place.object(&SLURM)["shards"].as_u64(), Some(4));
    let message = place.refused(&[&SLURM[..], &["--dry-run", "--force", "--shards", "2"]].concat());
    assert!(message.contains("results of 4 shards"), "{message}");
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_written() {
    let place = Place::new(4);
    let dry = |arguments: &[&str]| place.refused(&[&["--dry-run"], arguments].concat());
    let slurm = |arguments: &[&str]| dry(&[&SLURM[..], arguments].concat());
    assert!(
        place.refused(&SLURM).contains("there is no sbatch here")
            && place.refused(&SLURM).contains("--dry-run")
    );
    assert!(place.refused(&HYPERQUEUE).contains("there is no hq here"));
    assert!(dry(&["--engine", "cron"]).contains("slurm or hyperqueue"));
    assert!(slurm(&["--shards", "5"]).contains("give 1 to 4"));
    assert!(slurm(&["--partition", "a b"]).contains("--partition"));
    assert!(slurm(&["--memory", "much"]).contains("--memory"));
    assert!(slurm(&["--seconds-per-scene", "0"]).contains("--seconds-per-scene"));
    assert!(slurm(&["--engine-option=--a\n#SBATCH --b"]).contains("line break"));
    assert!(dry(&[&HYPERQUEUE[..], &["--partition", "long"]].concat()).contains("belongs to Slurm"));
    let bad = place.read("study.toml").replace("from = 0.3", "from = -0.3");
    std::fs::write(place.path("study.toml"), bad).unwrap();
    assert!(slurm(&[]).contains("2 of 4 scenes are not valid"), "{}", slurm(&[]));
    assert!(!place.path("out").exists(), "nothing is written");
}

#[test]
fn a_line_break_in_a_path_is_refused() {
    let place = Place::new(4);
    let mut command = Command::new(env!("CARGO_BIN_EXE_fretwear"));
    command.arg("submit").arg(place.path("study.toml")).args(SLURM).arg("--dry-run");
    let output = command.arg("-o").arg(place.path("o\nut")).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("line break") && !place.path("o\nut").exists(), "{message}");
}

#[test]
fn a_study_of_which_all_scenes_fail_is_not_submitted() {
    let place = Place::new(4);
    let stuck = SCENE.replace("stick_ratio = 0.7", "amplitude = 0");
    std::fs::write(place.path("base.toml"), stuck).unwrap();
    let message = place.refused(&[&SLURM[..], &["--dry-run"]].concat());
    assert!(
        message.contains("all scenes tried fail") && message.contains("leaves the whole contact stuck"),
        "{message}"
    );
    assert!(!Path::new(&place.path("out")).exists());
}
