//! Reasons for a missing window, each as one sentence with the remedy. Opens none.

use crate::shell::desktop::libraries;
use crate::shell::desktop::libraries::{ALL, OPENGL, Package, install};

/// Reason why the window could not be opened.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DesktopError {
    /// Neither X11 nor Wayland.
    #[error(
        "the window cannot open: there is no display here ({cause}); start it in a desktop session, or use 'handscope snapshot' for pictures and 'handscope watch' for values"
    )]
    NoDisplay {
        /// The system's error text.
        cause: String,
    },
    /// A library that windows need is not installed.
    #[error(
        "the window cannot open: {library} is missing; {}, or use 'handscope snapshot' for pictures",
        install(package)
    )]
    MissingLibrary {
        /// File name of the library.
        library: &'static str,
        /// Packages that contain it.
        package: &'static Package,
    },
    /// OpenGL does not start. A window without it may.
    #[error(
        "the window cannot open with OpenGL ({cause}); start 'handscope --software', or install a driver: {}", install(&OPENGL)
    )]
    NoOpenGl {
        /// The system's error text.
        cause: String,
    },
    /// The display cannot show software-rendered pixels.
    #[error(
        "the window cannot draw on this display ({cause}); use 'handscope snapshot' for pictures"
    )]
    NoSurface {
        /// The system's error text.
        cause: String,
    },
    /// Any other refusal by the system.
    #[error(
        "the window cannot open ({cause}); {}, or use 'handscope snapshot' for pictures", install(&ALL)
    )]
    Refused {
        /// The system's error text.
        cause: String,
    },
    /// The thread for the links could not be started.
    #[error("the program cannot start its link thread: {cause}")]
    Runtime {
        /// The system's error text.
        cause: String,
    },
}

impl DesktopError {
    /// Classifies the error text of winit, glutin, or a panic inside them; only the text distinguishes the causes.
    pub(crate) fn of(words: &str) -> Self {
        let cause = cause_of(words);
        let words = cause.to_lowercase();
        let has = |parts: &[&str]| parts.iter().any(|part| words.contains(part));
        if let Some(missing) = libraries::named_in(&words) {
            return missing.into();
        }
        if has(&[
            "wayland_display",
            "display is set",
            "xopendisplay",
            "could not connect",
            "open connection to x",
        ]) {
            return Self::NoDisplay { cause };
        }
        // Winit does not name the library.
        if words.contains("shared librar")
            && let Some(missing) = libraries::missing_here()
        {
            return missing.into();
        }
        if has(&["opengl", "glutin", "libgl", "libegl", "glx", "egl "]) {
            return Self::NoOpenGl { cause };
        }
        Self::Refused { cause }
    }
}

impl From<&'static libraries::SharedLibrary> for DesktopError {
    fn from(missing: &'static libraries::SharedLibrary) -> Self {
        Self::MissingLibrary {
            library: missing.file,
            package: &missing.package,
        }
    }
}

/// The text on one line, without the source position of a library that some errors begin with.
pub(crate) fn cause_of(words: &str) -> String {
    let after = words
        .rsplit_once(".rs:")
        .and_then(|(_, rest)| rest.split_once(": "));
    let words = after.map_or(words, |(_, words)| words);
    let line: Vec<&str> = words.split_whitespace().collect();
    line.join(" ").trim_end_matches('.').to_owned()
}

/// Message of a caught panic.
pub(crate) fn panic_words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "the graphics system failed".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_display_is_told_from_a_missing_library_and_from_missing_opengl() {
        let words = "winit EventLoopError: os error at /root/winit-0.30.13/src/mod.rs:765: neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set.";
        let cause = "neither WAYLAND_DISPLAY nor WAYLAND_SOCKET nor DISPLAY is set".to_owned();
        assert_eq!(DesktopError::of(words), DesktopError::NoDisplay { cause });
        let refused = DesktopError::of("Failed to open connection to X server");
        assert!(matches!(refused, DesktopError::NoDisplay { .. }));
        let missing = DesktopError::of("OpenGL: libGL.so: cannot open shared object file");
        assert!(
            matches!(missing, DesktopError::NoOpenGl { .. }),
            "{missing}"
        );
        let other = DesktopError::of("the moon is full");
        assert!(matches!(other, DesktopError::Refused { .. }));
    }

    #[test]
    fn each_missing_library_is_named_with_its_package() {
        for (words, library, apt) in [
            (
                "libXcursor.so.1: cannot open shared object file: No such file or directory",
                "libXcursor.so.1",
                "apt install libxcursor1'",
            ),
            (
                "OpenError { kind: SharedLibrary, detail: \"opening library failed (libXi.so.6: cannot open shared object file)\" }",
                "libXi.so.6",
                "apt install libxi6'",
            ),
            (
                "SharedLibrary libxkbcommon-x11.so could not be loaded.",
                "libxkbcommon-x11.so.0",
                "apt install libxkbcommon-x11-0'",
            ),
            (
                "SharedLibrary libxkbcommon.so could not be loaded.",
                "libxkbcommon.so.0",
                "apt install libxkbcommon0'",
            ),
        ] {
            let text = DesktopError::of(words).to_string();
            assert!(text.contains(library) && text.contains(apt), "{text}");
            assert!(text.contains("dnf") && text.contains("pacman"), "{text}");
            assert!(text.contains("snapshot") && !text.contains('\n'), "{text}");
        }
    }

    #[test]
    fn every_sentence_is_one_line_and_says_what_to_do() {
        let cause = || cause_of("at lib.rs:12: it\n failed.");
        for error in [
            DesktopError::NoDisplay { cause: cause() },
            DesktopError::NoOpenGl { cause: cause() },
            DesktopError::NoSurface { cause: cause() },
            DesktopError::Refused { cause: cause() },
        ] {
            let text = error.to_string();
            assert!(text.contains("(it failed)"), "{text}");
            assert!(text.contains("handscope "), "{text}");
        }
    }
}
