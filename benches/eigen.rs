//! Modal analysis of K and M from MatrixMarket files, timed.
//!
//! `cargo bench --bench eigen -- K.mtx[.gz] M.mtx[.gz] [modes] [threads]` prints one JSON object:
//! wall and CPU seconds of the analysis (reading is not counted), peak memory of the process,
//! largest elastic residual, orthogonality, completeness, and the stages. `NXxNYxNZ -` instead of
//! files solves a generated lattice strip of 3-dof nodes; without arguments a small one.

use ferrom::linalg::SymSparse;
use ferrom::modal::{ModalOptions, solve_with_report};
use ferrom::model::{DofMap, FeModel, Silent};
use flate2::bufread::GzDecoder;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let number = |at: usize, default: usize| arguments.get(at).and_then(|a| a.parse().ok()).unwrap_or(default);
    let (stiffness, mass) = match arguments.as_slice() {
        [size, ..] if size.contains('x') && !size.contains('.') => {
            let n: Vec<usize> = size.split('x').map(str::parse).collect::<Result<_, _>>()?;
            strip(n[0], *n.get(1).unwrap_or(&6), *n.get(2).unwrap_or(&4))?
        }
        [k, m, ..] => (read(k)?, read(m)?),
        _ => strip(120, 6, 4)?,
    };
    let threads = number(3, 1);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let fe = FeModel {
        name: "bench".into(),
        nodes: BTreeMap::new(),
        dofs: DofMap::unlabelled(stiffness.order()),
        stiffness,
        mass,
        node_sets: BTreeMap::new(),
        sources: Vec::new(),
    };
    let before = (memory_mb(), cpu_s());
    let since = Instant::now();
    let options = ModalOptions { count: number(2, 56), shift: None };
    let (modes, report) = solve_with_report(&fe, &options, &Silent)?;
    let wall = since.elapsed().as_secs_f64();
    let cpu = cpu_s() - before.1;
    let worst = modes.residual[modes.rigid..].iter().fold(0.0f64, |a, b| a.max(*b));
    let result = serde_json::json!({
        "dofs": fe.dofs.len(), "modes": modes.len(), "rigid": modes.rigid, "threads": threads,
        "wall_s": wall, "cpu_s": cpu, "peak_mb": memory_mb(), "before_mb": before.0,
        "residual": worst, "residuals_above_1e-9": modes.residual[modes.rigid..].iter().filter(|r| **r > 1e-9).count(),
        "orthogonality": modes.orthogonality, "proved": modes.complete.proved, "shift": modes.shift,
        "first_elastic": modes.omega.get(modes.rigid), "last": modes.omega.last(),
        "warnings": modes.warnings, "stages": report.stages,
    });
    writeln!(std::io::stdout(), "{result}")?;
    Ok(())
}

/// MatrixMarket coordinate, one triangle.
fn read(path: &str) -> Result<SymSparse, Box<dyn Error>> {
    let file = BufReader::new(File::open(path)?);
    let reader: Box<dyn BufRead> =
        if path.ends_with(".gz") { Box::new(BufReader::new(GzDecoder::new(file))) } else { Box::new(file) };
    let (mut order, mut entries) = (0, Vec::new());
    for line in reader.lines() {
        let line = line?;
        if line.starts_with('%') {
            continue;
        }
        let mut field = line.split_ascii_whitespace();
        let mut next = || field.next().ok_or("three fields expected");
        let (row, col): (usize, usize) = (next()?.parse()?, next()?.parse()?);
        if order == 0 {
            order = row;
            entries.reserve_exact(next()?.parse()?);
        } else {
            entries.push((row - 1, col - 1, fast_float2::parse(next()?)?));
        }
    }
    Ok(SymSparse::from_triplets(order, &entries)?)
}

/// nx×ny×nz nodes of three dofs; neighbours (diagonals included) joined by springs along their
/// line, which is a lattice solid; unit masses.
fn strip(nx: usize, ny: usize, nz: usize) -> Result<(SymSparse, SymSparse), Box<dyn Error>> {
    let node = |x: usize, y: usize, z: usize| (x * ny + y) * nz + z;
    let mut entries = Vec::new();
    for x in 0..nx {
        for y in 0..ny {
            for z in 0..nz {
                for step in 1..27i32 {
                    let d = [step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1];
                    if d <= [0, 0, 0] {
                        continue;
                    }
                    let at = [x as i32 + d[0], y as i32 + d[1], z as i32 + d[2]];
                    let inside = |a: i32, n: usize| a >= 0 && (a as usize) < n;
                    if !(inside(at[0], nx) && inside(at[1], ny) && inside(at[2], nz)) {
                        continue;
                    }
                    let (a, b) = (node(x, y, z), node(at[0] as usize, at[1] as usize, at[2] as usize));
                    let square = f64::from(d.iter().map(|v| v * v).sum::<i32>());
                    for i in 0..3 {
                        for j in 0..3 {
                            let k = 1e6 * f64::from(d[i] * d[j]) / square;
                            if i <= j {
                                entries.extend([(3 * a + i, 3 * a + j, k), (3 * b + i, 3 * b + j, k)]);
                            }
                            entries.push((3 * a.min(b) + i, 3 * a.max(b) + j, -k));
                        }
                    }
                }
            }
        }
    }
    let n = 3 * nx * ny * nz;
    Ok((SymSparse::from_triplets(n, &entries)?, SymSparse::identity(n)))
}

/// Peak resident memory, MB (Linux; 0 elsewhere).
fn memory_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|l| l.starts_with("VmHWM:")).unwrap_or_default();
    line.split_whitespace().nth(1).and_then(|v| v.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// User and system CPU time of the process, s (Linux, 100 ticks a second; 0 elsewhere).
fn cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let field: Vec<f64> =
        stat.rsplit(')').next().unwrap_or("").split_whitespace().filter_map(|f| f.parse().ok()).collect();
    // After the name and the state letter: utime and stime are the 11th and 12th numbers.
    field.get(10).zip(field.get(11)).map_or(0.0, |(u, s)| (u + s) / 100.0)
}
