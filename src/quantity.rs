//! Numbers with units: "166.55 N/deg" → 9542.6 N/rad, dimension checked. The only place where units convert.

use serde::de::{self, Deserialize, Deserializer, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Exponents of length, mass, time and angle. Angle counts as a dimension of its own, so that a
/// stiffness per degree cannot be read as one per radian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// Exponents of metre, kilogram, second, radian.
    pub exponents: [i8; 4],
    /// "stiffness".
    pub name: &'static str,
    /// "N/m".
    pub si: &'static str,
}

/// A kind of quantity a configuration key expects.
pub trait Kind {
    /// Its dimension.
    const DIMENSION: Dimension;
}

/// A value in SI units that a configuration file gives as a plain number (SI) or as text with a unit.
pub struct Quantity<K> {
    /// In SI units.
    pub si: f64,
    kind: PhantomData<K>,
}

impl<K> Clone for Quantity<K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K> Copy for Quantity<K> {}

impl<K> fmt::Debug for Quantity<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.si.fmt(f)
    }
}

impl<K> From<f64> for Quantity<K> {
    fn from(si: f64) -> Self {
        Self { si, kind: PhantomData }
    }
}

macro_rules! kinds {
    ($($(#[$doc:meta])* $name:ident = $exponents:expr, $text:literal, $si:literal;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name;
        impl Kind for $name {
            const DIMENSION: Dimension = Dimension { exponents: $exponents, name: $text, si: $si };
        }
    )*};
}

kinds! {
    /// m.
    Length = [1, 0, 0, 0], "length", "m";
    /// kg.
    Mass = [0, 1, 0, 0], "mass", "kg";
    /// s.
    Time = [0, 0, 1, 0], "time", "s";
    /// rad.
    Angle = [0, 0, 0, 1], "angle", "rad";
    /// m/s.
    Speed = [1, 0, -1, 0], "speed", "m/s";
    /// m/s².
    Acceleration = [1, 0, -2, 0], "acceleration", "m/s^2";
    /// N.
    Force = [1, 1, -2, 0], "force", "N";
    /// N/m.
    Stiffness = [0, 1, -2, 0], "stiffness", "N/m";
    /// N·s/m.
    Damping = [0, 1, -1, 0], "damping", "N s/m";
    /// N/rad.
    ForcePerAngle = [1, 1, -2, -1], "force per angle", "N/rad";
    /// kg·m².
    Inertia = [2, 1, 0, 0], "moment of inertia", "kg m^2";
    /// rad/s.
    AngularFrequency = [0, 0, -1, 1], "angular frequency", "rad/s";
    /// 1.
    Ratio = [0, 0, 0, 0], "ratio", "1";
}

/// A unit symbol: SI factor, exponents, whether metric prefixes apply.
type Unit = (&'static str, f64, [i8; 4], bool);

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const TURN: f64 = 2.0 * std::f64::consts::PI;
/// Standard gravity, m/s² (ISO 80000-3): defines kgf, lbf and "g0".
const STANDARD_GRAVITY: f64 = 9.806_65;
const POUND: f64 = 0.453_592_37;
const FOOT: f64 = 0.304_8;

const UNITS: &[Unit] = &[
    ("m", 1.0, [1, 0, 0, 0], true),
    ("g", 1e-3, [0, 1, 0, 0], true),
    ("s", 1.0, [0, 0, 1, 0], true),
    ("rad", 1.0, [0, 0, 0, 1], true),
    ("N", 1.0, [1, 1, -2, 0], true),
    ("Pa", 1.0, [-1, 1, -2, 0], true),
    ("J", 1.0, [2, 1, -2, 0], true),
    ("W", 1.0, [2, 1, -3, 0], true),
    ("Hz", TURN, [0, 0, -1, 1], true),
    ("t", 1e3, [0, 1, 0, 0], false),
    ("tonne", 1e3, [0, 1, 0, 0], false),
    ("min", 60.0, [0, 0, 1, 0], false),
    ("h", 3600.0, [0, 0, 1, 0], false),
    ("deg", DEGREE, [0, 0, 0, 1], false),
    ("°", DEGREE, [0, 0, 0, 1], false),
    ("rev", TURN, [0, 0, 0, 1], false),
    ("rpm", TURN / 60.0, [0, 0, -1, 1], false),
    ("in", FOOT / 12.0, [1, 0, 0, 0], false),
    ("ft", FOOT, [1, 0, 0, 0], false),
    ("lb", POUND, [0, 1, 0, 0], false),
    ("lbm", POUND, [0, 1, 0, 0], false),
    ("slug", POUND * STANDARD_GRAVITY / FOOT, [0, 1, 0, 0], false),
    ("lbf", POUND * STANDARD_GRAVITY, [1, 1, -2, 0], false),
    ("kgf", STANDARD_GRAVITY, [1, 1, -2, 0], false),
    ("g0", STANDARD_GRAVITY, [1, 0, -2, 0], false),
    ("kn", 1852.0 / 3600.0, [1, 0, -1, 0], false),
    ("kt", 1852.0 / 3600.0, [1, 0, -1, 0], false),
    ("%", 1e-2, [0, 0, 0, 0], false),
];

const PREFIXES: &[(&str, f64)] =
    &[("n", 1e-9), ("u", 1e-6), ("µ", 1e-6), ("μ", 1e-6), ("m", 1e-3), ("c", 1e-2), ("k", 1e3), ("M", 1e6), ("G", 1e9)];

/// The SI factor and exponents of a unit symbol such as "kN"; `None` for an unknown one.
fn unit(symbol: &str) -> Option<(f64, [i8; 4])> {
    if let Some(&(_, factor, exponents, _)) = UNITS.iter().find(|u| u.0 == symbol) {
        return Some((factor, exponents));
    }
    PREFIXES.iter().find_map(|&(prefix, scale)| {
        let rest = symbol.strip_prefix(prefix)?;
        let &(_, factor, exponents, _) = UNITS.iter().find(|u| u.0 == rest && u.3)?;
        Some((scale * factor, exponents))
    })
}

/// Reads "75 kN/m" as a value of the wanted dimension, in SI units; a bare number is SI.
///
/// Products are written with a space, `*` or `·`, powers as `m^2`, `m2` or `m²`; a product after a
/// division needs parentheses: `N/(m s)`.
pub fn parse(text: &str, wanted: Dimension) -> Result<f64, String> {
    let text = text.trim();
    let number_end = number_length(text);
    let fail = |what: String| {
        format!(
            "{what}; expected a {}, such as \"1 {}\" (a bare number is taken in {})",
            wanted.name, wanted.si, wanted.si
        )
    };
    let number: f64 = text[..number_end]
        .parse()
        .map_err(|_| fail(format!("found \"{text}\", which does not start with a number")))?;
    if !number.is_finite() {
        return Err(fail(format!("found {number}")));
    }
    let rest = text[number_end..].trim();
    if rest.is_empty() {
        return Ok(number);
    }
    let (factor, exponents) =
        UnitParser { rest, depth: 0 }.whole().map_err(|e| fail(format!("found \"{text}\": {e}")))?;
    // Engineers write an angular rate as 1/s or an angle as a bare ratio; nothing else may differ.
    if exponents != wanted.exponents {
        return Err(fail(format!("found \"{text}\", which is not a {}", wanted.name)));
    }
    Ok(number * factor)
}

/// SI factor of a unit of known dimension: `factor("mm", Length)` = 1e-3.
pub fn factor(symbol: &str, wanted: Dimension) -> Result<f64, String> {
    parse(&format!("1 {symbol}"), wanted)
}

/// Bytes of the leading decimal number, exponent included only where digits follow it.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut k = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    while k < bytes.len() && (bytes[k].is_ascii_digit() || bytes[k] == b'.') {
        k += 1;
    }
    if matches!(bytes.get(k), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(k + 1), Some(b'+' | b'-')));
        if bytes.get(k + 1 + sign).is_some_and(u8::is_ascii_digit) {
            k += 1 + sign;
            while bytes.get(k).is_some_and(u8::is_ascii_digit) {
                k += 1;
            }
        }
    }
    k
}

