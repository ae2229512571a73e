//! The scene file, its defaults, and the plan of what will be computed.
