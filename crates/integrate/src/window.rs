//! A window that slides over a sequence and knows what its elements compose to, without inverses.
//!
//! Elements enter at the back and leave at the front, and only neighbors can be composed, in their order. The window is
//! two stacks. What enters goes onto the first, next to what all of that stack composes to. What leaves comes off the
//! second, which holds for every element what it composes to with all that entered after it. When the second is empty
//! the first is turned over onto it. So every element is composed once when it enters and once when it is turned over,
//! and each look at the whole costs one more.
//!
//! Pre-integration tables need that: all segments with ends the same number of steps apart are windows over those
//! steps. Composition with `over` has no usable inverse, because nothing can be recovered from behind an opaque step.

/// Something that can be composed with a neighbor, associatively and in order.
pub(crate) trait Monoid: Copy {
    /// Changes nothing on either side.
    const NEUTRAL: Self;

    /// This followed by `next`.
    fn then(self, next: Self) -> Self;
}

/// A queue of elements that knows their composition.
pub(crate) struct SlidingWindow<T> {
    /// What entered last, in order.
    entered: Vec<T>,
    /// What all of `entered` composes to.
    entered_whole: T,
    /// The elements before, the first of them last; each composed with all that follow it up to `entered`.
    leaving: Vec<T>,
}

impl<T: Monoid> SlidingWindow<T> {
    /// An empty window with memory for `size` elements.
    pub(crate) fn with_capacity(size: usize) -> Self {
        Self { entered: Vec::with_capacity(size), entered_whole: T::NEUTRAL, leaving: Vec::with_capacity(size) }
    }

    /// Appends an element at the back.
    pub(crate) fn push(&mut self, element: T) {
        self.entered.push(element);
        self.entered_whole = self.entered_whole.then(element);
    }

    /// Takes the element at the front out; an empty window stays empty.
    pub(crate) fn pop(&mut self) {
        if self.leaving.is_empty() {
            let mut whole = T::NEUTRAL;
            while let Some(element) = self.entered.pop() {
                whole = element.then(whole);
                self.leaving.push(whole);
            }
            self.entered_whole = T::NEUTRAL;
        }
        self.leaving.pop();
    }

    /// What all elements compose to, from front to back; neutral for an empty window.
    pub(crate) fn whole(&self) -> T {
        self.leaving.last().map_or(self.entered_whole, |front| front.then(self.entered_whole))
    }
}

/// Calls with what each run of `width` successive elements composes to, in order; not at all where there are fewer.
///
/// Amortized less than two compositions an element, and one a run.
pub(crate) fn for_each_run<T: Monoid>(elements: impl Iterator<Item = T>, width: usize, mut run: impl FnMut(T)) {
    let mut window = SlidingWindow::with_capacity(width);
    for (index, element) in elements.enumerate() {
        window.push(element);
        if index + 1 >= width {
            run(window.whole());
            window.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use proptest::prelude::*;

    use super::*;

    /// A map `x -> factor x + offset` over a ring of integers: associative, not commutative, exact, and without an
    /// inverse where the factor is even.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Affine {
        factor: u64,
        offset: u64,
    }

    thread_local! {
        static COMPOSITIONS: Cell<usize> = const { Cell::new(0) };
    }

    impl Monoid for Affine {
        const NEUTRAL: Self = Self { factor: 1, offset: 0 };

        fn then(self, next: Self) -> Self {
            COMPOSITIONS.set(COMPOSITIONS.get() + 1);
            Self {
                factor: self.factor.wrapping_mul(next.factor),
                offset: self.offset.wrapping_add(self.factor.wrapping_mul(next.offset)),
            }
        }
    }

    fn composed(elements: &[Affine]) -> Affine {
        elements.iter().fold(Affine::NEUTRAL, |whole, &element| whole.then(element))
    }

    fn elements() -> impl Strategy<Value = Vec<Affine>> {
        let element = (any::<u64>(), any::<u64>()).prop_map(|(factor, offset)| Affine { factor, offset });
        prop::collection::vec(element, 0..60)
    }

    proptest! {
        #[test]
        fn runs_compose_to_what_their_elements_do(elements in elements(), width in 1..70usize) {
            let mut runs = Vec::new();
            for_each_run(elements.iter().copied(), width, |run| runs.push(run));
            let known: Vec<_> = elements.windows(width).map(composed).collect();
            prop_assert_eq!(runs, known);
        }

        #[test]
        fn any_order_of_pushes_and_pops_keeps_the_whole(
            elements in elements(), pops in prop::collection::vec(0..4usize, 60),
        ) {
            let mut window = SlidingWindow::with_capacity(3);
            let mut first = 0;
            for (count, &element) in elements.iter().enumerate() {
                window.push(element);
                for _ in 0..pops[count] {
                    // Beyond the last element nothing happens.
                    window.pop();
                    first = (first + 1).min(count + 1);
                }
                prop_assert_eq!(window.whole(), composed(&elements[first..=count]));
            }
        }
    }

    #[test]
    fn a_table_of_pairs_costs_about_five_compositions_an_entry() {
        // All windows of all widths over one sequence, as one direction of one slice of a table has them.
        for samples in [2usize, 3, 16, 64, 256] {
            COMPOSITIONS.set(0);
            let mut entries = 0;
            for width in 1..samples {
                let elements = (1..samples as u64).map(|i| Affine { factor: i, offset: i });
                for_each_run(elements, width, |_| entries += 1);
            }
            assert_eq!(entries, samples * (samples - 1) / 2);
            let cost = COMPOSITIONS.get() as f64 / entries as f64;
            println!("{samples} samples: {cost:.2} compositions an entry");
            assert!(cost <= 5.0, "{samples}: {cost}");
        }
    }
}
