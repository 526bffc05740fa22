//! The limiting shape on the nodes of a run.

use crate::contact::closed_form::LimitingShape;
use crate::data::{LimitCurves, RunHeader};
use crate::scene::Scene;
use crate::solver::model::Model;

/// What of a run does not change.
pub(super) fn header(scene: &Scene, model: &Model, limit: Option<&LimitingShape>) -> RunHeader {
    RunHeader {
        title: scene.title().map(str::to_owned),
        scene: scene.text().to_owned(),
        radius: model.radii(),
        limit: limit.map(|limit| limit_curves(model, limit)),
        table: scene.table(),
        path: scene.path(),
    }
}

fn limit_curves(model: &Model, limit: &LimitingShape) -> LimitCurves {
    let wear_depth: Vec<f64> =
        model.offsets().into_iter().map(|offset| limit.wear_depth_at_offset(offset)).collect();
    LimitCurves { profile: worn_profile(model, &wear_depth), wear_depth }
}

/// Profile, m, with a depth worn away at the radii of the output.
pub(super) fn worn_profile(model: &Model, wear_depth: &[f64]) -> Vec<f64> {
    model.unworn_heights().iter().zip(wear_depth).map(|(height, depth)| height + depth).collect()
}
