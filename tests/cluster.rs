//! Sweeps on real engines, as `fretwear submit` hands them in: whatever happens to the jobs, the merged rows are those of one process that
//! nothing has interrupted. Ignored unless asked for: `.ci/slurm/run` and `.ci/hyperqueue/run` start the engines that these tests need.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use fretwear::data::{SweepFile, Values, Variable};
use serde_json::Value;
use tempfile::TempDir;

const BASE: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0.2
modulus = "210 GPa"
reference_depth = "1 m"
poisson_ratio = "similar"
[friction.coulomb]
coefficient = 0.6
[wear.archard]
coefficient = "1e-14 1/Pa"
[loading]
initial_force = "50 N"
stick_ratio = 0.7
tau = 3
[numerics]
springs = 160
tolerance = 1e-6
[output]
snapshots = 3
"#;

/// Processor time of a study that is interrupted by hand, s.
const SHORT: f64 = 24.0;

/// Longest that anything here may take.
const PATIENCE: Duration = Duration::from_secs(420);

/// A study of scenes that differ in their stick ratio, in a folder whose name is hard on scripts.
struct Place {
    folder: TempDir,
    scenes: u64,
    started: Instant,
}

impl Place {
    /// Scenes of so many seconds of one core altogether.
    fn new(core_seconds: f64) -> Self {
        let scenes = (core_seconds / seconds_per_scene()).ceil() as u64;
        Self::with_scenes(scenes.max(16))
    }

