//! Nouns to words, tables, pictures and pages: everything is returned as text or bytes, nothing is
//! written or printed here.

mod history_plot;
mod markup;
pub mod number;
mod page;
pub mod plot;
mod ranking_plot;
mod receptance_plot;
mod table;
mod words;

pub use history_plot::{Reference, history_plot};
pub use markup::escape;
pub use page::{Figure, Page, Section};
pub use ranking_plot::ranking_plot;
pub use receptance_plot::{Magnitude, ModeMark, Path, Receptance, receptance_plot};
pub use table::{Align, Cell, Column, Table};
pub use words::{
    Compared, SCORE_NOISE, channels_table, comparison_table, energy_table, modes_table, ranking_table,
    turning_points_table,
};
