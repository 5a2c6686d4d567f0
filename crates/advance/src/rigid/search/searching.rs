//! What the search for contacts works on: it reads motions and contacts, and writes predictions.

use crate::rigid::agenda::Agenda;
use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::sinking::depth::Sinking;

/// The parts of the system from which the next contact of each pair is found.
#[derive(Debug)]
pub(crate) struct Searching<'a> {
    pub(crate) assembly: &'a Assembly,
    pub(crate) connectors: &'a mut Connectors,
    pub(crate) sinking: &'a Sinking,
    pub(crate) pairs: &'a mut Pairs,
    pub(crate) search: &'a mut Neighbourhood,
    pub(crate) agenda: &'a mut Agenda,
}
