//! Motions, records, first contacts and connectors, tested through the public API.

mod connector_kinematics;
mod connectors;
mod differences;
mod effort;
mod first_contact;
mod invariance;
mod kinematics;
mod pairs;
mod path;
mod rails;
mod random;
mod records;
mod ropes;
mod tangents;
