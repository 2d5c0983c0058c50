#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "host/files/atomic_file.h"
#include "sw_model/base/error.h"

namespace emax {

// Files of this program's own, of records as they are in memory: they are read on the machine that
// wrote them, or one like it.
template <typename Record>
std::string_view bytes_of_records(std::span<const Record> records) {
  static_assert(std::is_standard_layout_v<Record>);
  return {reinterpret_cast<const char*>(records.data()), records.size_bytes()};
}

template <typename Record>
void write_records(const std::filesystem::path& path, std::span<const Record> records) {
  write_atomically(path, bytes_of_records(records));
}

// Gives the records to `take` in pieces. Throws Error if the file is missing or not whole.
template <typename Record>
void read_records(const std::filesystem::path& path,
                  const std::function<void(std::span<const Record>)>& take) {
  static_assert(std::is_standard_layout_v<Record>);
  constexpr std::size_t kRecords = 1 << 14;
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes(kRecords * sizeof(Record));
  std::vector<Record> records;
  while (file) {
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    if (count % sizeof(Record) != 0) break;
    records.resize(count / sizeof(Record));
    // Of an empty file there is nothing to copy to.
    if (count > 0) std::memcpy(static_cast<void*>(records.data()), bytes.data(), count);
    take(records);
    if (file.eof()) return;
  }
  throw Error(path.string() +
              ": a file of an unfinished run is damaged or missing; remove its "
              "folder and run the command again");
}

template <typename Record>
std::vector<Record> all_records(const std::filesystem::path& path) {
  std::vector<Record> all;
  read_records<Record>(path, [&](std::span<const Record> piece) {
    all.insert(all.end(), piece.begin(), piece.end());
  });
  return all;
}

}  // namespace emax
