//! Numbers in text: the tight inner step of every reader, with Fortran's habits.

/// Index of the first byte at or after `at` that is neither blank nor tab.
#[inline(always)]
pub(super) fn skip_blanks(text: &[u8], mut at: usize) -> usize {
    while at < text.len() && (text[at] == b' ' || text[at] == b'\t') {
        at += 1;
    }
    at
}

/// A run of decimal digits at `at`: value and the index behind it; `None` without digits or beyond
/// 18 digits.
#[inline(always)]
pub(super) fn digits(text: &[u8], at: usize) -> Option<(u64, usize)> {
    let mut value = 0u64;
    let mut k = at;
    while k < text.len() && text[k].is_ascii_digit() {
        value = value.wrapping_mul(10).wrapping_add(u64::from(text[k] - b'0'));
        k += 1;
    }
    (k > at && k - at <= 18).then_some((value, k))
}

/// A real number at `at` and the index behind it. Reads `1.0E+03`, Fortran's `1.0D+03`, and
/// `1.0-103` (an exponent of three digits pushes out its letter). NaN and infinities are returned as such.
#[inline(always)]
pub(super) fn real(text: &[u8], at: usize) -> Option<(f64, usize)> {
    match fast_float2::parse_partial::<f64, _>(&text[at..]) {
        Ok((value, length)) => match text.get(at + length) {
            None | Some(b' ' | b'\n' | b'\r' | b'\t' | b',') => Some((value, at + length)),
            _ => fortran_real(text, at),
        },
        Err(_) => fortran_real(text, at),
    }
}

/// The same for a number whose exponent is written `D+03` or without a letter.
#[cold]
fn fortran_real(text: &[u8], at: usize) -> Option<(f64, usize)> {
    // 64 characters hold any number a program prints.
    let mut plain = [0u8; 65];
    let mut length = 0;
    let mut k = at;
    let mut in_exponent = false;
    while let Some(&byte) = text.get(k) {
        let put: &[u8] = match byte {
            b'0'..=b'9' | b'.' => &[byte],
            b'd' | b'D' | b'e' | b'E' if !in_exponent && k > at => {
                in_exponent = true;
                b"e"
            }
            b'+' | b'-' if k == at => &[byte],
            b'+' | b'-' if in_exponent && plain[length - 1] == b'e' => &[byte],
            b'+' | b'-' if !in_exponent && k > at => {
                in_exponent = true;
                if byte == b'+' { b"e+" } else { b"e-" }
            }
            _ => break,
        };
        if length + put.len() > 64 {
            return None;
        }
        plain[length..length + put.len()].copy_from_slice(put);
        length += put.len();
        k += 1;
    }
    fast_float2::parse::<f64, _>(&plain[..length]).ok().map(|value| (value, k))
}

/// The whole text as a real number.
pub(super) fn whole_real(text: &[u8]) -> Option<f64> {
    let text = text.trim_ascii();
    real(text, 0).filter(|&(_, end)| end == text.len()).map(|(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fortran_exponents_are_read() {
        let cases: [(&[u8], f64); 8] = [
            (b"1.0D+03", 1e3),
            (b"-2.5d-2", -2.5e-2),
            (b"1.5-103", 1.5e-103),
            (b"7.0+3", 7e3),
            (b".5", 0.5),
            (b"3.", 3.0),
            (b"-.2019E-27", -0.2019e-27),
            (b"+4.25e1", 42.5),
        ];
        for (text, value) in cases {
            assert_eq!(whole_real(text), Some(value), "{}", String::from_utf8_lossy(text));
        }
        for text in [&b""[..], b"-", b"1.0D", b"1.0E+", b"1.0+3+4", b"1,5", b"abc", b"1.0x"] {
            assert_eq!(whole_real(text), None, "{}", String::from_utf8_lossy(text));
        }
    }

    #[test]
    fn numbers_are_rounded_as_the_standard_library_rounds_them() {
        // A fixed walk through mantissas and exponents of every length.
        let mut seed = 1u64;
        for k in 0..200_000u64 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let mantissa = (seed >> (k % 64)) as i64;
            let exponent = (seed >> 20) % 60;
            let digits = (seed % 17) as usize;
            let value = mantissa as f64 * 10f64.powi(exponent as i32 - 30);
            for text in [format!("{value:.digits$e}"), format!("{value:.digits$}"), format!("{mantissa}")] {
                let expected: f64 = text.parse().expect("a number");
                assert_eq!(whole_real(text.as_bytes()).map(f64::to_bits), Some(expected.to_bits()), "{text}");
            }
        }
        assert_eq!(whole_real(b"-0.0").map(f64::to_bits), Some((-0.0f64).to_bits()));
    }

    #[test]
    fn digits_stop_before_they_overflow() {
        assert_eq!(digits(b"123 ", 0), Some((123, 3)));
        assert_eq!(digits(b"9999999999999999999", 0), None);
        assert_eq!(digits(b"-1", 0), None);
    }
}
