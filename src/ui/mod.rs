//! The window: reads [`crate::app::state::State`], draws it with egui, returns actions. No clock, file, thread or wire.

mod banner;
mod budget;
mod connection;
mod controls;
mod faults;
mod fingertip;
mod format;
mod frame_menu;
mod gestures;
mod hand_picture;
mod joint_readings;
mod joint_row;
mod joint_tracks;
mod joints;
mod link_figures;
mod look;
mod number;
mod plot_axes;
mod plot_head;
mod plots;
mod scan;
mod text;
mod theme;
mod tip_detail;
mod top_bar;
mod touch;
mod touch_heat;
mod track;
mod traffic;
mod traffic_detail;
mod traffic_filter;
mod traffic_list;
mod window;

pub use window::{View, Window, install};
