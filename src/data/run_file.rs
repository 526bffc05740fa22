//! A run as a dataset, and back.

use std::sync::Arc;

use hdf5::Group;

use super::dataset::{Attribute, Dataset, Number, Quantity, Variable, WRITE_AGAIN, text};
use super::layout::*;
use super::reader::{OpenFile, Wanted};
use super::save::Save;
use super::seal::ResultPath;
use super::{
    Attempt, Checkpoint, Fineness, Format, LimitCurves, RunHeader, Snapshot, StopReason, fretting_regimes,
};
use crate::contact::indenter::TabulatedProfile;
use crate::contact::stick_slip::{FrettingRegime, Regime};
use crate::error::Result;
use crate::laws::motion::RecordedPath;
use crate::solver::model::{Linearised, Past, PastPoint, StickEdge, WornGround};

const NOT_A_RUN: &str = "give a file that `fretwear run` wrote";

/// A run read back from its file.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFile {
    /// What does not change during the run.
    pub header: RunHeader,
    /// The snapshots, in the order of time.
    pub snapshots: Vec<Snapshot>,
    /// What a restart needs, where the file has it.
    pub checkpoint: Option<Checkpoint>,
    /// Why the run stopped.
    pub stop_reason: StopReason,
    /// Whether the run reached its end.
    pub complete: bool,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// What it was computed from, [`RunHeader::scene_hash`]; none in files of earlier programs.
    pub scene_hash: Option<String>,
}

impl RunFile {
    /// A run as it would be read from its file.
    pub fn finished(
        header: RunHeader,
        snapshots: Vec<Snapshot>,
        checkpoint: Checkpoint,
        stop_reason: StopReason,
    ) -> Self {
        let program_version: String = env!("CARGO_PKG_VERSION").into();
        let complete = stop_reason != StopReason::Interrupted;
        let scene_hash = Some(header.scene_hash(&program_version));
        let checkpoint = Some(checkpoint);
        Self { header, snapshots, checkpoint, stop_reason, complete, program_version, scene_hash }
    }

    /// Reads a file that [`RunWriter`](super::RunWriter) wrote.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) names the file, the dataset or attribute that cannot be used, and the cure.
    pub fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let open = OpenFile::new(file)?;
        Self::from_group(&open, &open.file)
    }

    /// What a file of it holds, its checkpoint blank where it has none.
    pub fn dataset(&self) -> Dataset {
        let Self { header, snapshots, stop_reason, complete, .. } = self;
        let checkpoint = &self.checkpoint.clone().unwrap_or_default();
        Save { header, snapshots, checkpoint, stop_reason: *stop_reason, complete: *complete }.dataset()
    }

    /// Reads a run from a group of a file.
    pub(super) fn from_group(open: &OpenFile, group: &Group) -> Result<Self> {
        open.check_format(group, Format::Run, NOT_A_RUN)?;
        let title = Some(open.text(group, "title")?).filter(|title| !title.is_empty());
        let scene = open.text(group, "scene")?;
        let mut stored = open.dataset(group, Wanted::Values, &[])?;
        let header = header(&mut stored, title, scene)?;
        let snapshots = snapshots(&mut stored, header.radius.len())?;
        let checkpoint = stored.take_group(CHECKPOINT)?.map(checkpoint).transpose()?;
        let reason = open.text(group, "stop_reason")?;
        let stop_reason = StopReason::from_name(&reason)
            .ok_or_else(|| open.error(format!("stop_reason = {reason:?} is not known; {WRITE_AGAIN}")))?;
        let complete = open.integer::<i32>(group, "complete")? != 0;
        let program_version = open.text(group, "program_version")?;
        let scene_hash = group.attr(SCENE_HASH).is_ok().then(|| open.text(group, SCENE_HASH)).transpose()?;
        if scene_hash.as_ref().is_some_and(|it| *it != header.scene_hash(&program_version)) {
            let why = "is not the one that checkpoint and snapshots were computed from";
            return Err(open.damaged("its scene", &why));
        }
        Ok(Self { header, snapshots, checkpoint, stop_reason, complete, program_version, scene_hash })
    }
}

