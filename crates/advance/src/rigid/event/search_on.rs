//! TODO

use crate::rigid::contacts::pairs::PairId;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::zeno::turns::note_search;

/// Goes on with the search for a pair's next contact.
pub(crate) fn search_on(rooms: &mut Rooms, pair: PairId) {
    rooms.searching().predict(pair);
    note_search(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair);
}
