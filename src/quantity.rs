//! Numbers with units: "166.55 N/deg" → 9542.6 N/rad, dimension checked. The only place where units convert.
