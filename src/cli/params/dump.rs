//! `params dump`: all parameters, printed and written to a file. Only reads.

use crate::cli::out::Out;
use crate::cli::params::args::DumpArgs;
use crate::cli::params::reach::{read_rows, say_troubles};
use crate::cli::params::words::table;
use crate::cli::session;
use crate::params::rows::ParamId;
use crate::store::calendar::since_1970;
use anyhow::Context as _;
use serde_json::json;

/// Reads and prints. Fails if a row could not be read.
pub(crate) fn run(out: &mut Out, args: &DumpArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let files = common.backups()?;
    let (params, troubles) = session::runtime()?.block_on(read_rows(&common.hand))?;
    let file = files.file(&params, "dump", since_1970());
    if let Some(path) = &args.out {
        std::fs::write(path, file.to_toml())
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    if common.json {
        out.object(&json!({ "hand": file.hand, "at": file.at, "params": params }))?;
    } else {
        let rows = ParamId::all().into_iter();
        let rows = rows.map(|id| (id, [params.get(id), id.factory()]));
        out.lines(table(["holds", "factory"], rows))?;
    }
    say_troubles(&troubles, true)
}
