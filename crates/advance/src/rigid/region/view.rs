//! A look at all that an event may read before it changes anything.

use crate::rigid::bodies::assembly::Assembly;
use crate::rigid::connectors::store::Connectors;
use crate::rigid::contacts::pairs::Pairs;
use crate::rigid::group::groups::Groups;
use crate::rigid::search::neighbourhood::Neighbourhood;
use crate::rigid::sinking::depth::Sinking;
use crate::rigid::zeno::memory::Zeno;

/// The parts of the system, to be read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    pub(crate) assembly: &'a Assembly,
    pub(crate) connectors: &'a Connectors,
    pub(crate) sinking: &'a Sinking,
    pub(crate) pairs: &'a Pairs,
    pub(crate) search: &'a Neighbourhood,
    pub(crate) groups: &'a Groups,
    pub(crate) zeno: &'a Zeno,
}
