#include "testbench/stimuli/words.h"

#include <iterator>

#include "sw_model/base/float_bits.h"

namespace emax {
namespace {

constexpr std::uint32_t kSpecialWords[] = {
    0x00000000, 0x80000000, 0x00000001, 0x807fffff, 0x00800000, 0x80800000,
    0x3f800000, 0xbf800000, 0x3f7fffff, 0x7f7fffff, 0xff7fffff, 0x7f800000,
    0xff800000, 0x7fc00000, 0xffc00000, 0x7f800001, 0xffffffff};

}  // namespace

std::uint32_t any_word(Random& random) {
  switch (random.below(4)) {
    case 0:
      return kSpecialWords[random.below(std::size(kSpecialWords))];
    case 1:
      return random.word();
    default:
      return float_bits(static_cast<float>(random.uniform(-1, 1)));
  }
}

}  // namespace emax
