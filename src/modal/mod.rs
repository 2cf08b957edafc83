//! FE model to modes: eigen-solution, rigid modes, proof of completeness, damping.
