//! Reads and writes files: one file per format.
