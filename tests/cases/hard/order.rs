//! Hard cases of order.

use super::check;

#[test]
fn hard_cycles() {
    check("cycles");
}
