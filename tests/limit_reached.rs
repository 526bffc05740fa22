//! The simulated limit against the paper's closed form.

mod support;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::numerics::abel::AbelOperators;
use fretwear::numerics::grid::{Clustering, Mesh};
use fretwear::numerics::linear::multiply;
use fretwear::numerics::roots::bracketed;
use fretwear::scene::Scene;
use fretwear::solver::simulation::{End, Outcome, Plan};
use fretwear::solver::stepper::Sdirk;
use support::{Case, orders};

#[test]
fn the_limiting_shape_is_reached_from_cone_to_quartic_over_all_gradings() {
    let nothing = || (0.0, String::new());
    let (mut depth, mut late, mut volume, mut edge) = (nothing(), nothing(), nothing(), nothing());
    for exponent in [1.0, 2.0, 4.0] {
        for grading in [-0.5, -0.2, 0.0, 0.5, 0.9] {
            for stick_ratio in [0.3, 0.7, 0.95] {
                let case = Case::new(exponent, grading, stick_ratio, 60).smooth();
                let name = format!("n = {exponent}, k = {grading}, c/a0 = {stick_ratio}");
                let shape = LimitingShape::from_contact(&case.contact()).unwrap().unwrap();
                let plan = Plan { outputs: vec![], end: End::Rate(1e-12) };
                let mut simulation = case.simulation(Box::new(Sdirk::new(1e-3)), 1e-3, plan);
                let outcome = simulation.run(&mut []).unwrap();
                assert_eq!(outcome, Outcome::Rate, "{name}");
                let model = simulation.model();
                let limit: Vec<f64> =
                    model.offsets().iter().map(|offset| shape.wear_depth_at_offset(*offset)).collect();
                let distance = support::distance(&simulation.wear_depth(), &limit) / shape.wear_depth_max();
                let worn = model.wear_volume(simulation.fields()) / shape.wear_volume() - 1.0;
                let limit_edge = shape.contact_radius_limit().powi(2) - shape.stick_radius().powi(2);
                let off = (simulation.state().slip_area / limit_edge - 1.0).abs();
                // As k → 1 the ground next to the edge of stick wears long after the rest.
                let depth = if grading == 0.9 { &mut late } else { &mut depth };
                for (worst, value) in [(depth, distance), (&mut volume, worn.abs()), (&mut edge, off)] {
                    if value.is_nan() || value > worst.0 {
                        *worst = (value, format!("{name}: {outcome:?} at τ = {}", simulation.state().cycles));
                    }
                }
            }
        }
    }
    // Measured: depth 2.9e-13, LATE at k = 0.9, volume 8.7e-8 (cone, k = -0.5, c/a0 = 0.3), edge 1.5e-13.
    assert!(depth.0 <= 3e-12, "largest distance from the limit over its depth: {depth:?}");
    assert!(late.0 <= 6e-9, "the same at k = 0.9: {late:?}");
    assert!(volume.0 <= 9e-7, "largest relative error of the worn volume: {volume:?}");
    assert!(edge.0 <= 3e-13, "largest relative error of the contact edge: {edge:?}");
}

#[test]
fn a_sphere_reaches_its_limit_next_to_the_equator() {
    // The limit's radius over the sphere's: 0.974, 0.955 and 0.970.
    for (grading, indentation) in [(0.0, 0.8), (-0.3, 0.78), (-0.3, 0.84)] {
        let scene = Scene::from_toml(
            &format!(
                "[indenter.sphere]\nradius = 1\n[half_space]\ngrading = {grading}\nnormal_stiffness = 2e11\nstiffness_ratio = 0.7\n\
                 [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1.667e-13\n\
                 [loading]\nindentation = {indentation}\nstick_ratio = 0.07\nfrequency = 1\ntau = 1000\n[numerics]\naccuracy = 1e-4\n"
            ),
            "sphere.toml",
        );
        let results = scene.unwrap().simulate().unwrap();
        let limit = results.limit().unwrap();
        let worn = results.last().wear_volume / limit.wear_volume() - 1.0;
        let edge = results.last().contact_radius / limit.contact_radius_limit() - 1.0;
        let place = format!("k = {grading}, {} of the radius", limit.contact_radius_limit());
        println!("{place}: volume {worn:e}, edge {edge:e}, {:?}", results.accuracy_met());
        assert_eq!(results.accuracy_met(), Some(true), "{place}");
        assert!(worn.abs() < 1e-4 && edge.abs() < 1e-4, "{place}: volume {worn:e}, edge {edge:e}");
    }
}

