// Compressed files, folders of scans and standard input.

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/files/scan_folder.h"
#include "host/files/sha256.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

const std::string kText = "1 2 3\n4 5 6\n7 8 9.5\n";
const std::vector<Point> kPoints = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5}};

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string zstandard(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

class InputPlaces : public ::testing::Test {
 protected:
  std::vector<Point> read(std::string_view name, std::string_view bytes) {
    return read_cloud(folder_.write(name, bytes)).points;
  }
  void expect_refused(const std::filesystem::path& path, std::string_view fault,
                      std::string_view remedy) {
    SCOPED_TRACE(fault);
    expect_clear(message_of([&] { read_cloud(path); }), path.string(), fault, remedy);
  }

  TemporaryFolder folder_;
};

TEST_F(InputPlaces, CompressedFilesAreInflated) {
  EXPECT_EQ(read("a.xyz.gz", gzipped(kText)), kPoints);
  EXPECT_EQ(read("a.XYZ.ZST", zstandard(kText)), kPoints);
  // Members and frames follow each other.
  EXPECT_EQ(read("b.xyz.gz", gzipped(kText.substr(0, 8)) + gzipped(kText.substr(8))), kPoints);
  EXPECT_EQ(read("b.xyz.zst", zstandard(kText.substr(0, 8)) + zstandard(kText.substr(8))), kPoints);
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const MeshFormat format : {MeshFormat::kPly, MeshFormat::kStl, MeshFormat::kGlb}) {
    const std::string name = "m" + std::string(mesh_endings()[static_cast<std::size_t>(format)]);
    const auto path = folder_.write(name + ".gz", gzipped(mesh_bytes(mesh, format)));
    EXPECT_EQ(read_mesh(path).triangles, mesh.triangles) << name;
  }
  // More than a piece.
  std::string large;
  for (int i = 0; i < 60000; ++i) large += std::to_string(i) + " 0 1\n";
  EXPECT_EQ(read("large.xyz.gz", gzipped(large)).size(), 60000u);
  EXPECT_EQ(read("large.xyz.zst", zstandard(large)).size(), 60000u);
}

TEST_F(InputPlaces, DamagedCompressedFilesAreRefused) {
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"a.xyz.gz", gzipped(kText)},
                                    {"a.xyz.zst", zstandard(kText)}}) {
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      expect_refused(folder_.write(name, bytes.substr(0, size)), "compressed data is damaged",
                     "copy or export");
    }
    expect_refused(folder_.write(name, kText), "compressed data is damaged", "copy or export");
    expect_refused(folder_.write(name, bytes + "more"), "compressed data is damaged", "copy");
  }
  expect_refused(folder_.write("a.doc.gz", gzipped(kText)), "unknown ending \".doc\"", "clouds");
  const std::string bomb(std::size_t{80} << 20, ' ');
  expect_refused(folder_.write("a.xyz.gz", gzipped(bomb)), "more than 100 times",
                 "another program");
  expect_refused(folder_.write("a.xyz.zst", zstandard(bomb)), "more than 100 times", "another");
}

TEST_F(InputPlaces, AFolderOfScansIsOneCloud) {
  const auto scans = folder_ / "scans";
  std::filesystem::create_directory(scans);
  folder_.write("scans/b.xyz", "0 0 1\n");
  folder_.write("scans/a.ptx",
                "3\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n10 0 0 1\n"
                "1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.5\n");
  folder_.write("scans/c.xyz.gz", gzipped("7 7 7\n"));
  folder_.write("scans/readme.md", "no cloud");
  folder_.write("scans/.hidden.xyz", "no cloud");
  const PointCloud cloud = read_cloud(scans);
  EXPECT_EQ(cloud.points, (std::vector<Point>{{11, 2, 3}, {14, 5, 6}, {0, 0, 1}, {7, 7, 7}}));
  EXPECT_EQ(cloud.file_index, (std::vector<std::uint32_t>{0, 2, 3, 4}));
  ASSERT_EQ(cloud.scans.size(), 3u);
  EXPECT_EQ(cloud.scans[1].name, "b.xyz");
  EXPECT_EQ(cloud.scans[1].begin, 2u);
  EXPECT_EQ(cloud.scans[2].begin, 3u);
  EXPECT_EQ(cloud.left_out.size(), 1u);
  EXPECT_EQ(name_of_input(scans / ""), "scans");

  const std::string before = sha256_of_input(scans);
  EXPECT_EQ(before,
            sha256(sha256_of_file(scans / "a.ptx") + "  a.ptx\n" + sha256_of_file(scans / "b.xyz") +
                   "  b.xyz\n" + sha256_of_file(scans / "c.xyz.gz") + "  c.xyz.gz\n"));
  std::filesystem::rename(scans / "b.xyz", scans / "d.xyz");
  EXPECT_NE(before, sha256_of_input(scans)) << "names count";

  folder_.write("scans/e.xyz", "1 2\n");
  expect_refused(scans, "e.xyz: ", "");
  std::filesystem::remove(scans / "e.xyz");
  write_mesh(scans / "m.3mf", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  expect_refused(scans, "m.3mf: is in mm, but a.ptx", "one unit");
  const auto empty = folder_ / "empty";
  std::filesystem::create_directory(empty);
  expect_refused(empty, "is a folder in which no file is a cloud", "name a file");
}

TEST_F(InputPlaces, StandardInputIsReadOnceAndToldByItsContent) {
  const auto path = folder_.write("any", zstandard("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int before = dup(STDIN_FILENO);
  ASSERT_EQ(dup2(file, STDIN_FILENO), STDIN_FILENO);
  EXPECT_EQ(read_mesh("-").triangles.size(), 1u);
  EXPECT_EQ(read_cloud("-").points.size(), 3u);
  EXPECT_EQ(sha256_of_input("-"), sha256("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(bytes_of_input("-"), 36u);
  dup2(before, STDIN_FILENO);
  close(before);
  close(file);
}

}  // namespace
}  // namespace emax::test