    fn with_scenes(scenes: u64) -> Self {
        let folder = tempfile::Builder::new().prefix("it's a $(sweep) ").tempdir().expect("a folder");
        let study = format!(
            "scene = \"base.toml\"\n[[axes]]\nkey = \"loading.stick_ratio\"\nfrom = 0.6\nto = 0.8\ncount = {scenes}\n\
             [output]\nsnapshots = [3, 7]\n"
        );
        std::fs::write(folder.path().join("base.toml"), BASE).expect("written");
        std::fs::write(folder.path().join("study.toml"), study).expect("written");
        Self { folder, scenes, started: Instant::now() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `fretwear submit`, whose answer is one object.
    fn submit(&self, engine: &str, arguments: &[&str]) -> Value {
        let mut command = fretwear("submit");
        command.arg(self.path("study.toml")).arg("-o").arg(self.path("out"));
        command.args(["--engine", engine, "--json"]).args(arguments);
        serde_json::from_str(&stdout(&mut command)).expect("one object")
    }

    /// One uninterrupted process; done once for studies that are the same.
    fn alone(&self) -> Arc<OnceLock<SweepFile>> {
        static DONE: Mutex<BTreeMap<u64, Arc<OnceLock<SweepFile>>>> = Mutex::new(BTreeMap::new());
        let cell = {
            let mut done = DONE.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(done.entry(self.scenes).or_default())
        };
        cell.get_or_init(|| self.compute_alone());
        cell
    }

    fn compute_alone(&self) -> SweepFile {
        let folder = self.path("alone");
        // Behind the jobs, which are waited for.
        let mut sweep = Command::new("nice");
        sweep.arg(env!("CARGO_BIN_EXE_fretwear")).arg("sweep").arg(self.path("study.toml"));
        sweep.arg("-o").arg(&folder).args(["--threads", "2", "--quiet"]);
        stdout(&mut sweep);
        let merged = self.path("alone.h5");
        stdout(fretwear("merge").arg(&folder).arg("-o").arg(&merged));
        SweepFile::read(&merged).expect("a sweep")
    }

    /// Waits for the merged file, and compares it with that of one process.
    fn judge(&self, what: &str) {
        let merged = self.path("out/merged.h5");
        self.wait(what, || merged.exists());
        let seconds = self.started.elapsed().as_secs_f64();
        let found = SweepFile::read(&merged).expect("a sweep");
        let expected = self.alone();
        let expected = expected.get().expect("computed");
        assert_eq!(found.scenes, (0..self.scenes).collect::<Vec<_>>(), "each scene once");
        assert_eq!(found.header, expected.header);
        let (found_bits, expected_bits) = (bits(&found), bits(expected));
        for (found, expected) in found_bits.iter().zip(&expected_bits) {
            assert!(found == expected, "{what}: {} differs\n{}", found.0, self.logs());
        }
        assert_eq!(found_bits.len(), expected_bits.len());
        assert_eq!(found.runs.len(), 2);
        for ((scene, found), (_, expected)) in found.runs.iter().zip(&expected.runs) {
            assert_eq!((&found.header, &found.snapshots), (&expected.header, &expected.snapshots), "{scene}");
        }
        println!(
            "{}{what}: merged {seconds:.0} s after the start, {} scenes equal",
            self.logs(),
            self.scenes
        );
    }

    /// All logs, one after the other.
    fn logs(&self) -> String {
        let mut files: Vec<_> = std::fs::read_dir(self.path("out/log"))
            .expect("logs")
            .map(|it| it.expect("readable").path())
            .collect();
        files.sort();
        let text = |path: &PathBuf| {
            format!("{}:\n{}", path.display(), std::fs::read_to_string(path).unwrap_or_default())
        };
        files.iter().map(text).collect()
    }

    fn parts(&self) -> usize {
        std::fs::read_dir(self.path("out/parts")).map_or(0, |entries| {
            entries.flatten().filter(|it| it.file_name().to_string_lossy().ends_with(".h5")).count()
        })
    }

    fn wait(&self, what: &str, is_so: impl Fn() -> bool) {
        while !is_so() {
            assert!(self.started.elapsed() < PATIENCE, "{what}: waited too long\n{}", self.logs());
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

fn fretwear(command: &str) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_fretwear"));
    program.arg(command);
    program
}

/// What a command that must succeed prints.
fn stdout(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().expect("it starts");
    assert!(status.success(), "{command:?}: {status}\n{}", String::from_utf8_lossy(&stderr));
    String::from_utf8(stdout).expect("text")
}

/// Processor time of a scene, s: wall time would depend on what else is running.
fn seconds_per_scene() -> f64 {
    static SECONDS: OnceLock<f64> = OnceLock::new();
    *SECONDS.get_or_init(|| {
        // Enough of them that what they share does not count.
        let place = Place::with_scenes(40);
        let before = children_seconds();
        let mut sweep = fretwear("sweep");
        sweep.arg(place.path("study.toml")).arg("-o").arg(place.path("out")).args([
            "--threads",
            "1",
            "--quiet",
        ]);
        stdout(&mut sweep);
        let seconds = (children_seconds() - before) / place.scenes as f64;
        println!("a scene: {seconds:.3} s");
        seconds
    })
}

/// Processor time of the children that have ended, s.
fn children_seconds() -> f64 {
    // SAFETY: the structure is plain numbers, which the call fills in.
    let usage = unsafe {
        let mut usage: libc::rusage = std::mem::zeroed();
        libc::getrusage(libc::RUSAGE_CHILDREN, &mut usage);
        usage
    };
    usage.ru_utime.tv_sec as f64 + 1e-6 * usage.ru_utime.tv_usec as f64
}

/// Bits of all that must not depend on how the scenes were run.
fn bits(file: &SweepFile) -> Vec<(String, Vec<u64>, Vec<String>)> {
    let column = |Variable { name, values, .. }: &Variable| match values {
        Values::Numbers(numbers) => (name.clone(), numbers.iter().map(|it| it.to_bits()).collect(), vec![]),
        Values::Texts(texts) => (name.clone(), vec![], texts.iter().map(str::to_owned).collect()),
        _ => panic!("{name} holds neither numbers nor words"),
    };
    file.columns.iter().filter(|column| column.name != "wall_seconds").map(column).collect()
}

fn slurm(program: &str, arguments: &[&str]) -> String {
    stdout(Command::new(program).args(arguments))
}

/// Number of the array that was handed in.
fn array(answer: &Value) -> String {
    assert_eq!(answer["submitted"], true, "{answer}");
    answer["jobs"][0].as_str().expect("a number").into()
}

/// Number of elements of an array that run on a node.
fn running(array: &str, node: &str) -> usize {
    let arguments = ["--noheader", "--array", "--jobs", array, "--states=running", "--format=%N"];
    slurm("squeue", &arguments).lines().filter(|it| it.trim() == node).count()
}

/// How often each element of an array of so many was started anew.
fn restarts(array: &str, shards: u64) -> Vec<u64> {
    let one = |shard| {
        let text = slurm("scontrol", &["show", "job", &format!("{array}_{shard}")]);
        let (_, rest) = text.split_once("Restarts=").expect("Slurm counts restarts");
        rest.split_whitespace().next().and_then(|it| it.parse().ok()).expect("a number")
    };
    (0..shards).map(one).collect()
}

/// The script that starts and kills the nodes, and its folder.
fn cluster(arguments: &[&str]) {
    let folder = std::env::var("FRETWEAR_CLUSTER").expect(".ci/slurm/run sets it");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/slurm/cluster");
    stdout(Command::new(script).arg(arguments[0]).arg(folder).args(&arguments[1..]));
}

#[test]
#[ignore = "needs Slurm: .ci/slurm/run"]
fn slurm_runs_an_array_and_then_the_merge() {
    let place = Place::new(SHORT);
    let answer =
        place.submit("slurm", &["--shards", "4", "--cpus-per-task", "1", "--engine-option=--nodelist=n1"]);
    let array = array(&answer);
    place.judge("array, then merge");
    assert_eq!(restarts(&array, 4), [0; 4]);
}

#[test]
#[ignore = "needs Slurm: .ci/slurm/run"]
fn slurm_goes_on_after_a_time_limit() {
    // The warning comes 61 s before the end of 2 minutes, or up to half a minute earlier: within 59 s of the start.
    let place = Place::new(80.0);
    let told = ["--seconds-per-scene", "0.1", "--time-limit", "2", "--engine-option=--nodelist=n1"];
    let answer = place.submit("slurm", &[&["--shards", "1", "--cpus-per-task", "1"], &told[..]].concat());
    assert_eq!(answer["signal_lead_seconds"], 61, "{answer}");
    let array = array(&answer);
    std::thread::scope(|scope| {
        scope.spawn(|| place.alone());
        place.judge("time limit");
    });
    let logs = place.logs();
    assert!(logs.contains("SIGUSR1 passed on") && logs.contains("exit code 75"), "no warning came:\n{logs}");
    assert!(restarts(&array, 1)[0] >= 1, "{logs}");
}

#[test]
#[ignore = "needs Slurm: .ci/slurm/run"]
fn slurm_survives_the_loss_of_a_node() {
    let place = Place::new(SHORT);
    let answer =
        place.submit("slurm", &["--shards", "4", "--cpus-per-task", "1", "--checkpoint-interval", "2"]);
    let array = array(&answer);
    place.wait("a part of a shard on n2", || running(&array, "n2") > 0 && place.parts() >= 4);
    let lost = running(&array, "n2");
    cluster(&["kill", "n2"]);
    assert!(lost > 0, "nothing ran on the node");
    place.judge("node killed");
    let again = restarts(&array, 4).into_iter().filter(|it| *it >= 1).count();
    assert!(
        again >= lost.min(1),
        "{lost} shards ran on the node, {again} were started anew\n{}",
        place.logs()
    );
}

#[test]
#[ignore = "needs Slurm: .ci/slurm/run"]
fn slurm_goes_on_after_a_preemption() {
    // 16 of the 32 cores of the node, and then somebody more important who wants 20.
    let place = Place::new(SHORT);
    let where_to = ["--partition", "spare", "--engine-option=--nodelist=n1"];
    let answer = place.submit("slurm", &[&["--shards", "4", "--cpus-per-task", "4"], &where_to[..]].concat());
    let array = array(&answer);
    place.wait("running", || running(&array, "n1") == 4);
    let urgent =
        ["--partition=urgent", "--nodelist=n1", "--ntasks=1", "--cpus-per-task=20", "--output=/dev/null"];
    slurm("sbatch", &[&urgent[..], &["--wrap", "sleep 5"]].concat());
    place.judge("preemption");
    let logs = place.logs();
    assert!(logs.contains("DUE TO PREEMPTION") && restarts(&array, 4).iter().any(|it| *it >= 1), "{logs}");
}

#[test]
#[ignore = "needs Slurm: .ci/slurm/run"]
fn slurm_leaves_cancelled_what_was_cancelled_and_the_merge_names_it() {
    let place = Place::new(SHORT);
    let answer =
        place.submit("slurm", &["--shards", "3", "--cpus-per-task", "1", "--engine-option=--nodelist=n1"]);
    let array = array(&answer);
    place.wait("running", || running(&array, "n1") == 3);
    // Time for the handlers of signals.
    std::thread::sleep(Duration::from_secs(2));
    slurm("scancel", &[&format!("{array}_1")]);
    place.wait("the merge", || place.logs().contains("--array=1\n"));
    assert!(!place.path("out/merged.h5").exists(), "nothing is merged while scenes are missing");
    assert!(place.logs().contains("left to it"), "{}", place.logs());
    let again = stdout(Command::new("bash").arg(place.path("out/submit.sh")).arg("--array=1"));
    assert_eq!(again.split_whitespace().count(), 2, "{again}");
    place.judge("cancelled, handed in again");
}

/// Runs the script of a shard in HyperQueue's own cluster, through its interface for Python; whether all tasks succeeded.
fn hyperqueue(place: &Place, shards: u64, stop_after: f64) -> bool {
    let python = std::env::var("FRETWEAR_HQ_PYTHON").expect(".ci/hyperqueue/run sets it");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".ci/hyperqueue/tasks.py");
    let mut command = Command::new(python);
    command.arg(script).arg(place.path("out")).args([shards.to_string(), stop_after.to_string()]);
    let output = command.output().expect("Python starts");
    println!("{}", String::from_utf8_lossy(&output.stdout));
    match output.status.code() {
        Some(0) => true,
        Some(3) => false,
        _ => panic!("{}: {}", output.status, String::from_utf8_lossy(&output.stderr)),
    }
}

#[test]
#[ignore = "needs HyperQueue: .ci/hyperqueue/run"]
fn hyperqueue_runs_the_tasks_and_goes_on_after_its_end() {
    let place = Place::new(24.0);
    let options = ["--dry-run", "--shards", "3", "--cpus-per-task", "1", "--checkpoint-interval", "1"];
    place.submit("hyperqueue", &options);
    std::fs::create_dir_all(place.path("out/log")).expect("a folder");
    // Server and workers end in the middle of the tasks.
    assert!(!hyperqueue(&place, 3, 4.0), "the tasks were done before the end came");
    assert!(place.parts() > 0, "checkpoints are on the disk:\n{}", place.logs());
    assert!(hyperqueue(&place, 3, 0.0), "{}", place.logs());
    merge_as_hyperqueue(&place);
    place.judge("HyperQueue");
}

/// Runs the script of the merge with a stand-in for `hq`, which the package lacks.
fn merge_as_hyperqueue(place: &Place) {
    use std::os::unix::fs::PermissionsExt;
    let stand_in = place.path("hq");
    std::fs::write(&stand_in, "#!/bin/sh\nexit 1\n").expect("written");
    std::fs::set_permissions(&stand_in, std::fs::Permissions::from_mode(0o755)).expect("set");
    let path = format!("{}:{}", place.folder.path().display(), std::env::var("PATH").expect("a path"));
    stdout(Command::new("bash").arg(place.path("out/merge-hq.sh")).arg("1").env("PATH", path));
}