/// Error of the limit, relative to its largest depth, with the initial compression interpolated between the nodes.
fn error_of_interpolated_limit(exponent: f64, grading: f64, cells: usize, clustering: Clustering) -> f64 {
    let contact = Case::new(exponent, grading, 0.7, cells).contact();
    let shape = LimitingShape::from_contact(&contact).unwrap().unwrap();
    let squared = shape.stick_radius().powi(2);
    let limit_edge = shape.contact_radius_limit().powi(2) - squared;
    let mesh = Mesh::new(cells, clustering.stretch((limit_edge / squared).ln_1p(), grading), clustering);
    let operators = AbelOperators::new(grading, mesh).unwrap();
    let depths = |edge: f64| {
        let density = |x: &f64| {
            let compression = contact.slip_compression()
                - contact.equivalent_profile().rise(shape.stick_radius(), edge * x);
            (squared + edge * x).powf(0.5 * (grading - 1.0)) * compression
        };
        let densities: Vec<f64> = operators.nodes()[1..].iter().map(density).collect();
        let mut depths = vec![0.0; cells];
        multiply(operators.profile().as_ref(), &densities, &mut depths);
        depths.iter().map(|depth| depth * edge.powf(0.5 * (1.0 - grading))).collect::<Vec<_>>()
    };
    let edge = bracketed(|edge| depths(edge)[cells - 1], 0.8 * limit_edge, 1.2 * limit_edge, 0.0).unwrap();
    let exact: Vec<f64> =
        operators.nodes()[1..].iter().map(|x| shape.wear_depth_at_offset(edge * x)).collect();
    support::distance(&depths(edge), &exact) / shape.wear_depth_max()
}

#[test]
fn the_limit_is_of_the_order_of_the_polynomials_without_help() {
    for exponent in [1.0, 4.0] {
        for grading in [-0.5, 0.0, 0.5] {
            let errors = |clustering| {
                [15, 30, 60].map(|cells| error_of_interpolated_limit(exponent, grading, cells, clustering))
            };
            let (cubic, quintic) = (errors(Clustering::Cubic), errors(Clustering::Smooth));
            // Measured: 3.82 to 4.5 with cubics, 5.43 to 5.9 with polynomials of degree 5.
            for (name, errors, least) in [("cubic", cubic, 3.5), ("quintic", quintic, 5.0)] {
                assert!(
                    orders(&errors).iter().all(|order| *order > least),
                    "n = {exponent}, k = {grading}, {name}: errors {errors:?}, orders {:?}",
                    orders(&errors)
                );
            }
        }
    }
}

/// By a power of the pressure below one wear is spent in finite time; from there on the contact stays as it is.
#[test]
fn a_power_of_the_pressure_below_one_ends_at_the_closed_form_under_both_controls() {
    let mut worst = (0.0, String::new());
    for grading in [0.0, 0.3, 0.5, 0.63, 0.9] {
        for slip_exponent in [0.5, 1.2] {
            for control in ["initial_force = 0.03", "normal_force = 0.03\ntangential_control = \"force\""] {
                let text = format!(
                    "[indenter.paraboloid]\nradius = 10.0\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1.5e9\nstiffness_ratio = 1.4\n\
                     [friction.coulomb]\ncoefficient = 0.23\n[wear.power-law]\ncoefficient = 1e-6\npressure_exponent = 0.67\n\
                     slip_exponent = {slip_exponent}\n[loading]\n{control}\namplitude_ratio = 0.35\ntau = 2000.0\n[numerics]\nsprings = 40\n"
                );
                let scene = fretwear::Scene::from_toml(&text, "scene.toml").unwrap();
                let results =
                    scene.simulate().unwrap_or_else(|error| panic!("{grading}, {control}: {error}"));
                let limit = results.limit().unwrap().wear_volume();
                let missed = (results.last().wear_volume / limit - 1.0).abs();
                if missed.is_nan() || missed > worst.0 {
                    worst = (missed, format!("k = {grading}, s^{slip_exponent}, {control}"));
                }
            }
        }
    }
    // Measured: 4.1e-6 (k = 0.5, s^0.5, both forces held).
    assert!(worst.0 <= 4e-5, "largest relative error of the worn volume: {worst:?}");
}
