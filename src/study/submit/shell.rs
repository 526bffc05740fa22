//! Words as the shell and Slurm read them.

use super::refuse;
use crate::error::Result;

/// A word that the shell takes as it is, whatever is in it.
pub(super) fn quote(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,%@".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.into(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// Letters, digits, dots and dashes for the name of a job; everything else becomes a dash.
pub(super) fn job_name(stem: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '-' };
    stem.chars().map(letter).take(60).collect()
}

/// Refuses a name, such as that of a partition, that is not one plain word.
pub(super) fn check_word(option: &'static str, word: &str) -> Result<()> {
    let plain = |c: char| c.is_alphanumeric() || "._-+,@:".contains(c);
    match !word.is_empty() && word.chars().all(plain) && !word.starts_with('-') {
        true => Ok(()),
        false => Err(refuse(option, format!("{word:?} is not one plain word"))),
    }
}

/// Refuses what is no option of the engine, or would spill over its line of the script.
pub(super) fn check_option(option: &str) -> Result<()> {
    let why = match option {
        it if !it.starts_with('-') => "does not begin with a dash; for example --engine-option=--qos=long",
        it if it.chars().any(char::is_control) => "has a line break or another control character in it",
        _ => return Ok(()),
    };
    Err(refuse("engine-option", format!("{option:?} {why}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What bash makes of a quoted word.
    fn read_by_bash(word: &str) -> String {
        let script = format!("printf %s {}", quote(word));
        let output = std::process::Command::new("bash").args(["-c", &script]).output().expect("bash");
        String::from_utf8(output.stdout).expect("text")
    }

    #[test]
    fn quoted_words_mean_themselves() {
        for word in [
            "",
            "plain/path.toml",
            "a b",
            "it's",
            "$(date) `id` \"$HOME\" \\ ! * ?",
            "'",
            "ö µ",
            "~",
            "-x",
            "@SHARDS@",
        ] {
            assert_eq!(read_by_bash(word), word, "quoted as {}", quote(word));
        }
    }

    #[test]
    fn names_of_jobs_are_plain() {
        assert_eq!(job_name("k0.5 it's $(x)"), "k0.5-it-s---x-");
    }

    #[test]
    fn words_and_options_that_would_break_the_script_are_refused() {
        assert!(check_word("partition", "gpu,long").is_ok());
        for word in ["", "a b", "x\n#SBATCH --uid=0", "'", "-p"] {
            assert!(check_word("partition", word).is_err(), "{word:?}");
        }
        assert!(check_option("--qos=long").is_ok());
        for option in ["qos", "--a\n#SBATCH -p x", ""] {
            assert!(check_option(option).is_err(), "{option:?}");
        }
    }
}
