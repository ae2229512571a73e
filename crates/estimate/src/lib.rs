//! How wrong a picture will be, how wrong it is, and the cheapest way to one that is right enough.
