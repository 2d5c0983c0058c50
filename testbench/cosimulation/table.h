// The summary of a co-simulation, with a row for each test.
#pragma once

#include <string>

#include "testbench/cosimulation/cosimulation.h"

namespace emax {

class Table {
 public:
  void print_head() const;
  void print_row(const TestReport& report);
  // The sum of all rows so far.
  void print_sum() const;
  // Shows the progress on a terminal, at most a few times a second.
  void show_progress(const std::string& test, double share);

 private:
  TestReport sum_;
  double last_shown_ = 0;
};

}  // namespace emax
