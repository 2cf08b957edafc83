//! K φ = ω² M φ: the lowest modes of a model.

use super::digits::{digits, noise, rounding};
use super::pairs::{Pairs, Start, compute};
use super::rigid::{FREE, RigidMotions, rigid_motions};
use super::trust::{CLUSTER, complete, orthonormalise, products, refine};
use super::{ModalError, SolveReport, shift};
use crate::model::{Axis, FeModel, Modes, Origin, Progress};
use nalgebra::DMatrix;
use std::time::Instant;

/// Pairs computed beyond those asked for, so that the gap above the last one is known.
const EXTRA: usize = 2;

/// Energy of a free motion at most, in first elastic ω²: node positions of six digits leave 1e-6
/// and less, a real support is seldom a thousand times softer than the body.
const NOTHING: f64 = 1e-3;

/// Share of the first elastic ω² that hundredfold rounding noise may reach before it is told: a
/// standard deviation of one per cent.
const NOISY: f64 = 1.0;

/// What is asked of a modal analysis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalOptions {
    /// Modes wanted, rigid ones included; fewer are returned when the model has fewer, a few more
    /// when the last would split a cluster of equal frequencies.
    pub count: usize,
    /// σ, (rad/s)², negative; found from the model when absent.
    pub shift: Option<f64>,
}

impl Default for ModalOptions {
    fn default() -> Self {
        Self { count: 50, shift: None }
    }
}

/// The lowest modes of K φ = ω² M φ; see [`solve_with_report`].
///
/// # Errors
/// [`ModalError`].
pub fn solve(fe: &FeModel, options: &ModalOptions, progress: &dyn Progress) -> Result<Modes, ModalError> {
    solve_with_report(fe, options, progress).map(|r| r.0)
}

/// The lowest modes and what they cost: shift-invert block Lanczos (Grimes, Lewis & Simon 1994),
/// eigenvalues by Rayleigh quotients in twice the working precision, completeness by the inertia
/// of K − μM (Sylvester).
///
/// Rigid modes have ω = 0. Where node positions are known their shapes are exact translations and
/// rotations about the principal axes through the centre of mass, and the elastic shapes are made
/// M-orthogonal to them. Rounding of the entries of K couples the two; `residual` then leaves out
/// that part, i.e. it is measured with (I − MRRᵀ)(Kφ − ω²Mφ), and a warning tells when it matters.
/// ζ is NaN.
///
/// # Errors
/// [`ModalError`]: sizes that differ, no mass, an indefinite matrix, null vectors common to K and M.
pub fn solve_with_report(
    fe: &FeModel,
    options: &ModalOptions,
    progress: &dyn Progress,
) -> Result<(Modes, SolveReport), ModalError> {
    check(fe, options)?;
    let n = fe.dofs.len();
    let mut report = SolveReport { digits: digits(&fe.stiffness), ..SolveReport::default() };
    let relative = rounding(report.digits);
    let since = Instant::now();
    let motions = rigid_motions(fe, relative);
    let free = motions.as_ref().map_or(0, |r| (0..r.energy.len()).filter(|&c| is_free(r, c)).count());
    let guess = shift::estimate(fe, motions.as_ref(), free);
    let rigid_below = match &motions {
        Some(r) => FREE * r.noise.iter().fold(0.0f64, |a, b| a.max(*b)),
        None => {
            let even = 1.0 / fe.mass.values().iter().sum::<f64>().abs().max(f64::MIN_POSITIVE).sqrt();
            FREE * noise(&fe.stiffness, &vec![even; n], relative)
        }
    };
    report.add("rigid motions", since, 0, format!("{free} free, first elastic ω² about {guess:.3e}"));
    // Fewer than the rigid modes would cut through a root that is repeated by nature, and the first
    // elastic one is what tells it from them.
    let options = &ModalOptions { count: options.count.max(free), ..*options };
    let start = Start {
        shift: options.shift.unwrap_or(-guess),
        wanted: options.count.min(n),
        seen: EXTRA.min(n - options.count.min(n)),
        rigid_below,
    };
    let mut pairs = compute(fe, &start, progress, &mut report)?;
    if pairs.lambda.is_empty() {
        return Err(ModalError::NoMass);
    }
    let mut warnings = std::mem::take(&mut pairs.warnings);
    let rigid_below = noise_of_lowest(fe, &pairs, relative);
    let rigid = rigid_count(&pairs.lambda, rigid_below);
    negative(&pairs, rigid, rigid_below)?;

    let since = Instant::now();
    progress.report("refinement", 0, 0);
    let refined = refine(fe, &mut pairs, rigid);
    report.add("refinement", since, 0, format!("{refined} modes refined"));

    let since = Instant::now();
    progress.report("completeness", 0, 0);
    pairs.factor = None;
    let count = whole_clusters(&pairs, options.count, rigid, &mut warnings);
    let (proof, notes) = complete(fe, &pairs, count);
    warnings.extend(notes);
    report.add("completeness", since, 0, format!("{} below {:.6e} rad/s", proof.count, proof.below));

    let since = Instant::now();
    let shift = pairs.shift;
    // With the elastic ω² known, a motion is free when its energy is nothing beside them, even if
    // rounded node positions put it above the noise of the entries.
    let first = pairs.lambda.get(rigid).copied().unwrap_or(f64::INFINITY);
    if first.is_finite() && rigid_below > first.abs() * NOISY {
        warnings.push(format!(
            "the stiffness entries carry {} digits: their rounding may move ω² by about {:.1e} (rad/s)², and the lowest found is {:.1e}; frequencies of that size are not to be trusted",
            report.digits,
            rigid_below / FREE,
            first
        ));
    }
    let geometric = motions.filter(|r| {
        let free = (0..r.energy.len()).filter(|&c| is_free(r, c) || r.energy[c].abs() <= NOTHING * first).count();
        if free != rigid {
            warnings.push(format!(
                "the mesh has {free} free rigid motions, the eigenvalues show {rigid}; rigid shapes are taken from the eigenvectors"
            ));
        }
        free == rigid && rigid > 0
    });
    let modes = finish(fe, pairs, Parts { rigid, count, geometric, proof, warnings, digits: report.digits, shift });
    report.add("shapes", since, modes.shapes.len() * 8, String::new());
    Ok((modes, report))
}

