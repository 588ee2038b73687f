//! Positions in the lists of a model. Every list has its type of position, so that the compiler keeps fields and
//! balances apart.

use std::fmt::Debug;
use std::hash::Hash;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

/// A position in one of a model's lists.
pub trait Id: Copy + Eq + Ord + Hash + Debug {
    /// The element at a position.
    fn at(position: usize) -> Self;
    /// The position.
    fn index(self) -> usize;
}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident($inner:ty);)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub struct $name(pub $inner);

        impl Id for $name {
            fn at(position: usize) -> Self {
                $name(position as $inner)
            }

            fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// A field; profiles come before numbers.
    FieldId(u8);
    /// A balance.
    BalanceId(u8);
    /// A parameter, switches among them.
    ParameterId(u16);
    /// A constitutive law.
    LawId(u16);
    /// A combination of the structural switches.
    CaseId(u16);
    /// A balance among those that the base state has to satisfy.
    BaseRowId(u8);
    /// A field among those that the base state is solved for.
    SolvedId(u8);
}

/// A list whose positions are ids of one kind.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Table<I, T> {
    items: Vec<T>,
    ids: PhantomData<I>,
}

impl<I: Id, T> Table<I, T> {
    /// All ids, in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + use<I, T> {
        (0..self.items.len()).map(I::at)
    }

    /// Every item with its id.
    pub fn pairs(&self) -> impl DoubleEndedIterator<Item = (I, &T)> + ExactSizeIterator {
        self.items
            .iter()
            .enumerate()
            .map(|(position, item)| (I::at(position), item))
    }

    /// The item of an id, if the list is so long.
    pub fn find(&self, id: I) -> Option<&T> {
        self.items.get(id.index())
    }

    /// The first id whose item satisfies a condition.
    pub fn position(&self, mut condition: impl FnMut(&T) -> bool) -> Option<I> {
        let position = self.items.iter().position(&mut condition);
        position.map(I::at)
    }

    /// A list of the same length.
    pub fn map<U>(&self, of: impl FnMut(&T) -> U) -> Table<I, U> {
        self.items.iter().map(of).collect()
    }

    /// Adds an item.
    pub fn push(&mut self, item: T) -> I {
        self.items.push(item);
        I::at(self.items.len() - 1)
    }
}

impl<I: Id, T: Clone> Table<I, T> {
    /// The same item everywhere.
    pub fn filled(count: usize, item: T) -> Self {
        vec![item; count].into()
    }
}

impl<I, T> From<Vec<T>> for Table<I, T> {
    fn from(items: Vec<T>) -> Self {
        Table {
            items,
            ids: PhantomData,
        }
    }
}

impl<I, T> Default for Table<I, T> {
    fn default() -> Self {
        Vec::new().into()
    }
}

impl<I, T> FromIterator<T> for Table<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(items: A) -> Self {
        items.into_iter().collect::<Vec<T>>().into()
    }
}

impl<I, T> Extend<T> for Table<I, T> {
    fn extend<A: IntoIterator<Item = T>>(&mut self, items: A) {
        self.items.extend(items);
    }
}

impl<I, T> IntoIterator for Table<I, T> {
    type Item = T;
    type IntoIter = std::vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.into_iter()
    }
}

impl<'a, I, T> IntoIterator for &'a Table<I, T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

impl<I, T> Deref for Table<I, T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<I, T> DerefMut for Table<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.items
    }
}

impl<I: Id, T> Index<I> for Table<I, T> {
    type Output = T;

    fn index(&self, id: I) -> &T {
        &self.items[id.index()]
    }
}

impl<I: Id, T> IndexMut<I> for Table<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.items[id.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::{BalanceId, FieldId, Id, Table};

    #[test]
    fn a_table_by_ids() {
        let mut names: Table<FieldId, &str> = vec!["n", "u"].into();
        let last = names.push("T");
        assert_eq!((last, names[last]), (FieldId(2), "T"));
        assert_eq!(names.position(|n| *n == "u"), Some(FieldId::at(1)));
        assert_eq!(names.find(FieldId(3)), None);
        let lengths: Table<FieldId, usize> = names.map(|n| n.len());
        assert_eq!(lengths.iter().sum::<usize>(), 3);
        let rows: Table<BalanceId, bool> = Table::filled(2, false);
        assert!(rows.pairs().all(|(id, item)| id.index() < 2 && !item));
    }
}
