// sanitizer_fault address|undefined|thread: has the fault that the sanitizer of that name reports.
#include <limits>
#include <string_view>
#include <thread>
#include <vector>

namespace {

int shared = 0;

void add_to_shared() {
  for (int i = 0; i < 1000; ++i) ++shared;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view kind = count > 1 ? arguments[1] : "";
  // What the compiler does not know when it compiles.
  const auto one = static_cast<std::size_t>(count) - 1;
  if (kind == "address") {
    const std::vector<int> values(one);
    return values.data()[one];
  }
  if (kind == "undefined") return std::numeric_limits<int>::max() + static_cast<int>(one);
  if (kind == "thread") {
    const std::jthread other(add_to_shared);
    add_to_shared();
  }
  return 0;
}
