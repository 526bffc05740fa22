//! How a contact is put on springs.

use super::meter::Meter;
use super::output::OutputRadii;
use super::schedule::Envelope;
use super::{
    AnnulusMesh, Gross, HIDDEN, Model, MovingStick, OperatorStore, Resolution, Schedule, SpringMesh,
    StickZone,
};
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::slip_depth::{UnwornSlip, UnwornValues};
use crate::contact::stick_slip::Regime;
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use crate::numerics::abel::Backend;
use crate::numerics::grid::Clustering;

/// Largest stretch of the mesh of an edge of stick that creeps outwards: from a small stick zone it soon comes to a larger one, and next to finer cells
/// errors grow.
const MOST_STRETCHED: f64 = 3.0;

/// Fewest springs for which operators are hierarchical where wear has no kinks: more than a run takes by itself, whose results are so those of dense
/// ones. They take less time from 300 springs on, but there stencils may reach farther than a block of the mesh, and held tangential forces lose
/// half of their steps (docs/many_springs.md). Where a small stick zone, from the last number of `ln(a0/c)` on, stretches the mesh, fewer are not smooth in it.
const HIERARCHICAL: [usize; 2] = [601, 1000];
const UNSTRETCHED: f64 = 3.5;

/// Fewest springs on which the local polynomials fit.
pub const FEWEST_SPRINGS: usize = 8;

/// Most springs in gross slip: polynomials over the whole contact have no use for more.
pub const MOST_IN_GROSS_SLIP: usize = 160;

/// Grading below which polynomials over the whole contact are of an even number: others swing at the contact edge, from where the unworn profile is not met.
const EVEN_BELOW: f64 = -0.9;

impl Model {
    /// Puts a contact on springs under the laws, mode, blocks and control of its scene.
    ///
    /// # Arguments
    /// * `contact` -- the contact of the first cycle
    /// * `conditions` -- those of its scene, whose laws replace the ones in the contact
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if nothing slips or the conditions do not go together; [`Error::OutOfRange`] for too few springs; those of the transforms.
    pub fn new(
        contact: &InitialContact,
        conditions: &Conditions,
        springs: usize,
        clustering: Clustering,
    ) -> Result<Self> {
        let schedule = Schedule::new(contact, conditions, Resolution::default())?;
        Self::under(contact, schedule, springs, clustering, &OperatorStore::default())
    }

    /// Puts a contact on springs for what a schedule does to it, with operators from a store that other models share.
    ///
    /// # Arguments
    /// * `contact` -- the contact of the first cycle
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn under(
        contact: &InitialContact,
        schedule: Schedule,
        springs: usize,
        clustering: Clustering,
        store: &OperatorStore,
    ) -> Result<Self> {
        if Gross::follows(contact, &schedule)? {
            return Self::in_gross_slip(contact, schedule, springs);
        }
        let backend = Self::backend(contact, &schedule, springs);
        let uniform = schedule.is_uniform() && contact.regime() != Regime::FullSliding;
        let Envelope { contact, slides } = if uniform {
            Envelope { contact: contact.clone(), slides: false }
        } else {
            schedule.envelope(contact)?
        };
        let contact = &contact;
        let stick_radius = contact.stick_radius().filter(|_| contact.slip_compression() > 0.0);
        let stick_radius = stick_radius.ok_or_else(|| Error::Inconsistent {
            what: "loading.amplitude",
            why: format!(
                "at an amplitude of {:e} m no spring slips in any cycle, so that nothing wears; ask for a larger one",
                contact.amplitude()
            ),
        })?;
        check_springs(springs)?;
        let moving = MovingStick::new(&schedule, contact)?;
        let farthest = match &moving {
            Some(moving) => moving.farthest(contact)?,
            None => contact.clone(),
        };
        Annulus { innermost: contact, stick_radius, farthest: &farthest, moving, slides }.model(
            contact.clone(),
            schedule,
            springs,
            clustering,
            (backend, store),
        )
    }

    /// A contact on the mesh of gross slip, in it or [nearly](Gross::nearly_follows), on one spring less where an odd number does not serve.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] and [`Error::Inconsistent`] for too few and too many springs; those of the quadrature.
    pub fn in_gross_slip(contact: &InitialContact, schedule: Schedule, springs: usize) -> Result<Self> {
        check_springs(springs)?;
        let parity = if contact.half_space().grading() < EVEN_BELOW { 2 } else { 1 };
        let springs = springs - springs % parity;
        if springs > MOST_IN_GROSS_SLIP {
            let why = format!(
                "{springs} springs are more than the {MOST_IN_GROSS_SLIP} that gross slip is followed with; 17 are its default"
            );
            return Err(Error::Inconsistent { what: "numerics.springs", why });
        }
        let deepest = schedule.largest_indentation();
        let contact = &match deepest == contact.indentation() {
            true => contact.clone(),
            false => contact.at(deepest, contact.slip_compression().max(deepest))?,
        };
        let gross = Gross::new(contact, &schedule, springs)?;
        let model = Self {
            contact: contact.clone(),
            schedule,
            mesh: SpringMesh::Whole(Box::new(gross)),
            output: OutputRadii::default(),
            stick_zone: StickZone { slip_compression: contact.slip_compression(), ..StickZone::default() },
            depth_scale: contact.indentation(),
            slides: true,
            meter: Meter::default(),
        };
        let offsets = model.gross_offsets(contact.contact_radius());
        Ok(model.shown_at(offsets))
    }

