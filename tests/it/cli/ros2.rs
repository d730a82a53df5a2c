//! The workspace of ROS 2 that `handscope ros2` writes.

use crate::setup::process::run;
use handscope::hand::kinematics::Side;
use handscope::hand::model::urdf::urdf;
use handscope::record::file::format::topic::Topic;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn the_workspace_has_the_messages_of_recordings_and_the_models_of_both_hands() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join("hand_ws");
    let ended = run(&["ros2", "--out", text(&root)]).ok();
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    for line in ended.out.lines() {
        assert!(Path::new(line).is_file(), "{line}");
        let content = fs::read_to_string(line).unwrap();
        for mark in ["@VERSION@", "@MESSAGES@", "@SIDE@"] {
            assert!(!content.contains(mark), "{line}");
        }
    }
    let cmake = read("src/handscope_msgs/CMakeLists.txt");
    let mut names = BTreeSet::new();
    for schema in Topic::all().map(Topic::schema) {
        let Some(name) = schema.name.strip_prefix("handscope_msgs/msg/") else {
            continue;
        };
        names.insert(format!("{name}.msg"));
        let own = read(&format!("src/handscope_msgs/msg/{name}.msg"));
        let (fields, _) = schema.text.split_once("====").unwrap();
        assert_eq!(own, fields);
        assert_eq!(cmake.matches(&format!("\"msg/{name}.msg\"")).count(), 1);
    }
    assert_eq!(names.len(), 8, "{names:?}");
    let written = fs::read_dir(root.join("src/handscope_msgs/msg")).unwrap();
    let written = written.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert_eq!(written.collect::<BTreeSet<_>>(), names);
    let bringup = "src/handscope_bringup";
    for (side, name) in [(Side::Right, "right"), (Side::Left, "left")] {
        assert_eq!(
            read(&format!("{bringup}/urdf/ftp_{name}_hand.urdf")),
            urdf(side)
        );
        let view = read(&format!("{bringup}/rviz/{name}.rviz"));
        assert!(view.contains(&format!("Fixed Frame: {name}_palm\n")));
    }
    for package in ["handscope_msgs", "handscope_bringup"] {
        let xml = read(&format!("src/{package}/package.xml"));
        assert!(xml.contains(&format!("<version>{}</version>", env!("CARGO_PKG_VERSION"))));
        assert!(
            read(&format!("src/{package}/CMakeLists.txt")).contains(&format!("project({package})"))
        );
    }
}

#[test]
fn a_folder_that_holds_something_is_left_as_it_is_and_an_empty_one_is_used() {
    let folder = tempfile::tempdir().unwrap();
    let ended = run(&["ros2", "--json", "--out", text(folder.path())]).ok();
    let files = ended.lines()[0]["ros2"]["files"].as_array().unwrap().len();
    assert!(files > 15, "{files}");
    let readme = folder.path().join("README.md");
    fs::write(&readme, "mine").unwrap();
    let again = run(&["ros2", "--out", text(folder.path())]);
    assert_eq!((again.code, again.out.as_str()), (Some(1), ""));
    assert_eq!(again.err.lines().count(), 1, "{}", again.err);
    assert!(again.err.contains("the folder is not empty") && again.err.contains("--out"));
    assert_eq!(fs::read_to_string(readme).unwrap(), "mine");
    let file = folder.path().join("README.md");
    let refused = run(&["ros2", "--out", text(&file)]);
    assert_eq!(refused.code, Some(1));
    assert_eq!(refused.err.lines().count(), 1, "{}", refused.err);
}
