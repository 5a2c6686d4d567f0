//! What halfgap costs: the benches of this member.
