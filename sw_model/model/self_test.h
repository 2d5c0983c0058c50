#pragma once

namespace emax {

// Throws Error unless binary32 arithmetic keeps the numeric contract (docs/numerics.md) in this
// thread: nearest even, no contraction, flushing off outside kernel calls and right inside them.
// Called at the start of every program, and again once libraries that might have changed the
// processor's mode are loaded. Microseconds.
void verify_arithmetic();

}  // namespace emax
