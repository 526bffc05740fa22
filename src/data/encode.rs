//! A run as the bytes of its file.

use hdf5::{Group, Result};

use super::Format;
use super::labelled::{
    Dimension, create_group, put_array, put_integer, put_integers, put_missing, put_real, put_text,
};
use super::layout::*;
use super::save::Save;
use crate::contact::stick_slip::Regime;
use crate::solver::model::Past;

impl Save<'_> {
    /// Writes the run into a group, for the root of a file of its own or one of many in a file. The same run gives the same bytes: no times
    /// of creation are stored.
    pub(super) fn put_into(&self, group: &Group) -> Result<()> {
        self.put_attributes(group)?;
        let time = Dimension::create(group, TIME, self.snapshots.len(), true)?;
        let node = Dimension::create(group, NODE, self.header.radius.len(), false)?;
        self.put_series(group, &time)?;
        self.put_node_curves(group, &node)?;
        self.put_curves(group, &time, &node)?;
        self.put_table(group)?;
        self.put_path(group)?;
        self.put_loops(group, &time)?;
        self.put_checkpoint(group)
    }

    fn put_attributes(&self, file: &Group) -> Result<()> {
        put_text(file, "title", self.header.title.as_deref().unwrap_or_default())?;
        put_text(file, "format", Format::Run.name())?;
        put_integer(file, "format_version", FORMAT_VERSION)?;
        put_text(file, "program_version", env!("CARGO_PKG_VERSION"))?;
        put_text(file, "scene", &self.header.scene)?;
        put_text(file, SCENE_HASH, &self.header.scene_hash(env!("CARGO_PKG_VERSION")))?;
        put_text(file, "stop_reason", self.stop_reason.name())?;
        put_integer(file, "complete", self.complete.into())
    }

    fn put_series(&self, file: &Group, time: &Dimension) -> Result<()> {
        for field in &SERIES {
            let values: Vec<f64> = self.snapshots.iter().map(field.of).copied().collect();
            let dataset = put_array(file, field.label, &[time], &values)?;
            if !["cycles", "tau"].contains(&field.label.name) {
                put_text(&dataset, "coordinates", "cycles tau")?;
            }
        }
        let values: Vec<i32> = self.snapshots.iter().map(|it| it.regime as i32).collect();
        let dataset = put_array(file, REGIME, &[time], &values)?;
        put_text(&dataset, "coordinates", "cycles tau")?;
        put_integers(&dataset, FLAG_VALUES, &Regime::ALL.map(|regime| regime as i32))?;
        put_text(&dataset, FLAG_MEANINGS, &Regime::ALL.map(Regime::name).join(" "))
    }

    fn put_node_curves(&self, file: &Group, node: &Dimension) -> Result<()> {
        put_array(file, RADIUS, &[node], &self.header.radius)?;
        if let Some(limit) = &self.header.limit {
            for (label, values) in [(LIMIT_PROFILE, &limit.profile), (LIMIT_WEAR_DEPTH, &limit.wear_depth)] {
                put_text(&*put_array(file, label, &[node], values)?, "coordinates", "radius")?;
            }
        }
        Ok(())
    }

    fn put_curves(&self, file: &Group, time: &Dimension, node: &Dimension) -> Result<()> {
        let mut values = Vec::with_capacity(self.snapshots.len() * self.header.radius.len());
        for field in &CURVES {
            values.clear();
            self.snapshots.iter().for_each(|snapshot| values.extend_from_slice((field.of)(snapshot)));
            let dataset = put_array(file, field.label, &[time, node], &values)?;
            put_text(&dataset, "coordinates", "cycles tau radius")?;
            if let Some((_, why)) = UNKNOWN.iter().find(|(name, _)| *name == field.label.name) {
                put_missing(&dataset, why)?;
            }
        }
        Ok(())
    }

    fn put_table(&self, file: &Group) -> Result<()> {
        let Some(table) = &self.header.table else { return Ok(()) };
        let row = Dimension::create(file, TABLE_ROW, table.heights().len(), false)?;
        put_array(file, TABLE_RADIUS, &[&row], table.radii())?;
        let profile = put_array(file, TABLE_PROFILE, &[&row], table.heights())?;
        put_text(&profile, "coordinates", TABLE_RADIUS.name)?;
        if let Some(smoothing) = table.smoothing() {
            put_real(&profile, SMOOTHING, smoothing.deviation)?;
        }
        put_text(&profile, SOURCE, table.source())
    }

    fn put_path(&self, file: &Group) -> Result<()> {
        let Some(path) = &self.header.path else { return Ok(()) };
        let row = Dimension::create(file, PATH_ROW, path.x.len(), false)?;
        put_text(&*put_array(file, PATH_X, &[&row], &path.x)?, SOURCE, &path.source)?;
        put_array(file, PATH_Y, &[&row], &path.y)?;
        put_array(file, PATH_INDENTATION, &[&row], &path.indentation).map(drop)
    }

    fn put_loops(&self, file: &Group, time: &Dimension) -> Result<()> {
        let group = create_group(file, LOOPS)?;
        let points = self.snapshots.first().map_or(0, |it| it.loop_displacement.len());
        let point = Dimension::create(&group, POINT, points, false)?;
        for field in &LOOP_CURVES {
            let values: Vec<f64> = self.snapshots.iter().flat_map(|it| (field.of)(it)).copied().collect();
            let along_y = field.label.name.ends_with("_y");
            if along_y && values.is_empty() {
                continue;
            }
            let dataset = put_array(&group, field.label, &[time, &point], &values)?;
            put_text(&dataset, "coordinates", "cycles tau")?;
        }
        Ok(())
    }

    fn put_checkpoint(&self, file: &Group) -> Result<()> {
        let group = create_group(file, CHECKPOINT)?;
        let state = &self.checkpoint.state;
        let spring = Dimension::create(&group, SPRING, state.compression.len(), false)?;
        put_array(&group, COMPRESSION, &[&spring], &state.compression)?;
        put_array(&group, COMPRESSION_RATE, &[&spring], &state.compression_rate)?;
        for field in &CHECKPOINT_REALS {
            put_array(&group, field.label, &[], &[*(field.of)(self.checkpoint)])?;
        }
        for field in &CHECKPOINT_COUNTS {
            put_array(&group, field.label, &[], &[*(field.of)(self.checkpoint)])?;
        }
        if let Some(estimate) = self.checkpoint.error_estimate {
            put_array(&group, ERROR_ESTIMATE, &[], &[estimate])?;
        }
        if let Some((accuracy, met)) = self.checkpoint.accuracy.zip(self.checkpoint.accuracy_met()) {
            put_array(&group, ACCURACY, &[], &[accuracy])?;
            put_array(&group, ACCURACY_MET, &[], &[u64::from(met)])?;
        }
        if !state.past.points.is_empty() {
            put_past(&group, &state.past)?;
        }
        let Some(stick) = &state.stick else { return Ok(()) };
        let group = create_group(&group, STICK)?;
        let station = Dimension::create(&group, STATION, stick.left_behind.len(), false)?;
        put_array(&group, LEFT_BEHIND, &[&station], &stick.left_behind)?;
        let node = Dimension::create(&group, WORN_NODE, stick.wear_depth.len(), false)?;
        put_array(&group, STICK_WEAR_DEPTH, &[&node], &stick.wear_depth)?;
        if !stick.places_at_rest.is_empty() {
            let place = Dimension::coordinate(&group, PLACE_AT_REST, &stick.places_at_rest)?;
            put_array(&group, RAISED_AT_REST, &[&place], &stick.raised_at_rest)?;
        }
        for field in &STICK_REALS {
            put_array(&group, field.label, &[], &[*(field.of)(stick)])?;
        }
        Ok(())
    }
}

