//! Text of a picture: how wide it is, and its pixels. The font is part of the program, so that
//! pictures are the same on every machine.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use std::sync::OnceLock;

/// What an SVG viewer is asked for; the PNG has the embedded font.
pub(super) const FAMILY: &str = "Helvetica, Arial, sans-serif";
/// The light face is painted twice, this far apart (per em), to be read at half size.
const EMBOLDEN: f64 = 0.022;

/// The embedded font; `None` if its bytes were damaged.
fn font() -> Option<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    FONT.get_or_init(|| FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok()).as_ref()
}

/// The font's own measure of size: height of a line, for an em.
fn scale_of(font: &FontRef, em: f64) -> PxScale {
    let units = font.units_per_em().unwrap_or(1000.0);
    PxScale::from(em as f32 * font.height_unscaled() / units)
}

/// Width of a text in the embedded font, in the unit of `em`.
pub(super) fn width(text: &str, em: f64) -> f64 {
    let Some(font) = font() else { return 0.55 * em * text.chars().count() as f64 };
    // Measured at one size, so that widths are proportional to `em` to the last bit.
    let scaled = font.as_scaled(scale_of(font, 1000.0));
    let glyphs: Vec<_> = text.chars().map(|c| scaled.glyph_id(c)).collect();
    let advance: f32 = glyphs.iter().map(|&g| scaled.h_advance(g)).sum();
    let kerning: f32 = glyphs.windows(2).map(|g| scaled.kern(g[0], g[1])).sum();
    f64::from(advance + kerning) / 1000.0 * em
}

/// The text and the size at which it fits into `room`: smaller down to 80 %, then cut with "…".
pub(super) fn fit(text: &str, em: f64, room: f64) -> (String, f64) {
    let needed = width(text, em);
    if needed <= room {
        return (text.to_owned(), em);
    }
    let small = (em * room / needed).max(0.8 * em);
    let mut cut: Vec<char> = text.chars().collect();
    let mut shown = text.to_owned();
    while width(&shown, small) > room && cut.pop().is_some() {
        shown = cut.iter().collect::<String>().trim_end().to_owned() + "…";
    }
    (shown, small)
}

/// Hands out the pixels of a line of text whose baseline starts at (x, y): column, row, coverage.
/// `align` is the part of the width that lies left of x. False when there is no font.
pub(super) fn rasterise<E>(
    text: &str,
    em: f64,
    (x, y): (f64, f64),
    align: f64,
    mut pixel: impl FnMut(i32, i32, f64) -> Result<(), E>,
) -> Result<bool, E> {
    let Some(font) = font() else { return Ok(false) };
    let scaled = font.as_scaled(scale_of(font, em));
    let start = (x - align * width(text, em)) as f32;
    for shift in [-0.5, 0.5] {
        let mut pen = start + (shift * EMBOLDEN * em) as f32;
        let mut last = None;
        for c in text.chars() {
            let id = scaled.glyph_id(c);
            pen += last.map_or(0.0, |l| scaled.kern(l, id));
            if let Some(outline) =
                scaled.outline_glyph(id.with_scale_and_position(scaled.scale(), point(pen, y as f32)))
            {
                let corner = outline.px_bounds().min;
                let mut failed = Ok(());
                outline.draw(|dx, dy, cover| {
                    if failed.is_ok() && cover > 0.0 {
                        failed =
                            pixel(corner.x as i32 + dx as i32, corner.y as i32 + dy as i32, f64::from(cover.min(1.0)));
                    }
                });
                failed?;
            }
            pen += scaled.h_advance(id);
            last = Some(id);
        }
    }
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_font_has_the_glyphs_of_our_field() {
        let font = font().expect("font");
        for c in "ωζμφΦσΣΔ²³·×−–√°…≥≤".chars() {
            assert_ne!(font.glyph_id(c).0, 0, "{c}");
        }
    }

    #[test]
    fn long_text_is_cut_to_fit() {
        let (text, em) = fit(&"receptance ".repeat(30), 20.0, 300.0);
        assert!(text.ends_with('…') && width(&text, em) <= 300.0);
        assert_eq!(fit("short", 20.0, 300.0), ("short".into(), 20.0));
        assert_eq!(fit("short", 20.0, 0.0).0, "…");
    }

    #[test]
    fn pixels_fill_the_measured_width() {
        let (mut left, mut right) = (i32::MAX, i32::MIN);
        let painted = rasterise::<()>("HIH", 100.0, (500.0, 200.0), 0.5, |x, y, _| {
            (left, right) = (left.min(x), right.max(x));
            assert!((120..=201).contains(&y), "capitals stand on the baseline: {y}");
            Ok(())
        });
        assert_eq!(painted, Ok(true));
        let measured = width("HIH", 100.0);
        assert!(f64::from(right - left) < measured && f64::from(right - left) > 0.8 * measured);
        assert!((f64::from(right + left) / 2.0 - 500.0).abs() < 4.0);
    }
}
