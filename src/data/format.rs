//! The kinds of files of this program.

/// Value of the root attribute `format_version` of a run that this program writes and reads.
pub const FORMAT_VERSION: i32 = 4;

/// What a file is of; its root attribute `format` tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// One run.
    Run,
    /// A sweep, or a shard of one.
    Sweep,
    /// A comparison of gradings.
    Map,
    /// A study of universality.
    Universality,
    /// A trade-off between error and cost.
    Tradeoff,
    /// A calibration.
    Calibration,
}

impl Format {
    const ALL: [Self; 6] =
        [Self::Run, Self::Sweep, Self::Map, Self::Universality, Self::Tradeoff, Self::Calibration];

    /// Value of the attribute.
    ///
    /// ```
    /// use fretwear::data::Format;
    /// assert_eq!(Format::Run.name(), "fretwear-run");
    /// assert_eq!(Format::from_name("fretwear-map"), Some(Format::Map));
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::Run => "fretwear-run",
            Self::Sweep => "fretwear-sweep",
            Self::Map => "fretwear-map",
            Self::Universality => "fretwear-universality",
            Self::Tradeoff => "fretwear-tradeoff",
            Self::Calibration => "fretwear-calibration",
        }
    }

    /// Version of its layout, the root attribute `format_version`.
    pub fn version(self) -> i32 {
        match self {
            Self::Run => FORMAT_VERSION,
            _ => 1,
        }
    }

    /// The format of that name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }
}
