#include "sw_model/base/error.h"

#include <gtest/gtest.h>

namespace emax {
namespace {

// Found in a configuration: the message of its parser held a line break of the file.
TEST(Error, IsOneLineWhateverTheMessageHolds) {
  EXPECT_STREQ(Error("a.toml:2: \"t\n\x1b[2J\x7f\" is no value; mend it").what(),
               "a.toml:2: \"t??[2J?\" is no value; mend it");
  EXPECT_STREQ(DeviceFailure("tty:\r").what(), "tty:?");
}

TEST(Error, KeepsNamesInAnyLanguage) {
  EXPECT_STREQ(Error("caf\u00e9 \u70b9.ply: no such file").what(),
               "caf\u00e9 \u70b9.ply: no such file");
}

}  // namespace
}  // namespace emax
