//! How a study is cut into shards.

use super::measure::Measurement;
use super::refuse;
use crate::error::Result;

/// Longest that a shard is to take, s: short enough for the gaps of a scheduler, long enough for its overhead not to count. Cutting a
/// study into as few such shards as possible leaves each, but for the only one, at least half of it.
const LONGEST_SHARD: f64 = 1800.0;

/// Seconds by which Slurm may send its warning early, and a checkpoint needs besides.
const LEAD: f64 = 60.0;

/// Least time between a start and the warning, s, of which Slurm may take half a minute off.
const LEAST_WORK: f64 = 45.0;

/// Longest warning that Slurm accepts, s.
const LONGEST_LEAD: f64 = 65535.0;

/// Time limits proposed, minutes: multiples of the first, between the other two. A limit that cuts a shard costs no more than a new
/// start; one that is too long keeps a shard from the gaps of a scheduler.
const TIME_LIMITS: [u64; 3] = [10, 30, 1440];

/// What the user wants of the shards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wishes {
    /// Their number, instead of the one proposed.
    pub shards: Option<u64>,
    /// Cores of each.
    pub cpus_per_task: usize,
    /// Time limit of each, minutes, instead of the one proposed.
    pub time_limit: Option<u64>,
}

/// How a study is cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proposal {
    /// Number of shards.
    pub shards: u64,
    /// Cores of each.
    pub cpus_per_task: usize,
    /// Expected wall time of one, s.
    pub seconds_per_shard: f64,
    /// Time limit of each, minutes.
    pub time_limit: u64,
    /// How long before the limit the warning comes, s.
    pub signal_lead: u64,
    /// Most elements that the engine allows in an array.
    pub largest_array: u64,
}

impl Proposal {
    /// Cuts a study into shards of 15 to 30 minutes, or into one if it is shorter; into longer ones where the array would become too large.
    ///
    /// # Errors
    /// [`Error::Inconsistent`](crate::Error::Inconsistent) names the wish that cannot be met, and the cure.
    pub fn new(scenes: u64, cost: &Measurement, wishes: &Wishes, largest_array: u64) -> Result<Self> {
        let Wishes { shards, cpus_per_task, time_limit } = *wishes;
        if cpus_per_task == 0 {
            return Err(refuse("cpus-per-task", "0 cores compute nothing; give at least 1".into()));
        }
        let core_seconds = scenes as f64 * cost.mean_seconds;
        let most = scenes.min(largest_array).max(1);
        let shards = match shards {
            Some(shards) if shards == 0 || shards > most => {
                let why = format!(
                    "{shards} shards of {scenes} scenes, in an array of at most {largest_array}; give 1 to {most}"
                );
                return Err(refuse("shards", why));
            }
            Some(shards) => shards,
            None => ((core_seconds / cpus_per_task as f64 / LONGEST_SHARD).ceil() as u64).clamp(1, most),
        };
        // The last scenes of a shard leave cores idle; no shard is shorter than its longest scene.
        let seconds_per_shard =
            (core_seconds / shards as f64 / cpus_per_task as f64).max(cost.longest_seconds);
        let signal_lead = (LEAD + cost.longest_seconds.ceil()).min(LONGEST_LEAD);
        let shortest = ((signal_lead + LEAST_WORK) / 60.0).ceil() as u64;
        let time_limit = match time_limit {
            Some(minutes) if minutes < shortest => {
                let why = format!(
                    "{minutes} min with a warning {signal_lead} s before the end leaves no time for work; give at least {shortest}"
                );
                return Err(refuse("time-limit", why));
            }
            Some(minutes) => minutes,
            None => proposed_limit(seconds_per_shard, signal_lead).max(shortest),
        };
        Ok(Self {
            shards,
            cpus_per_task,
            seconds_per_shard,
            time_limit,
            signal_lead: signal_lead as u64,
            largest_array,
        })
    }
}

/// Minutes that leave room for nodes half as fast as this machine.
fn proposed_limit(seconds_per_shard: f64, signal_lead: f64) -> u64 {
    let [step, least, most] = TIME_LIMITS;
    let minutes = ((2.0 * seconds_per_shard + signal_lead) / 60.0).ceil() as u64;
    minutes.div_ceil(step).saturating_mul(step).clamp(least, most)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WISHES: Wishes = Wishes { shards: None, cpus_per_task: 4, time_limit: None };

    fn propose(scenes: u64, seconds: f64) -> Proposal {
        Proposal::new(scenes, &Measurement::told(seconds), &WISHES, 1001).expect("a proposal")
    }

    #[test]
    fn a_short_study_is_one_shard() {
        let proposal = propose(100, 1.0);
        assert_eq!((proposal.shards, proposal.seconds_per_shard), (1, 25.0));
        assert_eq!((proposal.time_limit, proposal.signal_lead), (30, 61));
    }

    #[test]
    fn shards_take_ten_to_sixty_minutes() {
        for scenes in [10_000, 14_401, 100_000, 1_000_000] {
            let proposal = propose(scenes, 1.0);
            let minutes = proposal.seconds_per_shard / 60.0;
            assert!((10.0..=60.0).contains(&minutes), "{scenes} scenes: {proposal:?}");
            assert!(proposal.time_limit as f64 >= 2.0 * minutes, "{scenes} scenes: {proposal:?}");
        }
    }

    #[test]
    fn shards_are_never_more_than_the_array_or_the_scenes_allow() {
        let long = propose(10_000_000, 600.0);
        assert_eq!((long.shards, long.time_limit), (1001, 1440));
        assert_eq!(propose(3, 1e5).shards, 3);
    }

    #[test]
    fn the_warning_leaves_time_for_a_scene_and_the_limit_for_the_warning() {
        let proposal = propose(1000, 599.5);
        assert_eq!(proposal.signal_lead, 660);
        assert!(proposal.time_limit * 60 >= proposal.signal_lead + 45, "{proposal:?}");
        assert_eq!(propose(10, 1e6).signal_lead, 65535);
    }

    #[test]
    fn wishes_that_cannot_be_are_refused_with_the_cure() {
        let refuse = |wishes: Wishes| {
            Proposal::new(12, &Measurement::told(0.1), &wishes, 1001).expect_err("refused").to_string()
        };
        assert!(refuse(Wishes { shards: Some(13), ..WISHES }).contains("give 1 to 12"));
        assert!(refuse(Wishes { shards: Some(0), ..WISHES }).contains("give 1 to 12"));
        assert!(refuse(Wishes { cpus_per_task: 0, ..WISHES }).contains("cpus-per-task"));
        assert!(refuse(Wishes { time_limit: Some(1), ..WISHES }).contains("give at least 2"));
        let kept = Wishes { shards: Some(5), cpus_per_task: 1, time_limit: Some(3) };
        let proposal = Proposal::new(12, &Measurement::told(0.1), &kept, 1001).expect("a proposal");
        assert_eq!((proposal.shards, proposal.time_limit), (5, 3));
    }
}
