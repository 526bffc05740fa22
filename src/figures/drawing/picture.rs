//! A drawing as a PNG. The home of the renderer.

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::Drawing;
use crate::error::{Error, Result};

/// Pixels of the picture for one of the drawing: 288 an inch.
const SCALE: f32 = 3.0;

/// The bytes of a PNG of a drawing on white.
///
/// # Errors
/// [`Error::Inconsistent`] if the picture has no size or is too large for the memory.
pub fn png(drawing: &Drawing) -> Result<Vec<u8>> {
    let failed = |why: String| Error::Inconsistent { what: "picture", why };
    let tree =
        Tree::from_str(&drawing.svg, &Options::default()).map_err(|error| failed(error.to_string()))?;
    let size = tree.size();
    let [width, height] = [size.width(), size.height()].map(|length| (SCALE * length).ceil() as u32);
    let mut pixels = Pixmap::new(width, height)
        .ok_or_else(|| failed(format!("{width} x {height} pixels are none or too many")))?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| failed(error.to_string()))
}
