//! Random pencils with known spectra.
