// Only this header depends on the compiler that reads the kernel: an HLS compiler has its own
// streams and takes pragmas; an ordinary compiler gets a queue and ignores the pragmas.
#pragma once

#if defined(__SYNTHESIS__) || defined(__VITIS_HLS__)

#include <hls_stream.h>

#define EMAX_PRAGMA_TEXT(text) _Pragma(#text)
#define EMAX_HLS(directive) EMAX_PRAGMA_TEXT(HLS directive)

namespace emax {
template <class Word>
using Stream = hls::stream<Word>;
}  // namespace emax

#else

#include <cstddef>
#include <deque>

#define EMAX_HLS(directive)

namespace emax {

// A queue with the calls of hls::stream. Reading an empty stream is the caller's error.
template <class Word>
class Stream {
 public:
  bool empty() const { return words_.empty(); }
  std::size_t size() const { return words_.size(); }
  void write(const Word& word) { words_.push_back(word); }
  Word read() {
    const Word word = words_.front();
    words_.pop_front();
    return word;
  }
  bool read_nb(Word& word) {
    if (empty()) {
      return false;
    }
    word = read();
    return true;
  }

 private:
  std::deque<Word> words_;
};

}  // namespace emax

#endif
