//! Draws one scene with every method, and shows what accuracy costs in time.