fn check(fe: &FeModel, options: &ModalOptions) -> Result<(), ModalError> {
    let (stiffness, mass, dofs) = (fe.stiffness.order(), fe.mass.order(), fe.dofs.len());
    if stiffness != mass || stiffness != dofs {
        return Err(ModalError::OrderMismatch { stiffness, mass, dofs });
    }
    if dofs == 0 {
        return Err(ModalError::Empty);
    }
    if options.count == 0 {
        return Err(ModalError::NoneAsked);
    }
    if let Some(shift) = options.shift.filter(|s| !(s.is_finite() && *s < 0.0)) {
        return Err(ModalError::BadShift(shift));
    }
    let (k, m) = (fe.stiffness.diagonal(), fe.mass.diagonal());
    if m.iter().all(|&v| v == 0.0) {
        return Err(ModalError::NoMass);
    }
    if let Some(motions) = crate::model::rigid_motions(fe) {
        // A mass matrix moves with every translation; a stiffness matrix given in its place does not.
        let heavy = fe.mass.mul_block(&motions);
        let moved = (0..3).map(|d| motions.column(d).dot(&heavy.column(d))).fold(0.0, f64::max);
        if moved <= 1e-9 * fe.mass.trace() {
            return Err(ModalError::Exchanged);
        }
    }
    for j in 0..dofs {
        if m[j] < 0.0 {
            return Err(ModalError::IndefiniteMass { dof: fe.dofs.describe(j) });
        }
        if k[j] == 0.0 && m[j] == 0.0 {
            return Err(ModalError::CommonNull { dof: fe.dofs.describe(j) });
        }
        // A 2×2 minor below zero by more than the rounding of six-digit entries: not semidefinite.
        for (i, v) in fe.mass.column(j) {
            if i != j && v * v > m[i] * m[j] * (1.0 + 1e-5) {
                return Err(ModalError::IndefiniteMass { dof: fe.dofs.describe(j) });
            }
        }
    }
    Ok(())
}

fn is_free(r: &RigidMotions, c: usize) -> bool {
    r.energy[c].abs() <= FREE * r.noise[c]
}

/// What rounding of the entries of K may make of the ω² of the lowest shapes, with the margin
/// `FREE`: the largest over the shapes whose ω² is not far above it.
fn noise_of_lowest(fe: &FeModel, pairs: &Pairs, relative: f64) -> f64 {
    let mut below = 0.0f64;
    for (c, lambda) in pairs.lambda.iter().enumerate() {
        let own = FREE * noise(&fe.stiffness, pairs.vectors.column(c).as_slice(), relative);
        if lambda.abs() > 1e3 * own.max(below) {
            break;
        }
        below = below.max(own);
    }
    below
}

/// Leading eigenvalues that are zero in the digits given: within the noise, and a tenth of the
/// next one at most; where several places would do, the widest gap decides.
fn rigid_count(lambda: &[f64], below: f64) -> usize {
    let mut best = (0, 10.0);
    // An eigenvalue that happens to be 0 to the bit is no wider gap than rounding beside the others.
    let rounding = (1e-14 * lambda.last().map_or(0.0, |l| l.abs())).max(1e-3 * below).max(f64::MIN_POSITIVE);
    let mut largest = 0.0f64;
    for (s, pair) in lambda.windows(2).enumerate() {
        largest = largest.max(pair[0].abs());
        let ratio = pair[1] / largest.max(rounding);
        if largest <= below.max(1e-9 * pair[1]) && ratio > best.1 {
            best = (s + 1, ratio);
        }
    }
    // A model with nothing but rigid modes has no next one.
    if best.0 == 0 && lambda.iter().all(|l| l.abs() <= below) { lambda.len() } else { best.0 }
}

fn negative(pairs: &Pairs, rigid: usize, below: f64) -> Result<(), ModalError> {
    let count = pairs.lambda[rigid..].iter().filter(|l| **l < -below).count();
    if count > 0 { Err(ModalError::NegativeStiffness { count, below: 0.0 }) } else { Ok(()) }
}

