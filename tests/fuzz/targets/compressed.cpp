// Text of points behind .gz and .zst.
#include <zlib.h>
#include <zstd.h>

#include "host/files/cloud_file.h"
#include "tests/fuzz/files.h"

namespace emax::fuzz {
namespace {

constexpr std::string_view kPoints = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

std::string in_gzip() {
  constexpr int kWindowOfGzip = 16 + MAX_WBITS, kMemoryLevel = 8;
  std::string bytes(1000, '\0'), points(kPoints);
  z_stream stream{};
  bool is_done = deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kWindowOfGzip,
                              kMemoryLevel, Z_DEFAULT_STRATEGY) == Z_OK;
  stream.next_in = reinterpret_cast<Bytef*>(points.data());
  stream.avail_in = static_cast<uInt>(points.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  is_done = is_done && deflate(&stream, Z_FINISH) == Z_STREAM_END;
  require(is_done && deflateEnd(&stream) == Z_OK, "zlib compresses the seed");
  bytes.resize(stream.total_out);
  return bytes;
}

std::string in_zstandard() {
  std::string bytes(1000, '\0');
  const std::size_t size =
      ZSTD_compress(bytes.data(), bytes.size(), kPoints.data(), kPoints.size(), 1);
  require(ZSTD_isError(size) == 0, "Zstandard compresses the seed");
  bytes.resize(size);
  return bytes;
}

}  // namespace

void read(Input input) {
  const bool is_gzip = !input.empty() && input.front() == 0x1f;
  const PointCloud cloud = read_cloud(write(is_gzip ? "file.xyz.gz" : "file.xyz.zst", input));
  require(!cloud.points.empty(), "a cloud has points");
}

std::vector<std::string> seeds() { return {in_gzip(), in_zstandard()}; }

}  // namespace emax::fuzz
