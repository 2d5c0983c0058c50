#pragma once

#include <cstddef>
#include <cstdint>

// The functions of src/lib.rs. Each returns one of the outcomes below; `why` is set where it is
// kRefused. A callback must not throw. It returns false to stop.
extern "C" {

struct ScanCratesText {
  char bytes[256];
};

enum ScanCratesOutcome : std::int32_t { kScanDone = 0, kScanRefused = 1, kScanStopped = 2 };

struct ScanCratesLazLayout {
  const std::uint8_t* vlr;
  std::size_t vlr_bytes;
  std::uint64_t offset;
  std::uint64_t record_bytes;
  std::uint64_t points;
};
std::int32_t scan_crates_laz(std::int32_t descriptor, const ScanCratesLazLayout* layout,
                             bool (*take)(void* user, const std::uint8_t* records,
                                          std::size_t count),
                             void* user, ScanCratesText* why);

struct ScanCratesE57File;
struct ScanCratesCoordinate {
  bool single;
  double scale;
};
struct ScanCratesE57Scan {
  std::uint64_t records;
  bool spherical;
  ScanCratesCoordinate coordinates[3];
  bool has_pose;
  double rotation[4];
  double translation[3];
  ScanCratesText name;
};
std::int32_t scan_crates_e57_open(std::int32_t descriptor, ScanCratesE57File** opened,
                                  std::size_t* scans, ScanCratesText* why);
std::int32_t scan_crates_e57_scan(const ScanCratesE57File* file, std::size_t index,
                                  ScanCratesE57Scan* scan, ScanCratesText* why);
std::int32_t scan_crates_e57_points(ScanCratesE57File* file, std::int32_t descriptor,
                                    std::size_t index,
                                    bool (*take)(void* user, const double* points,
                                                 const std::uint8_t* states, std::size_t count),
                                    void* user, ScanCratesText* why);
void scan_crates_e57_close(ScanCratesE57File* file);

std::int32_t scan_crates_panic(ScanCratesText* why);
}