impl Save<'_> {
    /// The dataset of a file of its own, or of a group of one with many runs.
    pub(super) fn dataset(&self) -> Dataset {
        let mut run = Dataset::default();
        run.say("title", text(self.header.title.as_deref().unwrap_or_default()));
        run.say("format", text(Format::Run.name()));
        run.say("format_version", Attribute::Integer(FORMAT_VERSION));
        run.say("program_version", text(env!("CARGO_PKG_VERSION")));
        run.say("scene", text(&self.header.scene));
        run.say(SCENE_HASH, text(self.header.scene_hash(env!("CARGO_PKG_VERSION"))));
        run.say("stop_reason", text(self.stop_reason.name()));
        run.say("complete", Attribute::Integer(self.complete.into()));
        self.put_snapshots(&mut run);
        self.put_rows(&mut run);
        run.groups.push((LOOPS.into(), self.loops()));
        run.groups.push((CHECKPOINT.into(), put_checkpoint(self.checkpoint)));
        run
    }

    fn put_snapshots(&self, run: &mut Dataset) {
        let (time, node) = ((TIME.name, self.snapshots.len()), (NODE.name, self.header.radius.len()));
        let index = Variable::new(TIME, &[time], (0..).take(time.1).collect::<Vec<i64>>());
        run.add(Variable { unlimited: true, ..index });
        run.index(NODE, node.1);
        for field in &SERIES {
            let values: Vec<f64> = self.snapshots.iter().map(field.of).copied().collect();
            let variable = missing_told(Variable::new(field.quantity, &[time], values));
            let is_coordinate = ["cycles", "tau"].contains(&field.quantity.name);
            run.add(if is_coordinate { variable } else { variable.with_coordinates("cycles tau") });
        }
        let regimes = self.snapshots.iter().map(|it| it.regime as i32).collect();
        run.add(flags(REGIME, regimes, &Regime::ALL.map(Regime::name)));
        let regimes = fretting_regimes(self.snapshots).into_iter().map(|it| it as i32).collect();
        run.add(flags(FRETTING_REGIME, regimes, &FrettingRegime::ALL.map(FrettingRegime::name)));
        run.add(Variable::new(RADIUS, &[node], self.header.radius.clone()));
        if let Some(limit) = &self.header.limit {
            for (quantity, values) in [(LIMIT_PROFILE, &limit.profile), (LIMIT_WEAR_DEPTH, &limit.wear_depth)]
            {
                run.add(Variable::new(quantity, &[node], values.clone()).with_coordinates("radius"));
            }
        }
        for field in &CURVES {
            let values: Vec<f64> = self.snapshots.iter().flat_map(field.of).copied().collect();
            let curve =
                Variable::new(field.quantity, &[time, node], values).with_coordinates("cycles tau radius");
            run.add(missing_told(curve));
        }
    }

    /// The rows of a measured profile and of a recorded path.
    fn put_rows(&self, run: &mut Dataset) {
        if let Some(table) = &self.header.table {
            let row = (TABLE_ROW.name, table.heights().len());
            run.index(TABLE_ROW, row.1);
            run.add(Variable::new(TABLE_RADIUS, &[row], table.radii().to_vec()));
            let mut profile = Variable::new(TABLE_PROFILE, &[row], table.heights().to_vec())
                .with_coordinates(TABLE_RADIUS.name);
            if let Some(smoothing) = table.smoothing() {
                profile = profile.with(SMOOTHING, Attribute::Real(smoothing.deviation));
            }
            run.add(profile.with(SOURCE, text(table.source())));
        }
        if let Some(path) = &self.header.path {
            let row = (PATH_ROW.name, path.x.len());
            run.index(PATH_ROW, row.1);
            run.add(Variable::new(PATH_X, &[row], path.x.clone()).with(SOURCE, text(&path.source)));
            run.add(Variable::new(PATH_Y, &[row], path.y.clone()));
            run.add(Variable::new(PATH_INDENTATION, &[row], path.indentation.clone()));
        }
    }

    fn loops(&self) -> Dataset {
        let mut loops = Dataset::default();
        let points = self.snapshots.first().map_or(0, |it| it.loop_displacement.len());
        loops.index(POINT, points);
        for field in &LOOP_CURVES {
            let values: Vec<f64> = self.snapshots.iter().flat_map(field.of).copied().collect();
            let along_y = field.quantity.name.ends_with("_y");
            if along_y && values.is_empty() {
                continue;
            }
            let dimensions = [(TIME.name, self.snapshots.len()), (POINT.name, points)];
            loops.add(Variable::new(field.quantity, &dimensions, values).with_coordinates("cycles tau"));
        }
        loops
    }
}