struct UnitParser<'a> {
    rest: &'a str,
    depth: usize,
}

impl UnitParser<'_> {
    fn whole(mut self) -> Result<(f64, [i8; 4]), String> {
        let found = self.product()?;
        if self.rest.is_empty() { Ok(found) } else { Err(format!("cannot read \"{}\" as a unit", self.rest)) }
    }

    fn product(&mut self) -> Result<(f64, [i8; 4]), String> {
        let (mut scale, mut exponents) = self.power()?;
        let mut divided = false;
        loop {
            self.rest = self.rest.trim_start();
            let Some(next) = self.rest.chars().next() else { return Ok((scale, exponents)) };
            if next == ')' && self.depth > 0 {
                return Ok((scale, exponents));
            }
            let sign = if next == '/' { -1 } else { 1 };
            if matches!(next, '/' | '*' | '·') {
                self.rest = &self.rest[next.len_utf8()..];
            }
            if sign > 0 && divided {
                return Err("a product after a division is ambiguous: write N/(m s)".into());
            }
            divided |= sign < 0;
            let (f, e) = self.power()?;
            scale *= f.powi(i32::from(sign));
            for k in 0..4 {
                exponents[k] += sign * e[k];
            }
        }
    }

    fn power(&mut self) -> Result<(f64, [i8; 4]), String> {
        self.rest = self.rest.trim_start();
        let base = if let Some(inner) = self.rest.strip_prefix('(') {
            self.rest = inner;
            self.depth += 1;
            if self.depth > 8 {
                return Err("too many parentheses".into());
            }
            let inside = self.product()?;
            self.depth -= 1;
            self.rest = self.rest.trim_start().strip_prefix(')').ok_or("a parenthesis is not closed")?;
            inside
        } else if let Some(after) = self.rest.strip_prefix('1').filter(|a| a.trim_start().starts_with('/')) {
            self.rest = after;
            (1.0, [0; 4])
        } else {
            let end = self.rest.find(|c: char| !(c.is_alphabetic() || c == '%' || c == '°')).unwrap_or(self.rest.len());
            let (symbol, after) =
                if self.rest.starts_with("g0") { self.rest.split_at(2) } else { self.rest.split_at(end) };
            let found = unit(symbol).ok_or_else(|| format!("unknown unit \"{symbol}\""))?;
            self.rest = after;
            found
        };
        let exponent = self.exponent()?;
        Ok((base.0.powi(i32::from(exponent)), base.1.map(|e| e * exponent)))
    }

    fn exponent(&mut self) -> Result<i8, String> {
        for (sign, value) in [('²', 2), ('³', 3)] {
            if let Some(after) = self.rest.strip_prefix(sign) {
                self.rest = after;
                return Ok(value);
            }
        }
        let marked = self.rest.strip_prefix('^');
        let digits = marked.unwrap_or(self.rest);
        let length = number_length(digits);
        if length == 0 {
            return if marked.is_some() { Err("a number must follow ^".into()) } else { Ok(1) };
        }
        let value = digits[..length].parse::<i8>().ok().filter(|v| v.abs() <= 9);
        self.rest = &digits[length..];
        value.ok_or_else(|| format!("the power \"{}\" is not a whole number of one digit", &digits[..length]))
    }
}

