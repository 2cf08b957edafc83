//! Numbers as a person likes to read them: chosen digits, no false zeros, no "NaN".

/// What stands for a number that is not known.
pub const UNKNOWN: &str = "–";

/// `value` with `digits` significant digits: 107.071, 0.500, 1.97e-3; the digits before the point are
/// always all shown (12345.6 with 3 digits is 12346). Exactly 0 is "0", NaN is "–", infinity "∞".
pub fn significant(value: f64, digits: usize) -> String {
    if let Some(word) = special(value) {
        return word;
    }
    let behind = digits.clamp(1, 17) - 1;
    // Rounding may carry into another decade (9.996 → 10.00), so the exponent is read off the rounded text.
    let scientific = format!("{value:.behind$e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    match exponent {
        -1..=5 => format!("{value:.*}", (behind as i32 - exponent).max(0) as usize),
        _ => scientific,
    }
}

/// `value` with a fixed number of decimals, so that a column lines up at the point; a value that
/// would round to nothing keeps two digits ("3.1e-5") instead of claiming to be 0.
pub fn decimals(value: f64, places: usize) -> String {
    if let Some(word) = special(value) {
        return word;
    }
    let text = format!("{value:.places$}");
    let vanished = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    if vanished || value.abs() >= 1e12 { format!("{value:.1e}") } else { text }
}

/// A ratio as a signed percentage with the given decimals: 0.0123 → "+1.2 %".
pub fn percent(ratio: f64, places: usize) -> String {
    special(ratio).map_or_else(
        || {
            let text = format!("{:+.places$}", ratio * 100.0);
            let vanished = text.bytes().all(|b| matches!(b, b'+' | b'-' | b'0' | b'.'));
            format!("{} %", if vanished { &text[1..] } else { &text })
        },
        |word| if word == UNKNOWN { word } else { format!("{word} %") },
    )
}

/// A whole number, grouped in threes by thin spaces from five digits on: 8604, 48 236.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push('\u{2009}');
        }
        text.push(digit);
    }
    text
}

/// The unit a length or angle is read in, and the factor from SI to it: m → mm, rad → °; others as they are.
pub fn display_unit(si: &str) -> (f64, &str) {
    match si {
        "m" => (1e3, "mm"),
        "rad" => (180.0 / std::f64::consts::PI, "°"),
        other => (1.0, other),
    }
}

fn special(value: f64) -> Option<String> {
    let word = match value {
        v if v.is_nan() => UNKNOWN,
        f64::INFINITY => "∞",
        f64::NEG_INFINITY => "-∞",
        0.0 => "0",
        _ => return None,
    };
    Some(word.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_read_well_at_every_size() {
        let cases = [
            (107.070_790, 6, "107.071"),
            (1.97e-3, 3, "1.97e-3"),
            (0.054_6, 3, "5.46e-2"),
            (0.5, 2, "0.50"),
            (-155.4, 4, "-155.4"),
            (9.996, 3, "10.0"),
            (99_999.6, 3, "100000"),
            (12_345.6, 3, "12346"),
            (2.5e6, 3, "2.50e6"),
            (0.0, 5, "0"),
            (-0.0, 5, "0"),
            (f64::NAN, 5, "–"),
            (f64::NEG_INFINITY, 5, "-∞"),
            (f64::MIN_POSITIVE, 2, "2.2e-308"),
            (f64::MAX, 3, "1.80e308"),
        ];
        for (value, digits, text) in cases {
            assert_eq!(significant(value, digits), text);
        }
    }

    #[test]
    fn decimals_never_turn_a_small_number_into_nothing() {
        assert_eq!(decimals(-153.456, 2), "-153.46");
        assert_eq!(decimals(3.1e-5, 2), "3.1e-5");
        assert_eq!(decimals(-3.1e-5, 2), "-3.1e-5");
        assert_eq!(decimals(0.0, 2), "0");
        assert_eq!(decimals(1e300, 2), "1.0e300");
    }

    #[test]
    fn percentages_carry_their_sign() {
        assert_eq!(percent(-0.0123, 1), "-1.2 %");
        assert_eq!(percent(0.058, 1), "+5.8 %");
        assert_eq!(percent(1e-9, 1), "0.0 %");
        assert_eq!(percent(f64::NAN, 1), "–");
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(count(8604), "8604");
        assert_eq!(count(1_234_567), "1\u{2009}234\u{2009}567");
    }
}
