//! How HDF5 is linked.

use std::env;
use std::fs;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

/// Where Debian and Ubuntu have its headers.
const HEADERS: &str = "/usr/include/hdf5/serial";

/// What a program needs of it: both of its libraries.
const TRIAL: &str =
    "int H5open(void); int H5DSis_scale(long); int main(void) { return H5open() + H5DSis_scale(0); }";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is = |name: &str, value: &str| env::var(name).is_ok_and(|it| it == value);
    if !(is("CARGO_CFG_TARGET_OS", "linux") && is("CARGO_CFG_TARGET_ENV", "gnu")) {
        return;
    }
    let from_source = env::var_os("CARGO_FEATURE_STATIC_HDF5").is_some();
    let of_debian = || is("DEP_HDF5_INCLUDE", HEADERS) && env::var("HOST") == env::var("TARGET");
    if from_source || of_debian() && links_debians().is_some() {
        // At a fixed address 19,000 addresses need not be filled in at each start, which took a fifth of the time of `fretwear --version`.
        println!("cargo::rustc-link-arg-bins=-no-pie");
    }
}

/// Links in the archive that Debian and Ubuntu have beside the shared library, if a program with it can be built. The shared one brings 31 others along for
/// files in the cloud, which a start took three quarters of its time to load.
fn links_debians() -> Option<()> {
    let architecture = env::var("CARGO_CFG_TARGET_ARCH").ok()?;
    let archives = format!("/usr/lib/{architecture}-linux-gnu/hdf5/serial");
    let settings = format!("{archives}/libhdf5.settings");
    let text = fs::read_to_string(&settings).ok()?;
    // It comes and goes with the archives.
    println!("cargo::rerun-if-changed={settings}");
    let needs = text.lines().find_map(|line| line.trim().strip_prefix("Extra libraries:"))?;
    let folder = Path::new(&env::var_os("OUT_DIR")?).join("hdf5");
    // Linkers take such a text for the library of that name.
    let stand_in = |name: &str, needs: &str| {
        let text = format!("GROUP ( {archives}/{name}.a AS_NEEDED ( {needs} ) )\n");
        fs::write(folder.join(format!("{name}.so")), text)
    };
    fs::create_dir_all(&folder).ok()?;
    stand_in("libhdf5_hl", "-lhdf5").ok()?;
    stand_in("libhdf5", needs.trim()).ok()?;
    let links = builds(&folder).ok()?;
    links.then(|| println!("cargo::rustc-link-search=native={}", folder.display()))
}

/// Whether a program with the libraries of a folder can be built.
fn builds(folder: &Path) -> io::Result<bool> {
    let source = folder.join("trial.c");
    fs::write(&source, TRIAL)?;
    let (program, folder) = (folder.join("trial"), folder.as_os_str());
    let libraries = ["-lhdf5_hl", "-lhdf5"];
    let mut cc = Command::new("cc");
    cc.arg(&source).arg("-L").arg(folder).args(libraries).arg("-o").arg(program);
    Ok(cc.stdout(Stdio::null()).stderr(Stdio::null()).status()?.success())
}
