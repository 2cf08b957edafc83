//! Nouns to tables: modes, ranking, channels, turning points, energy, comparison with a reference.

use super::number::{self, display_unit, significant};
use super::table::{Cell, Column, Table};
use crate::model::{Channel, Energy, ModeNo, Modes, Ranking, Selection, Trajectory};
use std::f64::consts::TAU;

/// Below this a relative score is rounding noise: the mode is not excited or not seen, by symmetry.
pub const SCORE_NOISE: f64 = 1e-12;

/// One row per mode: number, ω, f, ζ, residual, origin, whether kept, and effective mass along x, y, z:
/// in per cent of `mass` (kg, the whole body), or in kg when `mass` is not known. The effective
/// masses are left out for a free body, where the rigid modes carry all of it.
pub fn modes_table(modes: &Modes, kept: &[ModeNo], mass: Option<f64>) -> Table {
    let effective = |k: usize, d: usize| modes.participation.get((k, d)).map_or(f64::NAN, |g| g * g);
    let carried = |from: usize, to: usize| (from..to).flat_map(|k| (0..3).map(move |d| (k, d)));
    let largest = |from, to| carried(from, to).map(|(k, d)| effective(k, d)).fold(0.0, f64::max);
    let (rigid, elastic) = (largest(0, modes.rigid), largest(modes.rigid, modes.len()));
    let show_mass = elastic > 1e-6 * rigid;

    let mut columns = vec![
        Column::number("mode", ""),
        Column::number("ω", "rad/s"),
        Column::number("f", "Hz"),
        Column::number("ζ", ""),
        Column::number("residual", ""),
        Column::text("origin"),
        Column::mark("kept"),
    ];
    if show_mass {
        let unit = if mass.is_some() { "%" } else { "kg" };
        columns.extend(["m_x", "m_y", "m_z"].map(|name| Column::number(name, unit)));
    }
    let mut table = Table::new("Modes", columns);
    let at = |values: &[f64], k: usize| values.get(k).copied().unwrap_or(f64::NAN);
    for k in 0..modes.len() {
        let number = ModeNo::from_column(k);
        let mut row = vec![
            Cell::from(u64::from(number.0)),
            Cell::decimals(modes.omega[k], 3),
            Cell::decimals(modes.omega[k] / TAU, 3),
            Cell::decimals(at(&modes.zeta, k), 4),
            Cell::significant(at(&modes.residual, k), 2),
            modes.origin.get(k).map_or("", |o| o.name()).into(),
            Cell::mark(kept.contains(&number)),
        ];
        if show_mass {
            let share = mass.map_or(1.0, |m| 100.0 / m);
            row.extend((0..3).map(|d| Cell::decimals(effective(k, d) * share, 2)));
        }
        table.rows.push(row);
    }
    if show_mass {
        table.notes.push("m_x m_y m_z: modal effective mass.".into());
    }
    if modes.zeta.iter().skip(modes.rigid).any(|z| z.is_nan()) {
        table.notes.push("ζ –: damping has not been stated.".into());
    }
    table.notes.push(completeness(modes));
    table.notes.extend(modes.warnings.iter().map(|w| format!("warning: {w}")));
    table
}