fn put_past(checkpoint: &Group, past: &Past) -> Result<()> {
    let group = create_group(checkpoint, PAST)?;
    let points = &past.points;
    let (springs, with_edge) = points.first().map_or((0, 0), |it| (it.compression.len(), it.log_slip.len()));
    let earlier = Dimension::create(&group, EARLIER, points.len(), false)?;
    let spring = Dimension::create(&group, SPRING, springs, false)?;
    let spring_or_edge = Dimension::create(&group, SPRING_OR_EDGE, with_edge, false)?;
    put_array(&group, ORDER, &[], &[past.order as u64])?;
    for field in &PAST_REALS {
        let values: Vec<f64> = points.iter().map(|it| *(field.of)(it)).collect();
        put_array(&group, field.label, &[&earlier], &values)?;
    }
    let compressions: Vec<f64> = points.iter().flat_map(|it| &it.compression).copied().collect();
    put_array(&group, COMPRESSION, &[&earlier, &spring], &compressions)?;
    let log_slips: Vec<f64> = points.iter().flat_map(|it| &it.log_slip).copied().collect();
    put_array(&group, LOG_SLIP, &[&earlier, &spring_or_edge], &log_slips)?;
    let Some(linearised) = &past.linearised else { return Ok(()) };
    let group = create_group(&group, LINEARISED)?;
    let spring = Dimension::create(&group, SPRING, linearised.compression.len(), false)?;
    put_array(&group, COMPRESSION, &[&spring], &linearised.compression)?;
    for field in &LINEARISED_REALS {
        put_array(&group, field.label, &[], &[*(field.of)(linearised)])?;
    }
    Ok(())
}
