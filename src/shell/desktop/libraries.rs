//! Libraries that a window needs on Linux, and the packages that contain them. Loads none.

use std::path::{Path, PathBuf};

/// Package names in the three large families of distributions.
#[derive(Debug, PartialEq, Eq)]
pub struct Package {
    debian: &'static str,
    fedora: &'static str,
    arch: &'static str,
}

/// A library and its packages.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SharedLibrary {
    /// Name as in error texts, in lower case.
    name: &'static str,
    pub(crate) file: &'static str,
    pub(crate) package: Package,
}

/// OpenGL with a driver that needs no graphics card.
pub(crate) const OPENGL: Package = Package::of(
    "libgl1 libgl1-mesa-dri",
    "mesa-libGL mesa-dri-drivers",
    "libglvnd mesa",
);
/// Packages most often missing on small installations.
pub(crate) const ALL: Package = Package::of(
    "libxcursor1 libxi6 libxkbcommon-x11-0 libgl1",
    "libXcursor libXi libxkbcommon-x11 mesa-libGL",
    "libxcursor libxi libxkbcommon-x11 libglvnd",
);

/// Libraries of X11, longer names first, because some begin with another.
static OF_X11: [SharedLibrary; 6] = [
    SharedLibrary {
        name: "libxkbcommon-x11",
        file: "libxkbcommon-x11.so.0",
        package: Package::of("libxkbcommon-x11-0", "libxkbcommon-x11", "libxkbcommon-x11"),
    },
    SharedLibrary {
        name: "libxkbcommon",
        file: "libxkbcommon.so.0",
        package: Package::of("libxkbcommon0", "libxkbcommon", "libxkbcommon"),
    },
    SharedLibrary {
        name: "libxcursor",
        file: "libXcursor.so.1",
        package: Package::of("libxcursor1", "libXcursor", "libxcursor"),
    },
    SharedLibrary {
        name: "libxi.",
        file: "libXi.so.6",
        package: Package::of("libxi6", "libXi", "libxi"),
    },
    SharedLibrary {
        name: "libx11-xcb",
        file: "libX11-xcb.so.1",
        package: Package::of("libx11-xcb1", "libX11-xcb", "libx11"),
    },
    SharedLibrary {
        name: "libx11.",
        file: "libX11.so.6",
        package: Package::of("libx11-6", "libX11", "libx11"),
    },
];

impl Package {
    const fn of(debian: &'static str, fedora: &'static str, arch: &'static str) -> Self {
        Self {
            debian,
            fedora,
            arch,
        }
    }
}

/// Command that installs a package. On Windows, a hint about drivers instead.
pub(crate) fn install(package: &Package) -> String {
    let Package {
        debian,
        fedora,
        arch,
    } = package;
    if cfg!(windows) {
        return "see what the maker of the graphics card offers for Windows".into();
    }
    format!(
        "run 'sudo apt install {debian}' (Debian, Ubuntu), 'sudo dnf install {fedora}' (Fedora) or 'sudo pacman -S {arch}' (Arch)"
    )
}

/// The library named in this lower-case text.
pub(crate) fn named_in(words: &str) -> Option<&'static SharedLibrary> {
    OF_X11.iter().find(|library| words.contains(library.name))
}

/// The first X11 library that is in none of the system's library folders.
pub(crate) fn missing_here() -> Option<&'static SharedLibrary> {
    missing_from(&places())
}

fn missing_from(places: &[PathBuf]) -> Option<&'static SharedLibrary> {
    let is_there = |file: &str| places.iter().any(|place| place.join(file).is_file());
    let any = OF_X11.iter().any(|library| is_there(library.file));
    // If none is found, the system uses other folders, and none is reported.
    let missing = OF_X11.iter().find(|library| !is_there(library.file));
    missing.filter(|_| any)
}

fn places() -> Vec<PathBuf> {
    let own = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let own: Vec<PathBuf> = std::env::split_paths(&own).collect();
    let usual = ["/lib", "/usr/lib", "/lib64", "/usr/lib64", "/usr/local/lib"].map(PathBuf::from);
    let under = usual.iter().flat_map(|place| for_this_machine(place));
    own.iter()
        .cloned()
        .chain(under)
        .chain(usual.iter().cloned())
        .collect()
}

/// Debian's folders by machine, such as `x86_64-linux-gnu`.
fn for_this_machine(place: &Path) -> Vec<PathBuf> {
    let name = format!("{}-linux-gnu", std::env::consts::ARCH);
    let folders = std::fs::read_dir(place).into_iter().flatten().flatten();
    let ours = folders.filter(|folder| folder.file_name().to_string_lossy().starts_with(&name));
    ours.map(|folder| folder.path()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_that_is_not_there_is_found_and_nothing_is_guessed() {
        let folder = tempfile::tempdir().unwrap();
        let places = [folder.path().join("none"), folder.path().to_path_buf()];
        assert_eq!(missing_from(&places), None, "they are kept elsewhere");
        for library in &OF_X11 {
            std::fs::write(folder.path().join(library.file), "").unwrap();
        }
        assert_eq!(missing_from(&places), None);
        for library in &OF_X11 {
            let file = folder.path().join(library.file);
            std::fs::remove_file(&file).unwrap();
            assert_eq!(missing_from(&places), Some(library));
            std::fs::write(&file, "").unwrap();
        }
    }

    #[test]
    fn no_library_is_taken_for_another() {
        for library in &OF_X11 {
            assert_eq!(named_in(&library.file.to_lowercase()), Some(library));
        }
        assert_eq!(named_in("opengl"), None);
    }
}