/// Numbers along time that stand for words.
fn flags(quantity: Quantity, numbers: Vec<i32>, words: &[&str]) -> Variable {
    Variable::new(quantity, &[(TIME.name, numbers.len())], numbers)
        .with_coordinates("cycles tau")
        .with(FLAG_VALUES, Attribute::Integers((0..).take(words.len()).collect()))
        .with(FLAG_MEANINGS, text(words.join(" ")))
}

/// With what its numbers that are none mean: they are missing, as the CF conventions say it.
fn missing_told(variable: Variable) -> Variable {
    match UNKNOWN.iter().find(|(name, _)| *name == variable.name) {
        Some((_, why)) => variable.with("_FillValue", Attribute::Real(f64::NAN)).with("comment", text(*why)),
        None => variable,
    }
}

/// Adds numbers without dimensions.
fn put_scalars<R, T: Number + Copy>(dataset: &mut Dataset, fields: &[Field<R, T>], record: &R) {
    fields.iter().for_each(|field| dataset.scalar(field.quantity, *(field.of)(record)));
}

/// Takes them back.
fn take_scalars<R, T: Number + Copy>(
    dataset: &mut Dataset,
    fields: &[Field<R, T>],
    record: &mut R,
) -> Result<()> {
    fields.iter().try_for_each(|field| {
        *(field.of_mut)(record) = dataset.take_scalar(field.quantity)?;
        Ok(())
    })
}

fn put_checkpoint(checkpoint: &Checkpoint) -> Dataset {
    let mut stored = Dataset::default();
    let state = &checkpoint.state;
    let spring = (SPRING.name, state.compression.len());
    stored.index(SPRING, spring.1);
    stored.add(Variable::new(COMPRESSION, &[spring], state.compression.clone()));
    stored.add(Variable::new(COMPRESSION_RATE, &[spring], state.compression_rate.clone()));
    put_scalars(&mut stored, &CHECKPOINT_REALS, checkpoint);
    put_scalars(&mut stored, &CHECKPOINT_COUNTS, checkpoint);
    if let Some(estimate) = checkpoint.error_estimate {
        stored.scalar(ERROR_ESTIMATE, estimate);
    }
    if let Some((accuracy, met)) = checkpoint.accuracy.zip(checkpoint.accuracy_met()) {
        stored.scalar(ACCURACY, accuracy);
        stored.scalar(ACCURACY_MET, u64::from(met));
    }
    if checkpoint.attempt != Attempt::default() {
        stored.scalar(REFINEMENTS, checkpoint.attempt.refinements);
        stored.scalar(TOLERANCE, checkpoint.attempt.fineness.tolerance);
        stored.scalar(SUBSTEPS, checkpoint.attempt.fineness.substeps);
        stored.scalar(ENDED_ON, checkpoint.attempt.ended_on);
        stored.scalar(ENDED_WITH, checkpoint.attempt.ended_with.tolerance);
        stored.scalar(ENDED_IN, checkpoint.attempt.ended_with.substeps);
        stored.scalar(ENDED_WITHIN, checkpoint.attempt.ended_within);
        stored.scalar(ENDED_VOLUME, checkpoint.attempt.ended_volume);
        stored.scalar(WORK, checkpoint.attempt.work);
    }
    if !state.past.points.is_empty() {
        stored.groups.push((PAST.into(), put_past(&state.past)));
    }
    if let Some(stick) = &state.stick {
        stored.groups.push((STICK.into(), put_stick(stick)));
    }
    if let Some(ground) = &state.ground {
        stored.groups.push((GROUND.into(), put_ground(ground)));
    }
    stored
}

