#include "host/scan_crates/scan_crates.h"

#include <algorithm>
#include <exception>
#include <iterator>

#include "host/scan_crates/c_interface.h"

namespace emax {
namespace {

// What a callback threw must not pass through Rust, so it waits here.
template <class Take>
struct Callback {
  const Take& take;
  std::exception_ptr thrown = nullptr;

  template <class... Arguments>
  bool call(Arguments... arguments) noexcept {
    try {
      take(arguments...);
      return true;
    } catch (...) {
      thrown = std::current_exception();
      return false;
    }
  }
};

void require_done(std::int32_t outcome, const ScanCratesText& why,
                  const std::exception_ptr& thrown = nullptr) {
  if (thrown) std::rethrow_exception(thrown);
  if (outcome != kScanDone) throw CrateRefusal(why.bytes);
}

}  // namespace

void read_laz(int descriptor, const LazLayout& layout,
              const std::function<void(std::span<const std::uint8_t>)>& take) {
  struct User {
    Callback<std::function<void(std::span<const std::uint8_t>)>> callback;
    std::size_t record_bytes;
  };
  User user{{take}, layout.record_bytes};
  const ScanCratesLazLayout c_layout{layout.vlr.data(), layout.vlr.size(), layout.offset,
                                     layout.record_bytes, layout.points};
  ScanCratesText why{};
  const std::int32_t outcome = scan_crates_laz(
      descriptor, &c_layout,
      [](void* to, const std::uint8_t* records, std::size_t count) {
        auto& u = *static_cast<User*>(to);
        return u.callback.call(std::span(records, count * u.record_bytes));
      },
      &user, &why);
  require_done(outcome, why, user.callback.thrown);
}

E57File::E57File(int descriptor) : descriptor_(descriptor) {
  ScanCratesText why{};
  require_done(scan_crates_e57_open(descriptor, &file_, &scans_, &why), why);
}

E57File::~E57File() { scan_crates_e57_close(file_); }

E57Scan E57File::scan(std::size_t index) const {
  ScanCratesE57Scan read{};
  ScanCratesText why{};
  require_done(scan_crates_e57_scan(file_, index, &read, &why), why);
  E57Scan scan;
  scan.name = read.name.bytes;
  scan.records = read.records;
  scan.spherical = read.spherical;
  std::ranges::transform(read.coordinates, scan.coordinates.begin(),
                         [](const ScanCratesCoordinate& c) {
                           return E57Coordinate{c.single, c.scale};
                         });
  scan.has_pose = read.has_pose;
  std::ranges::copy(read.rotation, scan.rotation.begin());
  std::ranges::copy(read.translation, scan.translation.begin());
  return scan;
}

void E57File::read_points(
    std::size_t index,
    const std::function<void(std::span<const double>, std::span<const std::uint8_t>)>& take) {
  using User =
      Callback<std::function<void(std::span<const double>, std::span<const std::uint8_t>)>>;
  User user{take};
  ScanCratesText why{};
  const std::int32_t outcome = scan_crates_e57_points(
      file_, descriptor_, index,
      [](void* to, const double* points, const std::uint8_t* states, std::size_t count) {
        return static_cast<User*>(to)->call(std::span(points, 3 * count), std::span(states, count));
      },
      &user, &why);
  require_done(outcome, why, user.thrown);
}

void panic_in_crates() {
  ScanCratesText why{};
  require_done(scan_crates_panic(&why), why);
}

}  // namespace emax