    /// A contact whose springs come to stick again after gross slip, with its edge of stick.
    ///
    /// # Arguments
    /// * `innermost` -- with a core that the edge of stick leaves before it is taken up
    pub(super) fn in_partial_slip(
        contact: &InitialContact,
        innermost: &InitialContact,
        schedule: &Schedule,
        springs: usize,
    ) -> Result<Self> {
        let moving = MovingStick::new(schedule, innermost)?;
        let farthest = innermost.under_held_forces()?.unwrap_or_else(|| innermost.clone());
        let stick_radius = innermost.stick_radius().unwrap_or_default();
        let annulus = Annulus { innermost, stick_radius, farthest: &farthest, moving, slides: false };
        let operators = (Backend::Dense, &OperatorStore::default());
        let model =
            annulus.model(contact.clone(), schedule.clone(), springs, Clustering::Cubic, operators)?;
        Ok(model)
    }

    /// Kind of operators for a number of springs: hierarchical where they are many, wear has no kinks and the edge of stick rests.
    pub fn backend(contact: &InitialContact, schedule: &Schedule, springs: usize) -> Backend {
        let stays = !schedule.conditions().holds_normal_force && contact.regime() != Regime::FullSliding;
        let stretched = contact.stick_logarithm().is_none_or(|logarithm| logarithm > UNSTRETCHED);
        let from = HIERARCHICAL[usize::from(stretched)];
        let serve = springs >= from && schedule.is_plain() && stays;
        if serve { Backend::Hierarchical } else { Backend::Dense }
    }
}

/// What a mesh over the slip annulus is made for.
struct Annulus<'a> {
    /// The contact with the smallest stick zone.
    innermost: &'a InitialContact,
    /// Its radius, m.
    stick_radius: f64,
    /// The contact of which the limit bounds where wear can reach.
    farthest: &'a InitialContact,
    moving: Option<MovingStick>,
    /// See [`Envelope::slides`].
    slides: bool,
}

impl Annulus<'_> {
    /// A contact on its springs.
    fn model(
        self,
        contact: InitialContact,
        schedule: Schedule,
        springs: usize,
        clustering: Clustering,
        (backend, store): (Backend, &OperatorStore),
    ) -> Result<Model> {
        let Self { innermost, stick_radius, farthest, moving, slides } = self;
        let profile = innermost.equivalent_profile();
        let grading = profile.grading();
        if moving.is_some() && profile.end_of_table().is_some() {
            // The closed form refuses profiles that lose contact in rings.
            LimitingShape::from_contact(farthest)?;
        }
        let unworn =
            UnwornSlip::new(profile, stick_radius, farthest.slip_compression(), farthest.slip_area_offset())?;
        let stick_radius_squared = stick_radius * stick_radius;
        let first = innermost.contact_radius().powi(2);
        let moving = moving.map(|it| it.with_span(first, stick_radius_squared + unworn.largest_slip_area()));
        let slip_exponent = schedule.conditions().slip_exponent_at_edge();
        let clustering =
            moving.as_ref().map_or(clustering, |moving| moving.clustering(clustering, slip_exponent));
        let natural = (unworn.limit_slip_area() / stick_radius_squared).ln_1p();
        let natural = match &moving {
            Some(moving) if moving.creeps() => natural.min(MOST_STRETCHED),
            _ => natural,
        };
        let stretch = clustering.stretch(natural, grading);
        let operators = store.get(grading, stretch, springs, clustering, backend)?;
        let moving = moving.map(|it| it.over(operators.abel.mesh(), grading, slip_exponent));
        let radial_unworn: Vec<_> =
            operators.abel.nodes()[1..].iter().map(|x| unworn.at(unworn.limit_slip_area() * x)).collect();
        let compression = innermost.slip_compression();
        let stick_load = 0.5 * profile.load_integral(stick_radius)
            + compression * stick_radius.powf(1.0 + grading) / (1.0 + grading);
        let deepest = radial_unworn.iter().map(UnwornValues::limit_depth).fold(0.0, f64::max);
        // There the edge of stick does not stay where the limit that bounds where wear can reach has it.
        let bounded = moving.as_ref().is_some_and(|it| it.creeps_under_force() || it.passes_worn_ground());
        let depth_scale = if bounded { deepest.min(contact.indentation()) } else { deepest };
        let hidden = match clustering {
            clustering if clustering.follows_front() => {
                operators.abel.nodes()[1..].partition_point(|x| *x < HIDDEN)
            }
            _ => 0,
        };
        Ok(Model {
            contact,
            schedule,
            output: OutputRadii::new(&unworn, operators.abel.mesh(), hidden),
            mesh: SpringMesh::Annulus(Box::new(AnnulusMesh {
                unworn,
                operators,
                radial_unworn,
                hidden,
                moving,
            })),
            stick_zone: StickZone {
                stick_area: stick_radius_squared,
                slip_compression: compression,
                stick_load,
            },
            depth_scale,
            slides,
            meter: Meter::default(),
        })
    }
}

fn check_springs(springs: usize) -> Result<()> {
    let (name, value, range) = ("numerics.springs", springs as f64, "[8, inf)");
    if springs < FEWEST_SPRINGS { Err(Error::OutOfRange { name, value, range }) } else { Ok(()) }
}
