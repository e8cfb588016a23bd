//! The robot and the body it hops on.
