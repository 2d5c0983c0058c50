#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "sw_model/base/error.h"

namespace emax::test {

// The message of the Error that `act` throws; a failure of the test when it throws none.
template <class Act>
std::string message_of(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

// What every message owes: one line, the file, the fault, a remedy after a semicolon.
inline void expect_clear(const std::string& message, std::string_view file, std::string_view fault,
                         std::string_view remedy) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_TRUE(message.starts_with(file)) << message;
  const std::size_t split = message.rfind("; ");
  ASSERT_NE(split, std::string::npos) << message;
  EXPECT_NE(message.substr(0, split).find(fault), std::string::npos) << message;
  EXPECT_NE(message.substr(split).find(remedy), std::string::npos) << message;
}

}  // namespace emax::test