fn completeness(modes: &Modes) -> String {
    let below = significant(modes.complete.below, 6);
    if modes.complete.proved {
        format!(
            "Complete: {} below {below} rad/s, proved by the inertia of K − μM.",
            plural(modes.complete.count, "mode")
        )
    } else {
        format!("Not proved complete: a mode below {below} rad/s may be missing.")
    }
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// One row per elastic mode: score, score relative to the largest, whether kept; then the reason.
pub fn ranking_table(ranking: &Ranking, selection: &Selection) -> Table {
    let title = format!("Ranking by {}, {} → {}", ranking.criterion, ranking.input, ranking.output);
    let columns = vec![
        Column::number("mode", ""),
        Column::number("score", &ranking.unit),
        Column::number("relative", ""),
        Column::mark("kept"),
    ];
    let mut table = Table::new(&title, columns);
    let mut silent = false;
    for s in &ranking.scores {
        let nothing = s.relative.abs() < SCORE_NOISE;
        silent |= nothing;
        let shown = |value: f64| Cell::significant(if nothing { 0.0 } else { value }, 3);
        let number = Cell::from(u64::from(s.mode.0));
        table.rows.push(vec![number, shown(s.score), shown(s.relative), Cell::mark(selection.modes.contains(&s.mode))]);
    }
    table.notes.push(format!(
        "Kept: {} ({}). {}",
        selection.ranges(),
        plural(selection.modes.len(), "mode"),
        selection.reason
    ));
    if silent {
        table
            .notes
            .push(format!("Score 0: below {SCORE_NOISE:e} of the largest; by symmetry the mode does not take part."));
    }
    table.notes.extend(selection.warnings.iter().map(|w| format!("warning: {w}")));
    table
}

/// One row per channel: value at rest, least and largest value with their times. Lengths in mm.
pub fn channels_table(trajectory: &Trajectory) -> Table {
    let columns = vec![
        Column::text("channel"),
        Column::text("unit"),
        Column::number("at rest", ""),
        Column::number("least", ""),
        Column::number("at", "s"),
        Column::number("largest", ""),
        Column::number("at", "s"),
        Column::text("zero is"),
    ];
    let mut table = Table::new(&format!("Channels of {}", trajectory.scene), columns);
    for c in &trajectory.channels {
        let (factor, unit) = display_unit(&c.unit);
        let [a, b] = c.range;
        let (low, high) = if a.value <= b.value { (a, b) } else { (b, a) };
        table.rows.push(vec![
            c.name.as_str().into(),
            unit.into(),
            Cell::significant(c.at_rest.unwrap_or(f64::NAN) * factor, 5),
            Cell::significant(low.value * factor, 5),
            Cell::decimals(low.t, 4),
            Cell::significant(high.value * factor, 5),
            Cell::decimals(high.t, 4),
            c.datum.as_str().into(),
        ]);
    }
    table.notes.extend(trajectory.warnings.iter().map(|w| format!("warning: {w}")));
    table
}

/// The first `count` turning points of a channel, one row each. Lengths in mm.
pub fn turning_points_table(channel: &Channel, count: usize) -> Table {
    let (factor, unit) = display_unit(&channel.unit);
    let columns = vec![Column::number("#", ""), Column::number("t", "s"), Column::number(&channel.name, unit)];
    let mut table = Table::new(&format!("Turning points of {}", channel.name), columns);
    for (k, e) in channel.extremes.iter().take(count).enumerate() {
        table.rows.push(vec![Cell::from(k as u64 + 1), Cell::decimals(e.t, 4), Cell::decimals(e.value * factor, 2)]);
    }
    table.notes.push(format!("Zero is: {}.", channel.datum));
    table
}

/// Where the energy of a run came from and went to, J and per cent of what came in.
pub fn energy_table(energy: &Energy) -> Table {
    let positive_work: f64 = energy.input.iter().map(|i| i.1.max(0.0)).sum();
    let given = energy.initial + positive_work;
    let columns = vec![Column::text("energy"), Column::number("amount", "J"), Column::number("share", "%")];
    let mut table = Table::new("Energy balance", columns);
    let mut row = |name: String, value: f64| {
        let share = if given > 0.0 { value / given * 100.0 } else { f64::NAN };
        table.rows.push(vec![name.into(), Cell::decimals(value, 3), Cell::decimals(share, 2)]);
    };
    row("at the start".into(), energy.initial);
    energy.input.iter().for_each(|(name, v)| row(format!("work of {name}"), *v));
    energy.stored.iter().for_each(|(name, v)| row(format!("stored: {name}"), *v));
    energy.dissipated.iter().for_each(|(name, v)| row(format!("dissipated: {name}"), *v));
    table.notes.push(format!(
        "Largest imbalance over the run: {} J, {} of the energy put in.",
        significant(energy.error, 2),
        significant(energy.relative_error, 2)
    ));
    table
}

/// A number beside the one it is compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// What it is: "ω7", "2nd extreme".
    pub name: String,
    /// Unit of all numbers of this row.
    pub unit: String,
    /// Ours.
    pub ours: f64,
    /// What it is measured against.
    pub reference: f64,
    /// What somebody else got for the same, measured against the same reference.
    pub other: Option<f64>,
}

