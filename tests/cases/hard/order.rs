//! Hard cases of order.

use super::check;

#[test]
fn hard_cycles() {
    check("cycles");
}

#[test]
fn hard_nearly_cyclic() {
    check("nearly-cyclic");
}
