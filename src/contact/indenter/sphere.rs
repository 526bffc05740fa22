//! The sphere.

use std::sync::Arc;

use super::Indenter;
use super::equivalent::Equivalent;
use super::shape::{Shape, positive};
use super::sphere_integral::SphereIntegral;
use crate::error::{Error, Result};
use crate::laws::entry::Entry;
use crate::numerics::roots;
use crate::units::{Dimension, Key, Range, Scale};

/// `[indenter.sphere]`.
pub static ENTRY: Entry<dyn Shape> = Entry::new("sphere", "f = R - √(R² - r²).", &[RADIUS], |values| {
    Ok(Arc::new(Sphere { radius: values.number(RADIUS.name) }))
});

const RADIUS: Key =
    Key::quantity("radius", Dimension::LENGTH, "Radius R, m.").range(Range::POSITIVE).example("10 mm");

/// `f = R - √(R² - r²)`.
#[derive(Debug)]
struct Sphere {
    /// Radius `R`, m.
    radius: f64,
}

impl Indenter {
    /// Sphere of radius `R`, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names `indenter.sphere.radius`.
    pub fn sphere(radius: f64) -> Result<Self> {
        Ok(Self(Arc::new(Sphere { radius: positive("indenter.sphere.radius", radius)? })))
    }
}

impl Shape for Sphere {
    fn entry(&self) -> &'static Entry<dyn Shape> {
        &ENTRY
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.radius]
    }

    fn words(&self) -> String {
        format!("sphere, radius {}", Scale::LENGTH.show(self.radius))
    }

    fn profile(&self, r: f64) -> f64 {
        r * r / (self.radius + ((self.radius - r) * (self.radius + r)).sqrt())
    }

    fn profile_derivative(&self, r: f64) -> f64 {
        r / ((self.radius - r) * (self.radius + r)).sqrt()
    }

    fn radius_at_height(&self, height: f64) -> f64 {
        if height < self.radius { (height * (2.0 * self.radius - height)).sqrt() } else { self.radius }
    }

    fn equivalent(&self, grading: f64) -> Result<Arc<dyn Equivalent>> {
        let integral = SphereIntegral::new(grading)?;
        Ok(Arc::new(SphereEquivalent { grading, radius: self.radius, integral }))
    }
}

/// `g = R/(1+k) h(x²/R²)`.
#[derive(Debug)]
struct SphereEquivalent {
    grading: f64,
    radius: f64,
    integral: SphereIntegral,
}

impl Equivalent for SphereEquivalent {
    fn grading(&self) -> f64 {
        self.grading
    }

    /// 0.999 of the radius, at whose equator the flank is vertical.
    fn largest_radius(&self) -> f64 {
        self.radius * SphereIntegral::LARGEST_ARGUMENT.sqrt()
    }

    fn singular_radius(&self) -> Option<f64> {
        Some(self.radius)
    }

    fn value(&self, x: f64) -> f64 {
        self.rise(0.0, x.min(2.0 * self.radius).powi(2))
    }

    fn derivative(&self, x: f64) -> f64 {
        let argument = (x / self.radius).powi(2);
        2.0 * x / (self.radius * (1.0 + self.grading)) * self.integral.mean_slope(argument, argument)
    }

    fn rise(&self, start: f64, offset: f64) -> f64 {
        let Self { grading, radius, integral } = self;
        let first = (start / radius).powi(2);
        let increase = offset / (radius * radius);
        radius / (1.0 + grading) * increase * integral.mean_slope(first, first + increase)
    }

    fn radius_at(&self, depth: f64) -> Result<f64> {
        let radius = self.radius;
        let scaled = depth * (1.0 + self.grading) / radius;
        let argument = self.integral.argument_at(scaled).ok_or_else(|| Error::Inconsistent {
            what: "contact radius",
            why: format!(
                "a sphere of radius {radius} m at an indentation of {depth} m would touch beyond 0.999 of its radius"
            ),
        })?;
        Ok(radius * argument.sqrt())
    }

    fn radius_squared_drop(&self, radius: f64, depth_drop: f64) -> f64 {
        let scaled = depth_drop * (1.0 + self.grading) / self.radius;
        self.radius * self.radius * self.integral.argument_drop((radius / self.radius).powi(2), scaled)
    }

    fn load_integral(&self, radius: f64) -> f64 {
        let q = 1.0 + self.grading;
        let argument = (radius / self.radius).powi(2);
        radius.powf(q + 2.0) / (self.radius * q) * self.integral.load(argument)
    }

    fn depth_for_load(&self, load: f64) -> Result<f64> {
        let (radius, q) = (self.radius, 1.0 + self.grading);
        let largest = self.largest_radius();
        if self.load_integral(largest) < load {
            let why = format!(
                "F_N/c_N = {load} m^(2+k) presses a sphere of radius {radius} m in beyond 0.999 of its radius"
            );
            return Err(Error::Inconsistent { what: "indentation under the normal force", why });
        }
        // A sphere carries more than its paraboloid of the same contact radius.
        let paraboloid = (0.5 * load * q * q * (2.0 + q) * radius / 2.0).powf((2.0 + q).recip());
        let contact =
            roots::bracketed(|a| self.load_integral(a) - load, 0.0, largest.min(1.001 * paraboloid), 0.0)?;
        Ok(self.value(contact))
    }

    fn origin(&self, radius: f64) -> f64 {
        (radius / self.radius).powi(2)
    }

    fn rise_from(&self, origin: f64, logarithm: f64) -> f64 {
        let increase = origin * (2.0 * logarithm).exp_m1();
        self.radius / (1.0 + self.grading) * increase * self.integral.mean_slope(origin, origin + increase)
    }

    fn logarithmic_slope_from(&self, origin: f64, logarithm: f64) -> f64 {
        let argument = origin * (2.0 * logarithm).exp();
        2.0 * self.radius / (1.0 + self.grading) * argument * self.integral.mean_slope(argument, argument)
    }
}
