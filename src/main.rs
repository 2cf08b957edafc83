//! The `ferrom` command.

fn main() {}
