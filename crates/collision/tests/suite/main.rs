//! Motions, records, first contacts and connectors, tested through the public API.

mod connector_kinematics;
mod connectors;
mod first_contact;
mod invariance;
mod kinematics;
mod rails;
mod records;
mod ropes;
