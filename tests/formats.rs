//! What other programs wrote is read as they meant it.
