//! Jams: contacts that slip and whose forces have no solution stop slipping within an instant, without any collision.

use crate::rigid::active_set::jump::{WayOn, find_way_on};
use crate::rigid::active_set::painleve::works_of_jump;
use crate::rigid::books::energy::{book_damping, interrupt};
use crate::rigid::books::report::RowForce;
use crate::rigid::event::rooms::Rooms;
use crate::rigid::event::telling::told_record;
use crate::rigid::event::work::EventWork;
use crate::rigid::region::records::remeasure;
use glam::DVec2;

/// Finds the way on for a region whose candidates have no forces: mostly its velocities jump, whose bodies are in flight. False if that
/// leads nowhere.
pub(super) fn unjam(rooms: &mut Rooms, work: &mut EventWork) -> bool {
    let now = rooms.assembly.now();
    let EventWork { region, settling, .. } = &mut *work;
    let mut stage = rooms.groups.take_stage();
    let way_on = find_way_on(&rooms.view(), region, settling, &mut stage);
    rooms.groups.put_stage(stage);
    let changes = match way_on {
        WayOn::Jump(changes) => changes,
        WayOn::FewerSticks => return true,
        WayOn::Nothing => return false,
    };
    let mut work_of_jump = 0.0;
    for (&body, &[x, y, spin]) in region.bodies().iter().zip(changes) {
        book_damping(&mut rooms.assembly, &mut rooms.books, body, now);
        let kinetic = |rooms: &Rooms| {
            rooms.assembly.kinetic_energy(body, &rooms.assembly.trajectory(body).unwound_at(now))
        };
        let before = kinetic(rooms);
        interrupt(&mut rooms.assembly, &mut rooms.books, body).cut(now, DVec2::new(x, y), spin);
        rooms.assembly.note_struck(body, now);
        work_of_jump += kinetic(rooms) - before;
    }
    rooms.books.book_jam(work_of_jump);
    for (record, work_at) in works_of_jump(&work.region, &work.settling) {
        let told =
            RowForce { jump: Some(work_at), force: 0.0, ..told_record(&work.region.records()[record]) };
        rooms.books.tell_jam(told);
    }
    remeasure(&rooms.assembly, &rooms.connectors, &mut work.region, now);
    true
}
