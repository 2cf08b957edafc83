//! The allowed-uses table of lib.rs holds.