/// Ours beside a reference with the relative error, and beside what another got, with its error.
///
/// `reference` and `other` head the columns: "drop test", "paper". The column of `other` is left out
/// when no row has one; the column of units when all rows share one.
pub fn comparison_table(title: &str, reference: &str, other: &str, rows: &[Compared]) -> Table {
    let common = rows.first().map(|r| r.unit.as_str()).filter(|u| rows.iter().all(|r| r.unit == *u));
    let unit = common.unwrap_or("");
    let has_other = rows.iter().any(|r| r.other.is_some());
    let mut columns = vec![Column::text("")];
    if common.is_none() && !rows.is_empty() {
        columns.push(Column::text("unit"));
    }
    columns.push(Column::number(reference, unit));
    columns.extend([Column::number("ferrom", unit), Column::number("error", "")]);
    if has_other {
        columns.extend([Column::number(other, unit), Column::number("error", "")]);
    }
    let mut table = Table::new(title, columns);
    let places = common.and_then(|_| common_places(rows));
    for r in rows {
        let digits = |value: f64| match places {
            Some(places) => Cell::decimals(value, places),
            None => Cell::significant(value, 5),
        };
        let mut row = vec![r.name.as_str().into()];
        if common.is_none() {
            row.push(r.unit.as_str().into());
        }
        row.extend([digits(r.reference), digits(r.ours), relative_error(r.ours, r.reference)]);
        if let Some(value) = r.other {
            row.extend([digits(value), relative_error(value, r.reference)]);
        }
        table.rows.push(row);
    }
    if let Some(worst) =
        rows.iter().map(|r| (r.ours / r.reference - 1.0).abs()).filter(|e| e.is_finite()).reduce(f64::max)
    {
        table.notes.push(format!("Worst error {}.", number::percent(worst, 1).trim_start_matches('+')));
    }
    table
}

/// Decimals that show the largest number with five digits and the smallest with three; `None` where
/// the sizes are too far apart for one number of decimals.
fn common_places(rows: &[Compared]) -> Option<usize> {
    let sizes = rows.iter().flat_map(|r| [r.ours, r.reference]).map(f64::abs).filter(|v| *v > 0.0 && v.is_finite());
    let (least, largest) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let power = |v: f64| v.log10().floor() as i32;
    if largest == 0.0 || power(largest) - power(least) > 4 || !(-2..=7).contains(&power(largest)) {
        return None;
    }
    Some((4 - power(largest)).max(2 - power(least)).max(0) as usize)
}

