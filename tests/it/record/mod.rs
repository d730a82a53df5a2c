//! What is recorded: it survives the program's death, and files that were made to harm harm nobody.

#[cfg(target_os = "linux")]
mod hostile;
mod import;
#[cfg(unix)]
mod journal;
#[cfg(unix)]
mod kill;
