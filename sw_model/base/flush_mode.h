#pragma once

#include <cfenv>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <cstdint>
#endif

namespace emax {

// Whether this thread's floating point flushes subnormals (results or operands). The flag acts on
// doubles too, so frames, oracle and certificate require it off and only kernel calls turn it on.
inline bool flush_mode_is_on() {
#if defined(__SSE2__)
  return (_mm_getcsr() & (_MM_FLUSH_ZERO_MASK | _MM_DENORMALS_ZERO_MASK)) != 0;
#elif defined(__aarch64__)
  std::uint64_t fpcr;
  asm volatile("mrs %0, fpcr" : "=r"(fpcr));
  return (fpcr & (1ull << 24)) != 0;
#else
#error "emax: no flush mode known for this processor"
#endif
}

// While this object lives, subnormal operands and results of this thread are flushed.
class ScopedFlushMode {
 public:
#if defined(__SSE2__)
  ScopedFlushMode() : saved_(_mm_getcsr()) {
    _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
  }
  ~ScopedFlushMode() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
#elif defined(__aarch64__)
  ScopedFlushMode() {
    asm volatile("mrs %0, fpcr" : "=r"(saved_));
    asm volatile("msr fpcr, %0" : : "r"(saved_ | (1ull << 24)));
  }
  ~ScopedFlushMode() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }

 private:
  std::uint64_t saved_;
#endif

 public:
  ScopedFlushMode(const ScopedFlushMode&) = delete;
  ScopedFlushMode& operator=(const ScopedFlushMode&) = delete;
};

// Throws std::logic_error while flushing is on. `work` names what must not be flushed.
void require_no_flush(const char* work);

}  // namespace emax
