#pragma once

#include <cstddef>
#include <functional>

namespace emax {

// The number of threads that this processor runs at a time; at least 1.
std::size_t processor_threads();

// Calls work(thread, first, last) for pieces of [0, count), each of `piece` items or, at the end,
// what is left. Runs on `threads` threads, the caller's among them. Which thread gets which piece
// depends on timing, so results of `work` must not depend on the thread. Rethrows the first
// exception after all threads have ended.
void in_pieces(std::size_t threads, std::size_t count, std::size_t piece,
               const std::function<void(std::size_t, std::size_t, std::size_t)>& work);

}  // namespace emax
