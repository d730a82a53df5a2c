//! The program. Everything it does lives in the library.

use std::process::ExitCode;

/// The C library's allocator gives the meshes of each frame back to the system and maps them anew.
#[cfg(feature = "desktop")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    handscope::cli::run()
}
