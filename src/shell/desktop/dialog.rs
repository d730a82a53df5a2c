//! The system's own file dialogs. Reads and writes no file.

use crate::app::env::ChooseFile;
use futures::future::BoxFuture;
use std::path::PathBuf;

/// The system's own dialogs; they do not block the window.
pub(crate) struct NativeDialog;

impl ChooseFile for NativeDialog {
    fn choose(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        // Started here, on the window's thread, as some systems require.
        let asked = asking(suggested).save_file();
        Box::pin(async move { asked.await.map(|file| file.path().to_path_buf()) })
    }

    fn open(&self, suggested: &str) -> BoxFuture<'static, Option<PathBuf>> {
        let asked = asking(suggested).pick_file();
        Box::pin(async move { asked.await.map(|file| file.path().to_path_buf()) })
    }

    fn folder(&self) -> BoxFuture<'static, Option<PathBuf>> {
        let asked = rfd::AsyncFileDialog::new().pick_folder();
        Box::pin(async move { asked.await.map(|folder| folder.path().to_path_buf()) })
    }
}

fn asking(suggested: &str) -> rfd::AsyncFileDialog {
    rfd::AsyncFileDialog::new().set_file_name(suggested)
}