/// Per cent, or a power of ten when that would read 0.0 %; unknown against a reference of 0.
fn relative_error(value: f64, reference: f64) -> Cell {
    let ratio = value / reference - 1.0;
    if !ratio.is_finite() {
        return Cell::from(number::UNKNOWN);
    }
    if ratio != 0.0 && ratio.abs() < 5e-4 { Cell::significant(ratio, 2) } else { Cell::percent(ratio) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Completeness, DofMap, Extreme, Origin, Score, Stats};
    use nalgebra::DMatrix;

    fn modes(participation: f64) -> Modes {
        Modes {
            omega: vec![0.0, 107.070_790],
            zeta: vec![f64::NAN, 0.03],
            shapes: DMatrix::zeros(1, 2),
            participation: DMatrix::from_row_slice(2, 3, &[0.0, 0.0, 0.0, 0.0, 0.0, participation]),
            dofs: DofMap::unlabelled(1),
            origin: vec![Origin::Rigid, Origin::Computed],
            rigid: 1,
            residual: vec![1e-14, 2.34e-12],
            orthogonality: 0.0,
            shift: -1.0,
            complete: Completeness { proved: true, count: 2, below: 200.0 },
            warnings: vec!["beware".into()],
        }
    }

    #[test]
    fn modes_show_effective_mass_only_where_it_says_something() {
        let clamped = modes_table(&modes(1.0), &[ModeNo(2)], Some(4.0));
        assert_eq!(clamped.columns.len(), 10);
        assert_eq!(clamped.rows[1].last().map(|c| c.0.as_str()), Some("25.00"));
        let free = modes_table(&modes(0.0), &[ModeNo(2)], None);
        assert_eq!(free.columns.len(), 7);
        let text = free.text();
        assert!(text.contains("107.071") && text.contains("17.041") && text.contains("warning: beware"), "{text}");
        assert!(!text.contains("not been stated"), "rigid modes need no damping");
    }

    #[test]
    fn ranking_calls_rounding_noise_zero() {
        let score = |n, relative| Score { mode: ModeNo(n), score: relative * 7e-4, relative };
        let ranking = Ranking {
            criterion: "peak-gain".into(),
            input: "d:z".into(),
            output: "d:z".into(),
            unit: "m/N".into(),
            scores: vec![score(7, 1.0), score(8, 5.46e-2), score(9, 1e-20)],
        };
        let selection = Selection { modes: vec![ModeNo(7)], reason: "because".into(), warnings: vec![] };
        let table = ranking_table(&ranking, &selection);
        assert_eq!(table.rows[2][2].0, "0");
        assert_eq!(table.rows[1][2].0, "5.46e-2");
        assert!(table.text().contains("Kept: 7 (1 mode). because"));
    }

    #[test]
    fn channels_are_read_in_millimetres() {
        let e = |t, value| Extreme { t, value };
        let channel = Channel {
            name: "pin".into(),
            unit: "m".into(),
            datum: "static equilibrium".into(),
            values: vec![],
            at_rest: Some(-0.05359),
            extremes: vec![e(0.1166, -0.15346), e(0.4142, 0.1274)],
            range: [e(0.4142, 0.1274), e(0.1166, -0.15346)],
        };
        let turns = turning_points_table(&channel, 5);
        assert_eq!(turns.rows[1][2].0, "127.40");
        let trajectory = Trajectory {
            scene: "drop".into(),
            time: vec![],
            channels: vec![channel],
            energy: None,
            effects: vec![],
            stats: Stats::default(),
            warnings: vec![],
        };
        let row = &channels_table(&trajectory).rows[0];
        let cells: Vec<&str> = row.iter().map(|c| c.0.as_str()).collect();
        assert_eq!(cells, ["pin", "mm", "-53.590", "-153.46", "0.1166", "127.40", "0.4142", "static equilibrium"]);
    }

    #[test]
    fn energy_adds_up_to_a_hundred() {
        let part = |name: &str, v| (name.to_owned(), v);
        let energy = Energy {
            initial: 450.0,
            input: vec![part("gravity", 50.0)],
            stored: vec![part("strain", 26.0)],
            dissipated: vec![part("tyre", 474.0)],
            error: 1e-6,
            relative_error: 2e-9,
        };
        let shares: Vec<String> = energy_table(&energy).rows.iter().map(|r| r[2].0.clone()).collect();
        assert_eq!(shares, ["90.00", "10.00", "5.20", "94.80"]);
    }

    #[test]
    fn comparison_states_both_errors() {
        let row = |ours, reference, other| Compared { name: "1".into(), unit: "mm".into(), ours, reference, other };
        let table = comparison_table("Table 6", "drop test", "paper", &[row(-153.46, -155.4, Some(-141.9))]);
        let cells: Vec<&str> = table.rows[0].iter().map(|c| c.0.as_str()).collect();
        assert_eq!(cells, ["1", "-155.40", "-153.46", "-1.2 %", "-141.90", "-8.7 %"]);
        assert_eq!(table.notes, ["Worst error 1.2 %."]);
        let alone = comparison_table("t", "ref", "", &[row(1.0, 0.0, None)]);
        assert_eq!(alone.rows[0].last().map(|c| c.0.as_str()), Some("–"));
        assert!(comparison_table("t", "ref", "", &[]).rows.is_empty());
    }
}