impl<'de, K: Kind> Deserialize<'de> for Quantity<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read<K>(PhantomData<K>);
        impl<K: Kind> Visitor<'_> for Read<K> {
            type Value = f64;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a {} (a number in {si} or text such as \"1 {si}\")", K::DIMENSION.name, si = K::DIMENSION.si)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<f64, E> {
                if value.is_finite() {
                    Ok(value)
                } else {
                    Err(E::custom(format!("found {value}, expected a finite {}", K::DIMENSION.name)))
                }
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<f64, E> {
                Ok(value as f64)
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<f64, E> {
                Ok(value as f64)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<f64, E> {
                parse(text, K::DIMENSION).map_err(E::custom)
            }
        }
        deserializer.deserialize_any(Read::<K>(PhantomData)).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(text: &str, wanted: Dimension, expected: f64) {
        let found = parse(text, wanted).unwrap_or_else(|e| panic!("{text}: {e}"));
        // One rounding per factor: a few units in the last place.
        assert!((found / expected - 1.0).abs() < 1e-14, "{text}: {found} != {expected}");
    }

    #[test]
    fn units_of_the_reference_drop() {
        close("166.55 N/deg", ForcePerAngle::DIMENSION, 166.55 * 180.0 / std::f64::consts::PI);
        close("75 kN/m", Stiffness::DIMENSION, 75_000.0);
        close("75000", Stiffness::DIMENSION, 75_000.0);
        close("175 N s/m", Damping::DIMENSION, 175.0);
        close("175 N/(m/s)", Damping::DIMENSION, 175.0);
        close("3.45e-3 kg m^2", Inertia::DIMENSION, 3.45e-3);
        close("3.45e-3 kg·m²", Inertia::DIMENSION, 3.45e-3);
        close("1 ms", Time::DIMENSION, 1e-3);
        close("9.81 m/s^2", Acceleration::DIMENSION, 9.81);
        close("1 g0", Acceleration::DIMENSION, 9.80665);
        close("100 kg", Mass::DIMENSION, 100.0);
        close("10 lbf", Force::DIMENSION, 44.482_216_152_605);
        close("-5 mm", Length::DIMENSION, -5e-3);
        close("17.04 Hz", AngularFrequency::DIMENSION, 17.04 * TURN);
        close("3 %", Ratio::DIMENSION, 0.03);
    }

    #[test]
    fn wrong_dimensions_and_unknown_units_are_refused() {
        for (text, wanted) in [
            ("166.55 N", ForcePerAngle::DIMENSION),
            ("75 kN/mm", Mass::DIMENSION),
            ("3 m/s/s", Speed::DIMENSION),
            ("3 parsec", Length::DIMENSION),
            ("fast", Speed::DIMENSION),
            ("1 N/m s", Damping::DIMENSION),
            ("1 N/(m s", Damping::DIMENSION),
            ("nan m", Length::DIMENSION),
            ("1e999 m", Length::DIMENSION),
        ] {
            assert!(parse(text, wanted).is_err(), "{text} was taken");
        }
    }
}
