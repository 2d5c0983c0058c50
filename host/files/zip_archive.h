#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "host/files/inflation_limit.h"
#include "host/files/input_file.h"

struct zip;         // of libzip
struct zip_source;  // of libzip

namespace emax {

// The entries of a ZIP archive in memory, inflated in pieces and never written anywhere. The input
// must outlive it.
class ZipReader {
 public:
  // Throws Error unless the input is a ZIP archive.
  explicit ZipReader(const InputFile& input);
  ~ZipReader();
  ZipReader(const ZipReader&) = delete;
  ZipReader& operator=(const ZipReader&) = delete;

  // Calls `take` with the pieces of the entry in turn. Names are compared without regard to case,
  // as the Open Packaging Conventions (ECMA-376 part 2) do. Throws Error if there is no such entry,
  // it is damaged or encrypted, or the entries read so far inflate beyond InflationLimit.
  void read(const std::string& name, const std::function<void(std::string_view)>& take);

 private:
  const InputFile& input_;
  InflationLimit limit_;
  zip* archive_ = nullptr;
  std::map<std::string, std::uint64_t> entries_;  // by names in lower case
};

// A ZIP archive with equal bytes for equal entries: no times.
class ZipWriter {
 public:
  ZipWriter();
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  void add(const std::string& name, std::string bytes);
  std::string finish();  // the archive; call this once, last

 private:
  std::deque<std::string> entries_;  // which libzip reads in finish()
  zip_source* bytes_ = nullptr;
  zip* archive_ = nullptr;
};

}  // namespace emax
