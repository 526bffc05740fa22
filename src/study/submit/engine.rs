//! The engines: whether they are here, how large their arrays may be, and how scripts are handed to them.

use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

use super::refuse;
use crate::error::Result;

/// Elements of an array under Slurm's default MaxArraySize.
const SLURM_ARRAY: u64 = 1001;

/// Elements of an array in HyperQueue, which has no limit: more would be as many log files.
const HYPERQUEUE_ARRAY: u64 = 10_000;

/// What runs the jobs of a cluster.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    /// Slurm, through sbatch.
    Slurm,
    /// HyperQueue, through hq.
    HyperQueue,
}

/// What the engine answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Submitted {
    /// It took the jobs: numbers of the array and, where there is one, of the merge.
    Jobs(Vec<String>),
    /// It did not; its words.
    Refused(String),
}

impl Engine {
    /// All engines.
    pub const ALL: [Self; 2] = [Self::Slurm, Self::HyperQueue];

    /// The word of the command line: `slurm` or `hyperqueue`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slurm => "slurm",
            Self::HyperQueue => "hyperqueue",
        }
    }

    /// Wall time between checkpoints, s: Slurm warns, and only a lost node costs more; HyperQueue kills one second after its warning.
    pub(super) fn checkpoint_interval(self) -> f64 {
        match self {
            Self::Slurm => 30.0,
            Self::HyperQueue => 10.0,
        }
    }

    /// The program that takes jobs.
    fn program(self) -> &'static str {
        match self {
            Self::Slurm => "sbatch",
            Self::HyperQueue => "hq",
        }
    }

    /// Fails where the engine's program is missing.
    pub(super) fn check_presence(self) -> Result<()> {
        let program = self.program();
        match Command::new(program).arg("--version").output() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(refuse("engine", format!("there is no {program} here, so nothing can be handed in")))
            }
            _ => Ok(()),
        }
    }

    /// Most elements of an array, asked of the cluster where there is one.
    pub(super) fn largest_array(self) -> u64 {
        match self {
            Self::Slurm => {
                let output = Command::new("scontrol").args(["show", "config"]).output().ok();
                let text = output.map(|it| String::from_utf8_lossy(&it.stdout).into_owned());
                text.as_deref().and_then(max_array_size).unwrap_or(SLURM_ARRAY)
            }
            Self::HyperQueue => HYPERQUEUE_ARRAY,
        }
    }

    /// Runs the script that hands everything in.
    pub(super) fn hand_in(self, folder: &Path) -> Submitted {
        match Command::new("bash").arg(folder.join("submit.sh")).output() {
            Ok(output) if output.status.success() => {
                let text = String::from_utf8_lossy(&output.stdout);
                Submitted::Jobs(text.split_whitespace().map(str::to_owned).collect())
            }
            Ok(output) => Submitted::Refused(String::from_utf8_lossy(&output.stderr).trim().into()),
            Err(error) => Submitted::Refused(format!("bash: {error}")),
        }
    }
}

/// MaxArraySize in what `scontrol show config` prints; indices go to one less, so that it is the most elements. 0 forbids arrays, and then
/// one element is what can be tried.
fn max_array_size(config: &str) -> Option<u64> {
    let line = config.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize"))?;
    line.trim().strip_prefix('=')?.trim().parse().ok().map(|size: u64| size.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_size_of_arrays_is_read_from_the_configuration() {
        let config = "Configuration data as of today\nMailProg                = /usr/bin/mail\nMaxArraySize            = 4001\nMaxDBDMsgs = 1\n";
        assert_eq!(max_array_size(config), Some(4001));
        assert_eq!(max_array_size("MaxArraySize = 0"), Some(1));
        assert_eq!(max_array_size("slurm_load_ctl_conf error: Unable to contact slurm controller"), None);
    }
}