fn put_ground(ground: &WornGround) -> Dataset {
    let mut stored = Dataset::default();
    let (squared, worn): (Vec<f64>, Vec<f64>) = ground.places().unzip();
    let place = (WORN_PLACE.name, squared.len());
    stored.coordinate(WORN_PLACE, squared);
    stored.add(Variable::new(WORN_BEFORE, &[place], worn));
    stored.scalar(LIFT, ground.lift);
    stored
}

fn put_stick(stick: &StickEdge) -> Dataset {
    let mut stored = Dataset::default();
    let station = (STATION.name, stick.left_behind.len());
    stored.index(STATION, station.1);
    stored.add(Variable::new(LEFT_BEHIND, &[station], stick.left_behind.clone()));
    let node = (WORN_NODE.name, stick.wear_depth.len());
    stored.index(WORN_NODE, node.1);
    stored.add(Variable::new(STICK_WEAR_DEPTH, &[node], stick.wear_depth.clone()));
    if !stick.places_at_rest.is_empty() {
        stored.coordinate(PLACE_AT_REST, stick.places_at_rest.clone());
        let place = (PLACE_AT_REST.name, stick.places_at_rest.len());
        stored.add(Variable::new(RAISED_AT_REST, &[place], stick.raised_at_rest.clone()));
    }
    put_scalars(&mut stored, &STICK_REALS, stick);
    if stick.slip_compression != 0.0 {
        put_scalars(&mut stored, &BALANCED_STICK_REALS, stick);
    }
    stored
}

fn put_past(past: &Past) -> Dataset {
    let mut stored = Dataset::default();
    let points = &past.points;
    let (springs, with_edge) = points.first().map_or((0, 0), |it| (it.compression.len(), it.log_slip.len()));
    let earlier = (EARLIER.name, points.len());
    stored.index(EARLIER, points.len());
    stored.index(SPRING, springs);
    stored.scalar(ORDER, past.order as u64);
    for field in &PAST_REALS {
        let values: Vec<f64> = points.iter().map(|it| *(field.of)(it)).collect();
        stored.add(Variable::new(field.quantity, &[earlier], values));
    }
    let compressions: Vec<f64> = points.iter().flat_map(|it| &it.compression).copied().collect();
    stored.add(Variable::new(COMPRESSION, &[earlier, (SPRING.name, springs)], compressions));
    if with_edge > 0 {
        stored.index(SPRING_OR_EDGE, with_edge);
        let log_slips: Vec<f64> = points.iter().flat_map(|it| &it.log_slip).copied().collect();
        stored.add(Variable::new(LOG_SLIP, &[earlier, (SPRING_OR_EDGE.name, with_edge)], log_slips));
    }
    if let Some(linearised) = &past.linearised {
        let mut inner = Dataset::default();
        let spring = (SPRING.name, linearised.compression.len());
        inner.index(SPRING, spring.1);
        inner.add(Variable::new(COMPRESSION, &[spring], linearised.compression.clone()));
        put_scalars(&mut inner, &LINEARISED_REALS, linearised);
        stored.groups.push((LINEARISED.into(), inner));
    }
    stored
}

fn header(stored: &mut Dataset, title: Option<String>, scene: String) -> Result<RunHeader> {
    let radius: Vec<f64> = stored.take(RADIUS, &[None])?;
    if radius.is_empty() {
        return Err(stored.damaged(RADIUS.name, &"has no values"));
    }
    let nodes = [Some(radius.len())];
    let limit = match stored.has(LIMIT_PROFILE.name) {
        true => Some(LimitCurves {
            profile: stored.take(LIMIT_PROFILE, &nodes)?,
            wear_depth: stored.take(LIMIT_WEAR_DEPTH, &nodes)?,
        }),
        false => None,
    };
    let table = if stored.has(TABLE_PROFILE.name) { Some(table(stored)?) } else { None };
    let path = if stored.has(PATH_X.name) { Some(path(stored)?) } else { None };
    Ok(RunHeader { title, scene, radius, limit, table, path })
}

/// The file that the rows of a variable came from.
fn source(stored: &Dataset, name: &str) -> Result<String> {
    let source = stored.variable(name)?.text(SOURCE);
    source.map(str::to_owned).ok_or_else(|| stored.damaged(name, &"does not tell its source"))
}

