//! Relations between cells that share no face, as lists by cell.

use tetrascope_mesh::CellId;

/// For every cell those that a relation leads to. Few cells have any: the others cost an eighth of a byte.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gaps {
    /// A bit for every cell that takes part, on either side.
    takes_part: Vec<u64>,
    /// How many take part before the cells of a word.
    before: Vec<u32>,
    /// Where a member's list starts; one more than members.
    starts: Vec<u32>,
    lists: Vec<CellId>,
    /// For every member how many lists name it.
    named: Vec<u32>,
}

impl Gaps {
    /// - `count`: cells of the mesh
    /// - `relations`: ascending
    pub(crate) fn new(count: usize, relations: &[(CellId, CellId)]) -> Self {
        if relations.is_empty() {
            return Self::default();
        }
        let mut takes_part = vec![0_u64; count.div_ceil(64)];
        for cell in relations.iter().flat_map(|&(from, to)| [from, to]) {
            takes_part[cell.index() / 64] |= 1 << (cell.index() % 64);
        }
        let mut members = 0;
        let before = takes_part
            .iter()
            .map(|word| {
                members += word.count_ones();
                members - word.count_ones()
            })
            .collect();
        let lists = relations.iter().map(|&(_, to)| to).collect();
        let members = members as usize;
        let mut gaps = Self { takes_part, before, starts: vec![0; members + 1], lists, named: vec![0; members] };
        for &(from, to) in relations {
            let (from, to) = (gaps.member(from), gaps.member(to));
            gaps.starts[from + 1] += 1;
            gaps.named[to] += 1;
        }
        for member in 0..members {
            gaps.starts[member + 1] += gaps.starts[member];
        }
        gaps
    }

    /// Whether there are no relations.
    pub(crate) fn is_empty(&self) -> bool {
        self.lists.is_empty()
    }

    /// The same relations, led back.
    pub(crate) fn reversed(&self, count: usize) -> Self {
        let mut relations: Vec<(CellId, CellId)> =
            self.members().flat_map(|from| self.list(from).iter().map(move |&to| (to, from))).collect();
        relations.sort_unstable();
        Self::new(count, &relations)
    }

    /// The cells that take part, ascending.
    pub(crate) fn members(&self) -> impl Iterator<Item = CellId> + '_ {
        let has = |cell: &u32| self.takes_part[*cell as usize / 64] >> (cell % 64) & 1 == 1;
        let words = self.takes_part.iter().enumerate().filter(|(_, word)| **word != 0);
        words.flat_map(move |(word, _)| (64 * word as u32..64 * (word as u32 + 1)).filter(has).map(CellId))
    }

    /// The place of a cell among those that take part.
    ///
    /// # Panics
    ///
    /// May, if there are none.
    #[inline]
    pub(crate) fn member(&self, cell: CellId) -> usize {
        let (word, bit) = (cell.index() / 64, cell.index() % 64);
        (self.before[word] + (self.takes_part[word] & ((1 << bit) - 1)).count_ones()) as usize
    }

    /// Where the relations of a cell lead; nowhere for one that takes no part.
    pub(crate) fn list(&self, cell: CellId) -> &[CellId] {
        let has = self.takes_part.get(cell.index() / 64).is_some_and(|word| word >> (cell.index() % 64) & 1 == 1);
        if !has {
            return &[];
        }
        let member = self.member(cell);
        &self.lists[self.starts[member] as usize..self.starts[member + 1] as usize]
    }

    /// For every member how many relations lead to it.
    pub(crate) fn named(&self) -> &[u32] {
        &self.named
    }
}
