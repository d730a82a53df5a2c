//! `model`: writes the hand as a model for other programs. Needs no hand.

use crate::cli::out::Out;
use crate::hand::kinematics::Side;
use crate::hand::model::{mjcf::mjcf, side_name, table, urdf::urdf};
use anyhow::Context as _;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ModelArgs {
    /// As URDF: RViz, Foxglove, Isaac, Pinocchio
    #[arg(long, required_unless_present = "mjcf")]
    pub(crate) urdf: bool,
    /// As MJCF: MuJoCo, with six position actuators
    #[arg(long)]
    pub(crate) mjcf: bool,
    /// Which hand
    #[arg(long, value_name = "left|right", default_value = "right", value_parser = crate::cli::parse::side)]
    pub(crate) side: Side,
    /// The folder that the files go to; it is made if it is not there
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Writes the model files.
pub(crate) fn run(out: &mut Out, args: &ModelArgs) -> anyhow::Result<()> {
    let side = side_name(args.side);
    let all = [
        (
            args.urdf,
            format!("ftp_{side}_hand.urdf"),
            urdf as fn(Side) -> String,
        ),
        (args.mjcf, format!("ftp_{side}_hand.xml"), mjcf),
        (true, format!("ftp_{side}_joints.csv"), table::csv),
    ];
    let folder = &args.out;
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let mut files = Vec::new();
    for (_, name, text) in all.into_iter().filter(|(wanted, ..)| *wanted) {
        let file = folder.join(name);
        std::fs::write(&file, text(args.side))
            .with_context(|| format!("cannot write {}", file.display()))?;
        files.push(file.display().to_string());
    }
    let lines = files.clone();
    out.result(
        args.json,
        &json!({ "model": { "side": side, "files": files } }),
        lines,
    )
}
