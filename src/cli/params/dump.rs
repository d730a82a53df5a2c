//! `params dump`: all parameters, printed and written to a file. Reads only.

use crate::app::calendar::since_1970;
use crate::app::params::table::ParamId;
use crate::cli::out::{Out, Told, say};
use crate::cli::params::args::DumpArgs;
use crate::cli::params::show;
use crate::cli::params::talk::Talk;
use crate::cli::params::words::{or_dash, record};
use crate::cli::session;
use anyhow::Context as _;
use serde_json::json;

/// Reads and prints. Fails if a row could not be read.
pub(crate) fn run(out: &mut Out, args: &DumpArgs) -> anyhow::Result<()> {
    let common = &args.common;
    let record = record(common)?;
    let (params, troubles) = session::runtime()?.block_on(async {
        let mut talk = Talk::open(&common.hand).await?;
        talk.read().await
    })?;
    let file = record.file(&params, "dump", since_1970());
    if let Some(path) = &args.out {
        std::fs::write(path, file.to_toml())
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    if common.json {
        let params = show::params_json(&params);
        let object = json!({ "hand": file.hand, "at": file.at, "params": params });
        out.line(&object.to_string())?;
    } else {
        out.line(&show::head(&["holds", "factory"]))?;
        for id in ParamId::all() {
            let columns = [or_dash(params.get(id)), or_dash(id.factory())];
            out.line(&show::line(id, &columns))?;
        }
    }
    for trouble in &troubles {
        say(&format!("cannot read everything: {trouble}"));
    }
    match troubles.is_empty() {
        true => Ok(()),
        false => Err(Told.into()),
    }
}
