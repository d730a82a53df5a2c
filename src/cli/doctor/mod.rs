//! `doctor`: what is wrong with a hand and the way to it, and what to do. Reads only.

mod checkup;
mod findings;
mod json;
mod measure;
mod text;

use crate::cli::args::DoctorArgs;
use crate::cli::out::Out;
use crate::cli::session;
use anyhow::bail;

/// Looks, tells, and fails if something is wrong.
pub(crate) fn run(out: &mut Out, args: &DoctorArgs) -> anyhow::Result<()> {
    let checkup = session::runtime()?.block_on(measure::check(args))?;
    let found = findings::judge(&checkup);
    if args.json {
        out.line(&json::object(&checkup, &found).to_string())?;
    } else {
        text::print(out, &checkup, &found)?;
    }
    match found.iter().filter(|finding| finding.is_wrong).count() {
        0 => Ok(()),
        1 => bail!("one thing is wrong with {}", args.hand),
        count => bail!("{count} things are wrong with {}", args.hand),
    }
}
