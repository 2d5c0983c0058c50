#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "sw_model/base/error.h"

struct ScanCratesE57File;

// What Rust crates read for emax: E57 files (crate e57) and the compressed points of LAZ files
// (crate laz). Both read from an open file as they go and keep a few thousand points at a time.
// Before they allocate memory for a count that the file claims, it is compared with the file.
namespace emax {

// What a crate has against the file, one line without the file's name. A panic of a crate is one.
class CrateRefusal : public Error {
 public:
  using Error::Error;
};

struct LazLayout {
  std::span<const std::uint8_t> vlr;  // the content of the record "laszip encoded"
  std::uint64_t offset;               // of the points in the file
  std::uint64_t record_bytes;         // of a point
  std::uint64_t points;
};
// Calls `take` with the records of all points in their order, in pieces of whole records. Throws
// CrateRefusal, and what `take` throws. Damage in a chunk is found where it changes the chunk's
// length; other damage gives wrong records, as the format has no checksums.
void read_laz(int descriptor, const LazLayout& layout,
              const std::function<void(std::span<const std::uint8_t>)>& take);

// How a coordinate of an E57 file is stored.
struct E57Coordinate {
  bool single = false;  // as binary32
  double scale = 0;     // the step of integers; 0: a float
};

struct E57Scan {
  std::string name;
  std::uint64_t records = 0;
  bool spherical = false;  // range, azimuth and elevation in place of x, y, z
  std::array<E57Coordinate, 3> coordinates{};
  bool has_pose = false;
  std::array<double, 4> rotation{};  // w, x, y, z
  std::array<double, 3> translation{};
};

// Throws CrateRefusal, as for a page whose checksum is wrong.
class E57File {
 public:
  enum State : std::uint8_t { kValid, kOnlyDirection, kInvalid };

  explicit E57File(int descriptor);  // which must outlive the object
  ~E57File();
  E57File(const E57File&) = delete;
  E57File& operator=(const E57File&) = delete;

  std::size_t scans() const { return scans_; }
  E57Scan scan(std::size_t index) const;
  // Calls `take` with the points of the scan in their order, in pieces: three coordinates, without
  // the pose, and the state of each point.
  void read_points(
      std::size_t index,
      const std::function<void(std::span<const double>, std::span<const std::uint8_t>)>& take);

 private:
  int descriptor_;
  ::ScanCratesE57File* file_ = nullptr;
  std::size_t scans_ = 0;
};

// Lets the Rust side panic, for tests: throws CrateRefusal.
void panic_in_crates();

}  // namespace emax