fn table(stored: &mut Dataset) -> Result<Arc<TabulatedProfile>> {
    let source = source(stored, TABLE_PROFILE.name)?;
    let attributes = &stored.variable(TABLE_PROFILE.name)?.attributes;
    let deviation = match attributes.iter().find(|(name, _)| name == SMOOTHING) {
        Some((_, Attribute::Real(deviation))) => *deviation,
        _ => 0.0,
    };
    let radius: Vec<f64> = stored.take(TABLE_RADIUS, &[None])?;
    let height = stored.take(TABLE_PROFILE, &[Some(radius.len())])?;
    let table = TabulatedProfile::smoothed(source, radius, height, deviation);
    table.map(Arc::new).map_err(|error| stored.damaged(TABLE_PROFILE.name, &error))
}

fn path(stored: &mut Dataset) -> Result<Arc<RecordedPath>> {
    let source = source(stored, PATH_X.name)?;
    let x: Vec<f64> = stored.take(PATH_X, &[None])?;
    let rows = [Some(x.len())];
    let (y, indentation) = (stored.take(PATH_Y, &rows)?, stored.take(PATH_INDENTATION, &rows)?);
    let path = RecordedPath::new(source, x, y, indentation);
    path.map(Arc::new).map_err(|error| stored.damaged(PATH_X.name, &error))
}

fn snapshots(stored: &mut Dataset, nodes: usize) -> Result<Vec<Snapshot>> {
    let mut times = None;
    let mut snapshots = Vec::new();
    for field in &SERIES {
        let values: Vec<f64> = stored.take(field.quantity, &[times])?;
        times = Some(values.len());
        snapshots.resize_with(values.len(), Snapshot::default);
        for (snapshot, value) in snapshots.iter_mut().zip(values) {
            *(field.of_mut)(snapshot) = value;
        }
    }
    let regimes: Vec<i32> = stored.take(REGIME, &[times])?;
    for (snapshot, flag) in snapshots.iter_mut().zip(regimes) {
        let regime = usize::try_from(flag).ok().and_then(|place| Regime::ALL.get(place));
        let refuse = || stored.damaged(REGIME.name, &format!("{flag} is no regime"));
        snapshot.regime = *regime.ok_or_else(refuse)?;
    }
    for field in &CURVES {
        take_rows(stored, field, &mut snapshots, nodes)?;
    }
    let Some(mut loops) = stored.take_group(LOOPS)? else {
        return Err(stored.damaged(LOOPS, &"is missing"));
    };
    let points = loops.take::<i64>(POINT, &[None])?.len();
    let in_plane = LOOP_CURVES[2..].iter().any(|field| loops.has(field.quantity.name));
    let curves = &LOOP_CURVES[..if in_plane { 4 } else { 2 }];
    for field in curves.iter().filter(|_| points > 0) {
        take_rows(&mut loops, field, &mut snapshots, points)?;
    }
    Ok(snapshots)
}

/// Gives each record its row of a variable.
fn take_rows<R>(
    stored: &mut Dataset,
    field: &Field<R, Vec<f64>>,
    records: &mut [R],
    length: usize,
) -> Result<()> {
    let values: Vec<f64> = stored.take(field.quantity, &[Some(records.len()), Some(length)])?;
    for (record, row) in records.iter_mut().zip(values.chunks_exact(length)) {
        *(field.of_mut)(record) = row.to_vec();
    }
    Ok(())
}

