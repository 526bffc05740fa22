//! Tables of laws, modes and shapes, made of their entries.

use crate::laws::entry::Entry;
use crate::units::{Key, Kind, Table};

/// Tables of entries.
pub(super) const fn tables<L: ?Sized, const N: usize>(laws: &'static [&'static Entry<L>]) -> [Table; N] {
    let mut tables = [Table::new("", "", &[]); N];
    let mut place = 0;
    while place < N {
        tables[place] = laws[place].table();
        place += 1;
    }
    tables
}

/// Their names.
pub(super) const fn names<const N: usize>(tables: &'static [Table]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut place = 0;
    while place < N {
        names[place] = tables[place].name;
        place += 1;
    }
    names
}

/// The keys of a table: some, then those of tables of which one is given, then others.
pub(super) const fn keys<const N: usize>(
    before: &[Key],
    tables: &'static [Table],
    after: &[Key],
) -> [Key; N] {
    let mut keys = [Key::new("", Kind::Switch, ""); N];
    let mut place = 0;
    while place < N {
        let (of_tables, of_after) =
            (place.wrapping_sub(before.len()), place.wrapping_sub(before.len() + tables.len()));
        keys[place] = if place < before.len() {
            before[place]
        } else if of_tables < tables.len() {
            Key::table(&tables[of_tables]).optional()
        } else {
            after[of_after]
        };
        place += 1;
    }
    keys
}
