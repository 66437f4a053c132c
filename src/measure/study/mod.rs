//! The study of run time against error.

pub mod pictures;
