//! What a robot can climb: where its feet fit on a stair, and what must hold before it steps (003, section V.C).

pub(crate) mod conditions;
pub(crate) mod config;
pub(crate) mod footing;
pub(crate) mod unfit;
