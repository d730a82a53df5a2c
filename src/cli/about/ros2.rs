//! `ros2`: writes a workspace of ROS 2, with the messages of recordings and a launch file that shows the hand. Needs no hand.

use crate::cli::out::Out;
use crate::hand::kinematics::Side;
use crate::hand::model::{side_name, urdf::urdf};
use crate::record::file::format::topic::{Schema, Topic};
use crate::store;
use anyhow::Context as _;
use clap::Args;
use serde_json::json;
use std::io;
use std::path::{Path, PathBuf};

/// Package of the messages, as their names have it.
const MESSAGES: &str = "handscope_msgs";
/// Files that are the same each time, but for the version.
const FIXED: [(&str, &str); 5] = [
    ("README.md", include_str!("../../../assets/ros2/README.md")),
    (
        "src/handscope_msgs/package.xml",
        include_str!("../../../assets/ros2/handscope_msgs/package.xml"),
    ),
    (
        "src/handscope_bringup/package.xml",
        include_str!("../../../assets/ros2/handscope_bringup/package.xml"),
    ),
    (
        "src/handscope_bringup/CMakeLists.txt",
        include_str!("../../../assets/ros2/handscope_bringup/CMakeLists.txt"),
    ),
    (
        "src/handscope_bringup/launch/hand.launch.py",
        include_str!("../../../assets/ros2/handscope_bringup/launch/hand.launch.py"),
    ),
];
const RVIZ: &str = include_str!("../../../assets/ros2/handscope_bringup/rviz/hand.rviz");
const CMAKE: &str = include_str!("../../../assets/ros2/handscope_msgs/CMakeLists.txt");

#[derive(Debug, Args)]
pub(crate) struct Ros2Args {
    /// The folder that the workspace goes to, which must be new or empty
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}

/// Writes the workspace.
pub(crate) fn run(out: &mut Out, args: &Ros2Args) -> anyhow::Result<()> {
    let root = &args.out;
    store::create_empty_folder(root).with_context(|| {
        format!(
            "cannot make a workspace in {}; name a new or empty folder with --out",
            root.display()
        )
    })?;
    let mut files = Vec::new();
    for (name, text) in workspace() {
        let file = root.join(name);
        write(&file, &text).with_context(|| format!("cannot write {}", file.display()))?;
        files.push(file.display().to_string());
    }
    let lines = files.clone();
    out.result(args.json, &json!({ "ros2": { "files": files } }), lines)
}

/// All files, with their paths in the workspace.
fn workspace() -> Vec<(String, String)> {
    let fixed = FIXED.map(|(name, text)| {
        let text = text.replace("@VERSION@", env!("CARGO_PKG_VERSION"));
        (name.to_owned(), text)
    });
    let mut files: Vec<(String, String)> = fixed.into();
    let mut listed = Vec::new();
    for (name, schema) in messages() {
        listed.push(format!("  \"msg/{name}.msg\""));
        let path = format!("src/{MESSAGES}/msg/{name}.msg");
        files.push((path, schema.fields().to_owned()));
    }
    files.push((
        format!("src/{MESSAGES}/CMakeLists.txt"),
        CMAKE.replace("@MESSAGES@", &listed.join("\n")),
    ));
    for side in [Side::Right, Side::Left] {
        let name = side_name(side);
        let bringup = "src/handscope_bringup";
        files.push((format!("{bringup}/urdf/ftp_{name}_hand.urdf"), urdf(side)));
        files.push((
            format!("{bringup}/rviz/{name}.rviz"),
            RVIZ.replace("@SIDE@", name),
        ));
    }
    files
}

/// Messages of our own package, each once, with their names.
fn messages() -> impl Iterator<Item = (&'static str, Schema)> {
    let mut seen = Vec::new();
    let schemas = Topic::all().map(Topic::schema);
    schemas.filter_map(move |schema| {
        let (package, name) = schema.name.split_once("/msg/")?;
        let is_new = package == MESSAGES && !seen.contains(&schema.id);
        is_new.then(|| {
            seen.push(schema.id);
            (name, schema)
        })
    })
}

fn write(file: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = file.parent() {
        store::create_folder(folder)?;
    }
    store::write_new(file, text.as_bytes())
}
