//! An event of the agenda to the file that handles it.

use crate::rigid::agenda::Source;
use crate::rigid::books::report::Handled;
use crate::rigid::contacts::pairs::{PairId, Prediction};
use crate::rigid::due::events::{handle_contact, handle_group, handle_rope};
use crate::rigid::error::AdvanceError;
use crate::rigid::event::life::complete_dense;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::steps::handle_step;
use crate::rigid::stepping::ending::all_coast;
use crate::rigid::ticks::handle_tick;
use crate::rigid::zeno::turns::note_search;
use crate::time::Time;

/// Runs an event at a time and returns its report; `None` if callers need not know of it.
pub(crate) fn happen(
    rooms: &mut Rooms,
    time: Time,
    act: impl FnOnce(&mut Rooms) -> Result<(), AdvanceError>,
) -> Result<Option<Handled>, AdvanceError> {
    if let Some(failure) = rooms.books.told().failure() {
        return Err(failure.clone());
    }
    rooms.books.begin_event(time);
    rooms.assembly.set_now(time);
    let outcome = act(rooms);
    rooms.books.set_told_time(rooms.assembly.now());
    debug_assert!(outcome.is_err() || all_coast(&rooms.assembly, &rooms.zeno), "a body has left its step");
    if outcome.is_ok() && !rooms.books.told().has_hit() && rooms.books.told().changes().is_empty() {
        let Some(crawls) = rooms.zeno.take_crawls() else { return Ok(None) };
        finish(rooms);
        return Err(crawls);
    }
    finish(rooms);
    rooms.books.note_outcome(&outcome);
    outcome.map(|()| Some(Handled { time: rooms.assembly.now(), impact: rooms.books.told().has_hit() }))
}

/// Makes the dense output that was postponed, if there is any: then all motions can be evaluated.
pub(crate) fn finish(rooms: &mut Rooms) {
    complete_dense(&mut rooms.assembly, &mut rooms.connectors, &mut rooms.groups);
}

/// Handles the event of a source.
pub(crate) fn handle(rooms: &mut Rooms, source: Source) -> Result<(), AdvanceError> {
    match source {
        Source::Box(body) => rooms.searching().leave_box(body),
        Source::Group(leader) => return handle_group(rooms, leader),
        Source::Connector(id) if rooms.searching().rope_fires(id) => return handle_rope(rooms, id),
        Source::Connector(_) => {}
        Source::Step(leader) => return handle_step(rooms, leader),
        Source::Tick => return handle_tick(rooms),
        Source::Pair(pair) => match rooms.pairs.get(pair).prediction() {
            Prediction::Contact(features) => return handle_contact(rooms, pair, features),
            _ => search_on(rooms, pair),
        },
    }
    Ok(())
}

/// Goes on with the search for a pair's next contact.
pub(crate) fn search_on(rooms: &mut Rooms, pair: PairId) {
    rooms.searching().predict(pair);
    note_search(&rooms.assembly, &mut rooms.pairs, &mut rooms.zeno, pair);
}