/// The number of modes to return: as asked, or up to the end of the cluster that would be split.
fn whole_clusters(pairs: &Pairs, asked: usize, rigid: usize, warnings: &mut Vec<String>) -> usize {
    let lambda = &pairs.lambda;
    let mut count = asked.min(lambda.len());
    while count < lambda.len() && count > 0 && {
        let within_rigid = count < rigid;
        within_rigid || lambda[count] - lambda[count - 1] <= CLUSTER * lambda[count].abs()
    } {
        count += 1;
    }
    if count > asked {
        warnings
            .push(format!("{count} modes are returned instead of {asked}, so that equal frequencies stay together"));
    } else if count < asked {
        warnings.push(format!("{asked} modes were asked for, the model has {count}"));
    }
    count
}

struct Parts {
    rigid: usize,
    count: usize,
    geometric: Option<RigidMotions>,
    proof: crate::model::Completeness,
    warnings: Vec<String>,
    digits: u32,
    shift: f64,
}

/// Relative error of the first elastic ω² by rounding of the file above which the user is told.
const TOLD: f64 = 1e-4;

/// Puts rigid and elastic shapes together and measures them.
fn finish(fe: &FeModel, pairs: Pairs, parts: Parts) -> Modes {
    let (rigid, count) = (parts.rigid.min(parts.count), parts.count);
    let (k, m) = (&fe.stiffness, &fe.mass);
    let mut warnings = parts.warnings;
    let mut shapes = pairs.vectors.columns(0, count).into_owned();
    let mut origin = vec![Origin::Computed; count];
    let mut projection = None;
    if let Some(motions) = &parts.geometric {
        let exact = motions.shapes.columns(0, rigid).into_owned();
        let heavy = m.mul_block(&exact);
        shapes.columns_mut(0, rigid).copy_from(&exact);
        origin[..rigid].fill(Origin::Rigid);
        let elastic = shapes.columns(rigid, count - rigid).into_owned();
        let overlap = heavy.transpose() * &elastic;
        shapes.columns_mut(rigid, count - rigid).copy_from(&(elastic - &exact * &overlap));
        // What rounding of K moves the first elastic ω² by: the same sum as for the rigid ones.
        let moved = (rigid < count)
            .then(|| shapes.column(rigid).into_owned())
            .map_or(0.0, |phi| noise(k, phi.as_slice(), rounding(parts.digits)) / pairs.lambda[rigid]);
        if moved > TOLD {
            warnings.push(format!(
                "the stiffness file carries {} digits, too few for this structure: its rounding moves the first elastic ω² by about {moved:.0e} of itself; export with more digits",
                parts.digits
            ));
        }
        projection = Some((exact, heavy));
    }
    let orthogonality = orthonormalise(m, &mut shapes);
    let (stiff, heavy) = products(k, m, &shapes);
    let mut omega = vec![0.0; count];
    let mut residual = vec![0.0; count];
    let first = (rigid < count).then(|| shapes.column(rigid).dot(&stiff.column(rigid)));
    for c in 0..count {
        if c < rigid {
            let against = first.unwrap_or(parts.shift.abs()) * heavy.column(c).norm();
            residual[c] = stiff.column(c).norm() / against;
            continue;
        }
        let lambda = shapes.column(c).dot(&stiff.column(c)) / shapes.column(c).dot(&heavy.column(c));
        omega[c] = lambda.max(0.0).sqrt();
        let mut r = stiff.column(c) - heavy.column(c) * lambda;
        if let Some((exact, heavy_exact)) = &projection {
            let part = exact.transpose() * &r;
            r -= heavy_exact * part;
        }
        residual[c] = r.norm() / stiff.column(c).norm();
    }
    signs(&mut shapes);
    let participation = participation(fe, &shapes);
    Modes {
        omega,
        zeta: vec![f64::NAN; count],
        shapes,
        participation,
        dofs: fe.dofs.clone(),
        origin,
        rigid,
        residual,
        orthogonality,
        shift: parts.shift,
        complete: parts.proof,
        warnings,
    }
}

/// Largest component positive; of components equal to rounding, the first decides.
fn signs(shapes: &mut DMatrix<f64>) {
    for mut column in shapes.column_iter_mut() {
        let largest = column.amax();
        let first = column.iter().copied().find(|v| v.abs() >= largest * (1.0 - 1e-6));
        if first.is_some_and(|v| v < 0.0) {
            column.neg_mut();
        }
    }
}

/// Γ = Φᵀ M r for unit translations r; zero without labels.
fn participation(fe: &FeModel, shapes: &DMatrix<f64>) -> DMatrix<f64> {
    let labels = fe.dofs.labels();
    if labels.is_empty() {
        return DMatrix::zeros(shapes.ncols(), 3);
    }
    let unit = DMatrix::from_fn(labels.len(), 3, |i, d| f64::from(u8::from(labels[i].axis == Axis::ALL[d])));
    shapes.transpose() * fe.mass.mul_block(&unit)
}
