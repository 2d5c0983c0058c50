#pragma once

#include <cstddef>
#include <functional>

namespace emax {

// As many as this processor runs at a time; at least 1.
std::size_t processor_threads();

// Calls work(thread, first, last) for pieces of [0, count), each of `piece` or what is left, on so
// many threads, the caller's among them. Which thread has which piece depends on time: work must
// not. The first exception comes out, after all threads have ended.
void in_pieces(std::size_t threads, std::size_t count, std::size_t piece,
               const std::function<void(std::size_t, std::size_t, std::size_t)>& work);

}  // namespace emax
