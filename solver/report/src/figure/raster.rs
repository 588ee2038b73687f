//! A picture in pixels: what a browser makes of its SVG.
//!
//! The plotting library's own rasteriser fills every outline of a path by itself, and a region with a hole whole.

use landau_solver::file::seal::{self, BLANK};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use std::sync::{Arc, LazyLock};

/// Pixels a pixel of the drawing.
const SCALE: f32 = 1.5;
/// The family of the font that drawings name.
const FONT: &str = "DejaVu Sans";

/// The font itself, so that no machine has to have it.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family(FONT);
    Arc::new(fonts)
});

/// PNG.
pub(super) fn png(svg: &str) -> Result<Vec<u8>, String> {
    let options = Options {
        fontdb: FONTS.clone(),
        font_family: FONT.to_owned(),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).map_err(|e| e.to_string())?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let size = size.ok_or("it has no size")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("it is too large")?;
    let mut view = pixels.as_mut();
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut view);
    pixels.encode_png().map_err(|e| e.to_string())
}

/// Bytes of the chunk that ends a PNG.
const END: usize = 12;

/// A PNG with a seal in a chunk of text before its end.
pub(super) fn sealed(png: Vec<u8>) -> Vec<u8> {
    let with = |text: &str| {
        let (body, end) = png.split_at(png.len().saturating_sub(END));
        [body, &text_chunk(text), end].concat()
    };
    match seal::digits(&with(BLANK)) {
        // The seal does not count the digits, nor the checksum of the chunk, which follows them.
        Some(digits) => with(&BLANK.replace("0000000000000000", &digits)),
        None => png,
    }
}

/// A chunk `tEXt` with the keyword `Software`: length, type, data, checksum over type and data.
fn text_chunk(text: &str) -> Vec<u8> {
    let data = [b"Software\0Landau ", text.as_bytes()].concat();
    let body = [b"tEXt", data.as_slice()].concat();
    let length = (data.len() as u32).to_be_bytes();
    let checksum = crc32fast::hash(&body).to_be_bytes();
    [&length, body.as_slice(), &checksum].concat()
}

#[cfg(test)]
mod tests {
    use super::{Pixmap, SCALE, png, sealed};
    use landau_solver::file::seal::is_sealed;

    /// A hole in a region stays a hole, and text is drawn.
    #[test]
    fn holes_and_text() {
        let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="40">
            <rect width="60" height="40" fill="#ffffff"/>
            <path fill="#0000ff" d="M0 0L40 0L40 40L0 40ZM10 10L10 30L30 30L30 10Z"/>
            <text x="44" y="20" font-family="DejaVu Sans, sans-serif" font-size="16">M</text></svg>"##;
        let drawn = Pixmap::decode_png(&png(svg).expect("a picture")).expect("a PNG");
        assert_eq!((drawn.width(), drawn.height()), (90, 60));
        let at = |x: f32, y: f32| {
            let pixel = drawn.pixel((x * SCALE) as u32, (y * SCALE) as u32);
            pixel.map(|p| (p.red(), p.green(), p.blue()))
        };
        assert_eq!(at(5.0, 5.0), Some((0, 0, 255)));
        assert_eq!(at(20.0, 20.0), Some((255, 255, 255)));
        let dark = |p: &resvg::tiny_skia::PremultipliedColorU8| p.red() < 50 && p.blue() < 50;
        assert!(drawn.pixels().iter().any(dark));
    }

    /// The sealed picture is a PNG with the same pixels, and any other change is seen.
    #[test]
    fn a_sealed_picture() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="6" height="4"/>"#;
        let plain = png(svg).expect("a picture");
        let whole = sealed(plain.clone());
        assert!(is_sealed(&whole) && !is_sealed(&plain));
        let pixels = |png: &[u8]| Pixmap::decode_png(png).expect("a PNG").take();
        assert_eq!(pixels(&whole), pixels(&plain));
        let mut changed = whole;
        changed[20] ^= 1;
        assert!(!is_sealed(&changed));
    }
}
