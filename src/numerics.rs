//! Numerical methods that know nothing of contacts: quadrature, roots, interpolation, linear algebra, Abel transforms on a mesh.

pub mod abel;
pub mod chebyshev;
pub mod curve;
pub mod grid;
pub mod least_squares;
pub mod linear;
mod power;
pub mod quadrature;
pub mod roots;
pub mod whole_contact;

pub use power::power;
