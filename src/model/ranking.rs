//! How important each mode is, and which ones are kept.

use super::ModeNo;
use serde::{Deserialize, Serialize};

/// The importance of one mode.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// The mode.
    pub mode: ModeNo,
    /// In the criterion's unit.
    pub score: f64,
    /// Relative to the largest.
    pub relative: f64,
}

/// Scores of all elastic modes for one transfer path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ranking {
    /// Name of the criterion: "peak-gain".
    pub criterion: String,
    /// Input, as "d:z".
    pub input: String,
    /// Output, as "d:z".
    pub output: String,
    /// Unit of the scores: "m/N".
    pub unit: String,
    /// Elastic modes, ascending.
    pub scores: Vec<Score>,
}

/// The kept modes and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Selection {
    /// Kept modes, ascending.
    pub modes: Vec<ModeNo>,
    /// The rule in words, with its threshold and what decided.
    pub reason: String,
    /// What the rule does not protect against: outranked discards, split clusters.
    pub warnings: Vec<String>,
}

impl Selection {
    /// "7-17", "7,8,10-13".
    pub fn ranges(&self) -> String {
        let mut text = String::new();
        let mut k = 0;
        while k < self.modes.len() {
            let mut end = k;
            while end + 1 < self.modes.len() && self.modes[end + 1].0 == self.modes[end].0 + 1 {
                end += 1;
            }
            if !text.is_empty() {
                text.push(',');
            }
            text += &self.modes[k].to_string();
            if end > k {
                text += &format!("-{}", self.modes[end]);
            }
            k = end + 1;
        }
        text
    }

    /// The modes named by "7-17" or "7,8,10-13"; an explanation when it is not such a list.
    pub fn parse_ranges(text: &str) -> Result<Vec<ModeNo>, String> {
        let number = |t: &str| {
            t.trim().parse::<u32>().ok().filter(|&n| n > 0).ok_or_else(|| {
                format!(
                    "mode list \"{text}\": found \"{}\", expected numbers from 1 such as 7-17 or 7,8,10-13",
                    t.trim()
                )
            })
        };
        let mut modes = Vec::new();
        for part in text.split(',') {
            let (first, last) = match part.split_once('-') {
                Some((a, b)) => (number(a)?, number(b)?),
                None => (number(part)?, number(part)?),
            };
            if last < first {
                return Err(format!("mode list \"{text}\": {first}-{last} runs backwards"));
            }
            if last > 1_000_000 {
                return Err(format!("mode list \"{text}\": {last} is no mode number"));
            }
            modes.extend((first..=last).map(ModeNo));
        }
        modes.sort_unstable();
        modes.dedup();
        Ok(modes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_round_trip() {
        for text in ["7-17", "7,8,10-13", "3"] {
            let modes = Selection::parse_ranges(text).expect("valid");
            let s = Selection { modes, reason: String::new(), warnings: vec![] };
            assert_eq!(s.ranges(), text.replace("7,8", "7-8"));
        }
        assert!(Selection::parse_ranges("7-x").is_err());
        assert!(Selection::parse_ranges("17-7").is_err());
        assert!(Selection::parse_ranges("0").is_err());
    }
}
