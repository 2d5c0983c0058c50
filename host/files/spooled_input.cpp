#include "host/files/spooled_input.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/files/inflation_limit.h"
#include "host/files/nameless_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

constexpr std::string_view kUnpacked = "cannot be unpacked";
constexpr std::size_t kPieceBytes = std::size_t{1} << 17;

// The next bytes at `offset`, or as they come where that is nothing; 0 at the end.
std::size_t read_piece(const NamedInput& input, int descriptor, std::optional<std::uint64_t> offset,
                       std::span<char> to) {
  while (true) {
    const ssize_t n = offset ? pread(descriptor, to.data(), to.size(), static_cast<off_t>(*offset))
                             : read(descriptor, to.data(), to.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      input.fail(fmt::format("cannot be read ({})", std::strerror(errno)), "check the disk");
    return static_cast<std::size_t>(n);
  }
}

[[noreturn]] void fail_as_damaged(const NamedInput& input, const char* why) {
  input.fail(fmt::format("its compressed data is damaged ({})", why), kExportAgain);
}

// Both inflate a piece into `write`, and end() throws Error in the middle of a member or frame.
class Gunzip {
 public:
  explicit Gunzip(const NamedInput& input) : input_(input) {
    constexpr int kWindowOfGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, kWindowOfGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Gunzip() { inflateEnd(&stream_); }
  Gunzip(const Gunzip&) = delete;
  Gunzip& operator=(const Gunzip&) = delete;

  template <class Write>
  void take(std::span<char> piece, const Write& write) {
    stream_.next_in = reinterpret_cast<Bytef*>(piece.data());
    stream_.avail_in = static_cast<uInt>(piece.size());
    do {
      if (is_done_) {  // another member follows
        if (inflateReset(&stream_) != Z_OK) fail_as_damaged(input_, "gzip");
        is_done_ = false;
      }
      stream_.next_out = reinterpret_cast<Bytef*>(out_.data());
      stream_.avail_out = static_cast<uInt>(out_.size());
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
        fail_as_damaged(input_, stream_.msg != nullptr ? stream_.msg : "gzip");
      }
      is_done_ = status == Z_STREAM_END;
      write(std::string_view(out_.data(), out_.size() - stream_.avail_out));
    } while (stream_.avail_in > 0 || (stream_.avail_out == 0 && !is_done_));
  }
  void end() const {
    if (!is_done_) fail_as_damaged(input_, "it ends too early");
  }

 private:
  const NamedInput& input_;
  z_stream stream_{};
  bool is_done_ = false;
  std::array<char, kPieceBytes> out_;
};

class Unzstd {
 public:
  explicit Unzstd(const NamedInput& input)
      : input_(input), stream_(ZSTD_createDStream(), ZSTD_freeDStream) {
    if (!stream_) throw std::bad_alloc();
  }

  template <class Write>
  void take(std::span<char> piece, const Write& write) {
    ZSTD_inBuffer in{piece.data(), piece.size(), 0};
    ZSTD_outBuffer out{out_.data(), out_.size(), 0};
    do {
      out.pos = 0;
      left_ = ZSTD_decompressStream(stream_.get(), &out, &in);
      if (ZSTD_isError(left_) != 0) fail_as_damaged(input_, ZSTD_getErrorName(left_));
      write(std::string_view(out_.data(), out.pos));
    } while (in.pos < in.size || (out.pos == out.size && left_ > 0));
  }
  void end() const {
    if (left_ != 0) fail_as_damaged(input_, "it ends too early");
  }

 private:
  const NamedInput& input_;
  std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream_;
  std::size_t left_ = 1;  // 0 at the end of a frame
  std::array<char, kPieceBytes> out_;
};

template <class Inflater>
int inflated_by(const NamedInput& input, int descriptor, std::uint64_t size) {
  NamelessFile spool(input, kUnpacked);
  InflationLimit limit(input, size);
  const auto inflater = std::make_unique<Inflater>(input);
  std::vector<char> piece(kPieceBytes);
  std::uint64_t at = 0;
  while (const std::size_t n = read_piece(input, descriptor, at, piece)) {
    inflater->take({piece.data(), n}, [&](std::string_view bytes) {
      limit.spend(bytes.size());
      spool.append(bytes);
    });
    at += n;
  }
  inflater->end();
  return spool.release();
}

bool is_copied = false;

NamedInput named_standard_input() { return {std::string(kStandardInputInMessages)}; }

int copied_standard_input() {
  const NamedInput input = named_standard_input();
  NamelessFile spool(input, kUnpacked);
  spool.append(standard_input_head());
  is_copied = true;
  std::vector<char> piece(kPieceBytes);
  while (const std::size_t n = read_piece(input, STDIN_FILENO, std::nullopt, piece)) {
    spool.append({piece.data(), n});
  }
  const std::size_t n = read_piece(input, spool.descriptor(), 0, piece);
  const Compression compression = compression_of_content({piece.data(), n});
  if (compression == Compression::kNone) return spool.release();
  return inflated(input, spool.descriptor(), spool.size(), compression);
}

}  // namespace

Compression compression_of(const std::filesystem::path& path) {
  const std::string ending = lower_case_ending(path);
  return ending == ".gz"    ? Compression::kGzip
         : ending == ".zst" ? Compression::kZstandard
                            : Compression::kNone;
}

Compression compression_of_content(std::string_view head) {
  if (head.starts_with("\x1f\x8b")) return Compression::kGzip;
  if (head.starts_with("\x28\xb5\x2f\xfd")) return Compression::kZstandard;
  return Compression::kNone;
}

int inflated(const NamedInput& input, int descriptor, std::uint64_t size, Compression compression) {
  return compression == Compression::kGzip ? inflated_by<Gunzip>(input, descriptor, size)
                                           : inflated_by<Unzstd>(input, descriptor, size);
}

std::string head_of_pipe(const NamedInput& input, int descriptor) {
  std::string head(kHeadBytes, '\0');
  std::size_t used = 0;
  while (const std::size_t n =
             read_piece(input, descriptor, std::nullopt, std::span(head).subspan(used))) {
    used += n;
    if (used == head.size()) break;
  }
  head.resize(used);
  return head;
}

const std::string& standard_input_head() {
  static const std::string head = head_of_pipe(named_standard_input(), STDIN_FILENO);
  return head;
}

bool standard_input_is_copied() { return is_copied; }

int standard_input() {
  static const int copy = copied_standard_input();
  const int descriptor = fcntl(copy, F_DUPFD_CLOEXEC, 0);
  if (descriptor < 0) {
    throw Error(fmt::format("{}: cannot be read ({}); give a file", kStandardInputInMessages,
                            std::strerror(errno)));
  }
  return descriptor;
}

}  // namespace emax
