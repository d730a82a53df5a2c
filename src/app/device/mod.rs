//! What a person sees and does about what a hand keeps: values read back, values staged, verdicts, SAVE, files. Draws nothing.
//!
//! [`book`] is what is shown, [`wish`] what may be asked, [`compared`] a file beside the hand. The rules of what is read and written
//! when are in `work`, the files in `keeper`; both run for the program.

pub mod book;
pub mod compared;
pub(crate) mod keeper;
pub mod refusal;
#[cfg(test)]
mod tests;
pub mod wish;
pub(crate) mod work;
