//! Universal dataset 55, data at nodes: normal modes (analysis type 2) and complex modes (type 3).

use super::error::Fault;
use super::uff::{Lines, number};
use crate::model::NodeId;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// A mode of a test.
#[derive(Clone, Debug, PartialEq)]
pub struct TestMode {
    /// Number in the file.
    pub number: i64,
    /// Undamped natural frequency, rad/s: 2πf of a normal mode, |λ| of a complex one.
    pub omega: f64,
    /// Damping ratio: viscous, or half the hysteretic where only that is given; −Re λ/|λ| of a complex
    /// mode. 0 when the file gives none.
    pub zeta: f64,
    /// Modal mass of a normal mode, modal A of a complex one, as the file gives it (0: not given).
    pub modal_mass: Complex<f64>,
    /// What the shape is: displacement, velocity, acceleration (8, 11, 12), others as numbered by SDRC.
    pub quantity: i64,
    /// True when the file holds complex numbers, be their imaginary parts zero or not.
    pub complex: bool,
    /// x y z, or x y z rx ry rz, per node in the order of the file; scaled as the test scaled it.
    pub shape: Vec<(NodeId, Vec<Complex<f64>>)>,
}

/// Reads one dataset behind its number.
pub(super) fn mode55(lines: &mut Lines) -> Result<TestMode, Fault> {
    // The five lines of free text may hold anything, even numbers.
    for _ in 0..5 {
        lines.raw().ok_or_else(|| lines.ended("the text lines of dataset 55"))?;
    }
    let head =
        lines.integers(6, 6, "model, analysis, data characteristic, specific type, data type, values per node")?;
    let &[_, analysis, characteristic, quantity, data_type, per_node] = head.as_slice() else {
        return Err(Fault::line(lines.line, "a short header"));
    };
    let refuse = |lines: &Lines, found: String, expected: &str, cure: &str| {
        Err(Fault::line(lines.line, found).expected(expected).cure(cure))
    };
    if !matches!(analysis, 2 | 3) {
        return refuse(
            lines,
            format!("analysis type {analysis}"),
            "2 (normal modes) or 3 (complex modes)",
            "export modes",
        );
    }
    let width = match (characteristic, per_node) {
        // Programs write 3 ("six components") and then three of them: the count decides.
        (2 | 3, 3) => 3,
        (3, 6) => 6,
        _ => {
            let found = format!("data characteristic {characteristic} with {per_node} values per node");
            return refuse(
                lines,
                found,
                "2 with 3 values (translations) or 3 with 6 (and rotations)",
                "export mode shapes",
            );
        }
    };
    let complex = match data_type {
        2 => false,
        5 => true,
        _ => return refuse(lines, format!("data type {data_type}"), "2 (real) or 5 (complex)", "export mode shapes"),
    };
    let what = "how many whole and real numbers follow";
    let line = lines.must(what)?;
    let (Some(wholes), Some(reals)) = (number(line, 0, 10), number(line, 10, 20)) else {
        return Err(lines.wrong(line, what));
    };
    if !(2..=100).contains(&wholes) || !(if analysis == 2 { 2..=100 } else { 6..=100 }).contains(&reals) {
        return Err(lines.wrong(line, "2 or more whole numbers and 4 (normal) or 6 (complex modes) real ones"));
    }
    // Eight whole numbers a line, the two counts included: load case, mode number, …
    let number = number(line, 30, 40).ok_or_else(|| lines.wrong(line, "a mode number in columns 31 to 40"))?;
    if wholes > 6 {
        lines.integers(wholes as usize - 6, 8, "more whole numbers")?;
    }
    let values = lines.reals(reals as usize, "frequency and modal mass, or complex eigenvalue and modal A, B")?;
    let at = |k: usize| values.get(k).copied().unwrap_or(0.0);
    let (omega, zeta, modal_mass) = if analysis == 2 {
        let (viscous, hysteretic) = (at(2), at(3));
        let zeta = if viscous == 0.0 { hysteretic / 2.0 } else { viscous };
        (at(0) * TAU, zeta, Complex::new(at(1), 0.0))
    } else {
        let size = at(0).hypot(at(1));
        (size, if size > 0.0 { -at(0) / size } else { 0.0 }, Complex::new(at(2), at(3)))
    };
    if omega < 0.0 {
        return Err(Fault::line(lines.line, format!("a frequency of {} Hz", at(0))).expected("0 or more"));
    }
    let mut shape = Vec::new();
    while let Some(line) = lines.data("the end of dataset 55")? {
        let node = super::uff::number(line, 0, 10).and_then(|n| u32::try_from(n).ok());
        let node = node.ok_or_else(|| lines.wrong(line, "a node number in columns 1 to 10"))?;
        let parts = lines.reals(if complex { 2 * width } else { width }, "the motion of a node")?;
        let motion = if complex {
            parts.chunks_exact(2).map(|p| Complex::new(p[0], p[1])).collect()
        } else {
            parts.into_iter().map(|v| Complex::new(v, 0.0)).collect()
        };
        shape.push((NodeId(node), motion));
    }
    if shape.is_empty() {
        return Err(Fault::line(lines.line, format!("mode {number} has no shape")).expected("motion at nodes"));
    }
    Ok(TestMode { number, omega, zeta, modal_mass, quantity, complex, shape })
}

/// Modes as universal datasets 55, type 2 (normal modes), displacements; six digits per number. A
/// complex shape is written as such. All nodes of a mode must have the same number of components.
pub fn uff55_to_text(modes: &[TestMode], title: &str) -> Result<String, Fault> {
    let mut text = String::new();
    for mode in modes {
        let width = mode.shape.first().map_or(0, |s| s.1.len());
        if !matches!(width, 3 | 6) || mode.shape.iter().any(|s| s.1.len() != width) {
            return Err(Fault::new(format!("mode {} has nodes of different kinds", mode.number))
                .expected("3 or 6 components at every node"));
        }
        let name: String = title.chars().filter(|c| c.is_ascii_graphic() || *c == ' ').take(70).collect();
        let name = if name.trim().is_empty() { "NONE".to_owned() } else { name };
        text += &format!("    -1\n    55\n{name}\nNONE\nNONE\nNONE\nNONE\n");
        let (characteristic, data_type) = (if width == 3 { 2 } else { 3 }, if mode.complex { 5 } else { 2 });
        text += &format!("{:>10}{:>10}{characteristic:>10}{:>10}{data_type:>10}{width:>10}\n", 1, 2, mode.quantity);
        text += &format!("{:>10}{:>10}{:>10}{:>10}\n", 2, 4, 1, mode.number);
        let header = [mode.omega / TAU, mode.modal_mass.re, mode.zeta, 0.0];
        text += &(header.iter().map(|&v| e13(v)).collect::<String>() + "\n");
        for (node, motion) in &mode.shape {
            text += &format!("{:>10}\n", node.0);
            let flat: Vec<f64> = if mode.complex {
                motion.iter().flat_map(|c| [c.re, c.im]).collect()
            } else {
                motion.iter().map(|c| c.re).collect()
            };
            for line in flat.chunks(6) {
                text += &(line.iter().map(|&v| e13(v)).collect::<String>() + "\n");
            }
        }
        text += "    -1\n";
    }
    Ok(text)
}

/// E13.5: six digits, a sign and two or three digits in the exponent.
fn e13(value: f64) -> String {
    let text = format!("{value:.5e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, size) = exponent.strip_prefix('-').map_or(('+', exponent), |size| ('-', size));
    format!("{:>13}", format!("{mantissa}E{sign}{size:0>2}"))
}
