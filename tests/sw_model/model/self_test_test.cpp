#include "sw_model/model/self_test.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <optional>
#include <string>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"

namespace emax {
namespace test {
std::optional<std::string> probe_with_contraction();
}  // namespace test
namespace {

std::string fault() {
  try {
    verify_arithmetic();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SelfTest, PassesAsBuilt) { EXPECT_EQ(fault(), ""); }

TEST(SelfTest, CatchesFlushingThatIsLive) {
  const ScopedFlushMode flush;
  EXPECT_NE(fault().find("flushed"), std::string::npos) << fault();
}

TEST(SelfTest, CatchesEveryWrongRoundingMode) {
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const std::string caught = fault();
    std::fesetround(FE_TONEAREST);
    EXPECT_NE(caught.find("rounding mode"), std::string::npos) << "mode " << mode;
  }
}

#if defined(__x86_64__)
TEST(SelfTest, CatchesContraction) {
  ASSERT_TRUE(__builtin_cpu_supports("fma")) << "this test needs a processor with FMA";
  EXPECT_NE(test::probe_with_contraction().value_or("").find("contracted"), std::string::npos);
}

// What a wrong flush would be: operands flushed but results kept, and the reverse.
TEST(SelfTest, CatchesHalfOfTheFlushMode) {
  const unsigned saved = _mm_getcsr();
  for (const unsigned half : {_MM_FLUSH_ZERO_ON, _MM_DENORMALS_ZERO_ON}) {
    _mm_setcsr(saved | half);
    const std::string caught = fault();
    _mm_setcsr(saved);
    EXPECT_NE(caught.find("flushed"), std::string::npos);
  }
}
#endif

}  // namespace
}  // namespace emax