fn checkpoint(mut stored: Dataset) -> Result<Checkpoint> {
    let mut checkpoint = Checkpoint::default();
    let state = &mut checkpoint.state;
    state.compression = stored.take(COMPRESSION, &[None])?;
    let springs = state.compression.len();
    state.compression_rate = stored.take(COMPRESSION_RATE, &[Some(springs)])?;
    state.stick = stored.take_group(STICK)?.map(stick).transpose()?;
    state.ground = stored.take_group(GROUND)?.map(ground).transpose()?.map(Arc::new);
    if let Some(past) = stored.take_group(PAST)? {
        state.past = self::past(past, springs)?;
    }
    take_scalars(&mut stored, &CHECKPOINT_REALS, &mut checkpoint)?;
    take_scalars(&mut stored, &CHECKPOINT_COUNTS, &mut checkpoint)?;
    if stored.has(ERROR_ESTIMATE.name) {
        checkpoint.error_estimate = Some(stored.take_scalar(ERROR_ESTIMATE)?);
    }
    if stored.has(ACCURACY.name) {
        checkpoint.accuracy = Some(stored.take_scalar(ACCURACY)?);
    }
    if stored.has(REFINEMENTS.name) {
        checkpoint.attempt = Attempt {
            refinements: stored.take_scalar(REFINEMENTS)?,
            fineness: Fineness {
                tolerance: stored.take_scalar(TOLERANCE)?,
                substeps: stored.take_scalar(SUBSTEPS)?,
            },
            ended_on: stored.take_scalar(ENDED_ON)?,
            ended_with: Fineness {
                tolerance: stored.take_scalar(ENDED_WITH)?,
                substeps: stored.take_scalar(ENDED_IN)?,
            },
            ended_within: stored.take_scalar(ENDED_WITHIN)?,
            ended_volume: match stored.has(ENDED_VOLUME.name) {
                true => stored.take_scalar(ENDED_VOLUME)?,
                false => f64::NAN,
            },
            work: stored.take_scalar(WORK)?,
        };
    }
    Ok(checkpoint)
}

fn ground(mut stored: Dataset) -> Result<WornGround> {
    let squared: Vec<f64> = stored.take(WORN_PLACE, &[None])?;
    let worn: Vec<f64> = stored.take(WORN_BEFORE, &[Some(squared.len())])?;
    Ok(WornGround::new(stored.take_scalar(LIFT)?, squared, &worn))
}

fn stick(mut stored: Dataset) -> Result<StickEdge> {
    let mut stick = StickEdge {
        left_behind: stored.take(LEFT_BEHIND, &[None])?,
        wear_depth: stored.take(STICK_WEAR_DEPTH, &[None])?,
        ..StickEdge::default()
    };
    if stored.has(PLACE_AT_REST.name) {
        stick.places_at_rest = stored.take(PLACE_AT_REST, &[None])?;
        stick.raised_at_rest = stored.take(RAISED_AT_REST, &[Some(stick.places_at_rest.len())])?;
    }
    take_scalars(&mut stored, &STICK_REALS, &mut stick)?;
    if stored.has(BALANCED_STICK_REALS[0].quantity.name) {
        take_scalars(&mut stored, &BALANCED_STICK_REALS, &mut stick)?;
    }
    Ok(stick)
}

fn past(mut stored: Dataset, springs: usize) -> Result<Past> {
    let count = stored.take::<i64>(EARLIER, &[None])?.len();
    let mut points = vec![PastPoint::default(); count];
    for field in &PAST_REALS {
        let values: Vec<f64> = stored.take(field.quantity, &[Some(count)])?;
        points.iter_mut().zip(values).for_each(|(point, value)| *(field.of_mut)(point) = value);
    }
    let compressions: Vec<f64> = stored.take(COMPRESSION, &[Some(count), Some(springs)])?;
    let rows = compressions.chunks(springs.max(1));
    points.iter_mut().zip(rows).for_each(|(point, row)| point.compression = row.to_vec());
    if stored.has(LOG_SLIP.name) {
        let log_slips: Vec<f64> = stored.take(LOG_SLIP, &[Some(count), Some(springs + 1)])?;
        let rows = log_slips.chunks(springs + 1);
        points.iter_mut().zip(rows).for_each(|(point, row)| point.log_slip = row.to_vec());
    }
    let order = usize::try_from(stored.take_scalar::<u64>(ORDER)?).unwrap_or(usize::MAX);
    let linearised = stored.take_group(LINEARISED)?.map(|mut inner| {
        let compression = inner.take(COMPRESSION, &[Some(springs)])?;
        let mut found = Linearised { compression, ..Linearised::default() };
        take_scalars(&mut inner, &LINEARISED_REALS, &mut found).map(|()| Arc::new(found))
    });
    let points = points.into_iter().map(Arc::new).collect();
    Ok(Past { order, points, linearised: linearised.transpose()? })
}
