//! The advance of rigid bodies, as its users see it.

mod accumulation;
mod bounces;
mod box_of_bodies;
mod cutting;
mod determinism;
mod energy;
mod hops;
mod idle;
mod limits;
mod no_overlap;
mod pace;
mod rest;
