//! Detects a graphics card that programs can draw with. Without one, OpenGL is software too, and for this window three times
//! slower than our own renderer.

use std::path::Path;

/// False if the system reports no graphics card. Always true on systems other than Linux.
pub fn may_draw_with_a_card() -> bool {
    !cfg!(target_os = "linux") || has_card(Path::new("/dev"))
}

/// True if this device folder has a render node or a maker's own device.
fn has_card(devices: &Path) -> bool {
    let named = |folder: &Path, begin: &str| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names = entries.map(|entry| entry.file_name());
        names.any(|name| name.to_string_lossy().starts_with(begin))
    };
    named(&devices.join("dri"), "renderD")
        || named(devices, "nvidia0")
        || named(devices, "dxg")
        || named(devices, "mali")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{create_dir, write};

    #[test]
    fn a_display_without_a_render_node_is_no_card() {
        let devices = tempfile::tempdir().unwrap();
        assert!(!has_card(devices.path()));
        create_dir(devices.path().join("dri")).unwrap();
        write(devices.path().join("dri/card0"), "").unwrap();
        assert!(!has_card(devices.path()));
        write(devices.path().join("dri/renderD128"), "").unwrap();
        assert!(has_card(devices.path()));
    }

    #[test]
    fn a_card_of_the_makers_own_is_one() {
        let devices = tempfile::tempdir().unwrap();
        write(devices.path().join("nvidia0"), "").unwrap();
        assert!(has_card(devices.path()));
    }
}
