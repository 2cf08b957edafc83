//! Writing a file so that it is either the old one or the whole new one.

use super::error::FormatError;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicU32, Ordering};

static COUNTER: AtomicU32 = AtomicU32::new(0);

/// Writes to a temporary file in the same folder, flushes it to the disk and renames it into place.
/// Makes the parent folder. On an error nothing is left behind.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    let fail = |e| FormatError::writing(path, e);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(fail)?;
    let name = path.file_name().ok_or_else(|| fail(std::io::ErrorKind::InvalidInput.into()))?;
    // Unique between threads and between processes.
    let number = COUNTER.fetch_add(1, Ordering::Relaxed);
    let temporary = folder.join(format!(".{}.{}-{number}.part", name.to_string_lossy(), std::process::id()));
    let write = || {
        let mut file = File::create(&temporary)?;
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    };
    write().map_err(|e| {
        // The first error is the one worth telling.
        let _ = fs::remove_file(&temporary);
        fail(e)
    })
}
