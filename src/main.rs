//! The `ferrom` command.

fn main() -> std::process::ExitCode {
    ferrom::cli::main()
}
