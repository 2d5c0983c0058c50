#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "host/files/file_content.h"
#include "host/files/las_header.h"
#include "host/files/pipe_input.h"
#include "host/geometry/bounds.h"

namespace emax {

// A cloud as LAS, without compression, that is read once as it comes through a pipe.
class LasStream {
 public:
  // Reads what stands before the points. `path`: one of which is_pipe() is true. Throws Error.
  explicit LasStream(const std::filesystem::path& path);

  // What the header promises. It is not checked here against the points.
  std::uint64_t points() const { return header_.points; }
  // Throws Error where it is no box.
  Bounds box() const;

  const NamedInput& input() const { return pipe_; }
  std::optional<Unit> unit() const { return unit_of_las(pipe_, records_); }
  double resolution() const { return resolution_of_las(header_); }

  // As read_las(), once, up to the end of the stream. Throws Error where it has more or fewer
  // points than the header promises.
  void read(const CloudReadOptions& options, FileContent& content);

 private:
  LasBytes bytes();

  PipeInput pipe_;
  std::uint64_t size_ = 0;
  LasHeader header_;
  LasRecords records_;
};

// The remedy where a stream cannot be measured as it comes.
inline constexpr std::string_view kStoreFirst = "store the scan in a file first, and give that";

}  // namespace emax
