//! The one style of all pictures: colours and sizes.

/// Colours that stay apart for colour-blind eyes (Okabe and Ito 2008), and two greys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colour {
    /// Text and axes.
    #[default]
    Ink,
    /// What stands back.
    Grey,
    /// Grid lines.
    Faint,
    /// Background.
    White,
    /// First choice.
    Blue,
    /// Second choice: vermillion.
    Vermillion,
    /// Third choice: bluish green.
    Green,
    /// Fourth choice: reddish purple.
    Purple,
    /// Fifth choice; too light for text.
    Orange,
    /// Sixth choice; too light for text.
    Sky,
}

impl Colour {
    /// Red, green, blue.
    pub(super) fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Ink => (0x22, 0x22, 0x22),
            Self::Grey => (0x6b, 0x6b, 0x6b),
            Self::Faint => (0xe4, 0xe4, 0xe4),
            Self::White => (0xff, 0xff, 0xff),
            Self::Blue => (0x00, 0x72, 0xb2),
            Self::Vermillion => (0xd5, 0x5e, 0x00),
            Self::Green => (0x00, 0x9e, 0x73),
            Self::Purple => (0xa6, 0x4d, 0x7f),
            Self::Orange => (0xe6, 0x9f, 0x00),
            Self::Sky => (0x56, 0xb4, 0xe9),
        }
    }
}

/// Height of the em of each kind of text, so that it can be read at half size.
pub(super) const TITLE: f64 = 20.0;
/// Second line.
pub(super) const SUBTITLE: f64 = 15.5;
/// Numbers on the axes.
pub(super) const TICK: f64 = 16.0;
/// Axis names and names of curves.
pub(super) const NAME: f64 = 16.0;
/// Raised exponents.
pub(super) const EXPONENT: f64 = 12.0;
/// Width of a curve.
pub(super) const CURVE_WIDTH: f64 = 2.2;
/// Radius of a point.
pub(super) const POINT_RADIUS: f64 = 4.6;
