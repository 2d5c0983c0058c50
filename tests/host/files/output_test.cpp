#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

TEST(AtomicFile, WritesWholeAndReplaces) {
  const TemporaryFolder folder;
  write_atomically(folder / "out.json", "first");
  write_atomically(folder / "out.json", [](AtomicFile& file) {
    file.write("sec");
    file.write("ond");
  });
  EXPECT_EQ(bytes_of(folder / "out.json"), "second");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LeavesTheOldFileAndNoTemporaryWhenFillingThrows) {
  const TemporaryFolder folder;
  write_atomically(folder / "out.json", "old");
  std::filesystem::path temporary;
  EXPECT_THROW(write_atomically(folder / "out.json",
                                [&](AtomicFile& file) {
                                  file.write("half");
                                  temporary = file.temporary();
                                  EXPECT_EQ(folder.entries(), 2);
                                  throw std::runtime_error("interrupted");
                                }),
               std::runtime_error);
  EXPECT_EQ(temporary.parent_path(), (folder / "x").parent_path());
  EXPECT_EQ(bytes_of(folder / "out.json"), "old");
  EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicFile, LeavesNothingWhenTheDiskIsFull) {
  // A limit on the size of files stands in for the full disk: write() fails after 4096 bytes.
  const TemporaryFolder folder;
  const std::string path = (folder / "out.ply").string();
  rlimit unlimited{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  rlimit small = unlimited;
  small.rlim_cur = 4096;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string message = message_of([&] { write_atomically(path, std::string(100000, 'x')); });
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
  std::signal(SIGXFSZ, handler);
  expect_clear(message, path, "cannot be written (File too large)", "space on the disk");
  EXPECT_EQ(folder.entries(), 0);
}

TEST(AtomicFile, AppearsWhenItIsPublished) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "out.json");
  file.write("all");
  file.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "out.json"));
  file.publish();
  EXPECT_EQ(bytes_of(folder / "out.json"), "all");
}

TEST(WriteTogether, WritesAllOrNone) {
  const TemporaryFolder folder;
  folder.write("a.ply", "old");
  const std::vector<OutputFile> files = {{folder / "a.ply", "a"}, {folder / "no/b.json", "b"}};
  expect_clear(message_of([&] { write_together(files); }), (folder / "no/b.json").string(),
               "cannot be written", "folder");
  EXPECT_EQ(bytes_of(folder / "a.ply"), "old");
  EXPECT_EQ(folder.entries(), 1);
  std::filesystem::create_directory(folder / "no");
  write_together(files);
  EXPECT_EQ(bytes_of(folder / "a.ply"), "a");
  EXPECT_EQ(bytes_of(folder / "no/b.json"), "b");
}

TEST(AtomicFile, FollowsASymbolicLink) {
  const TemporaryFolder folder;
  folder.write("real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  write_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(bytes_of(folder / "real.txt"), "new");

  // Also to a file that is not there yet, over several links; not in a circle.
  std::filesystem::create_directory(folder / "far");
  std::filesystem::create_symlink("far/next.txt", folder / "early.txt");
  std::filesystem::create_symlink("../made.txt", folder / "far/next.txt");
  write_atomically(folder / "early.txt", "made");
  EXPECT_EQ(bytes_of(folder / "made.txt"), "made");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "early.txt"));
  std::filesystem::create_symlink("circle.txt", folder / "circle.txt");
  expect_clear(message_of([&] { write_atomically(folder / "circle.txt", "new"); }),
               (folder / "circle.txt").string(), "cannot be written", "folder");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "circle.txt"));
}

TEST(AtomicFile, KeepsThePermissionsOfWhatItReplaces) {
  const TemporaryFolder folder;
  folder.write("shared", "old");
  const auto mode = std::filesystem::perms::owner_all | std::filesystem::perms::group_write;
  std::filesystem::permissions(folder / "shared", mode);
  write_atomically(folder / "shared", "new");
  EXPECT_EQ(std::filesystem::status(folder / "shared").permissions(), mode);
  EXPECT_EQ(bytes_of(folder / "shared"), "new");
}

TEST(AtomicFile, HasThePermissionsOfAnOrdinaryFile) {
  const TemporaryFolder folder;
  folder.write("ordinary", "x");
  write_atomically(folder / "atomic", "x");
  EXPECT_EQ(std::filesystem::status(folder / "atomic").permissions(),
            std::filesystem::status(folder / "ordinary").permissions());
}

TEST(CheckOutput, AcceptsWhatCanBeWrittenAndLeavesNoTrace) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(check_output(folder / "new.PLY", mesh_endings()));
  EXPECT_EQ(folder.entries(), 0);
  folder.write("old.ply", "keep");
  EXPECT_NO_THROW(check_output(folder / "old.ply", mesh_endings()));
  EXPECT_EQ(bytes_of(folder / "old.ply"), "keep");
}

TEST(CheckOutput, RefusesWhatCannot) {
  const TemporaryFolder folder;
  const auto expect_refused = [](const std::filesystem::path& path, std::string_view fault,
                                 std::string_view remedy) {
    expect_clear(message_of([&] { check_output(path, mesh_endings()); }), path.string(), fault,
                 remedy);
  };
  expect_refused(folder / "out.gltf", "unknown ending \".gltf\"", ".ply, .obj, .stl, .off");
  expect_refused(folder / "out", "unknown ending", ".ply");
  expect_refused(folder / "no/such/out.ply", "does not exist", "create it");
  std::filesystem::create_directory(folder / "dir.ply");
  expect_refused(folder / "dir.ply", "is a folder", "name a file");
  folder.write("file", "x");
  expect_refused(folder / "file" / "out.ply", "does not exist", "create it");
  std::filesystem::create_symlink("/dev/null", folder / "null.ply");
  expect_refused(folder / "null.ply", "not a regular file", "another output");
  std::filesystem::create_symlink("no/such/out.ply", folder / "link.ply");
  expect_refused(folder / "link.ply", "does not exist", "create it");
  // No file can be created here, not even by root.
  expect_refused("/proc/out.ply", "cannot be written", "permissions");
}

TEST(Sha256, KnownValues) {
  const std::string of_abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  const std::string of_nothing = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
  EXPECT_EQ(sha256("abc"), of_abc);
  EXPECT_EQ(sha256(""), of_nothing);
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc")), of_abc);
  EXPECT_EQ(sha256_of_file(folder.write("nothing", "")), of_nothing);
  // A million times 'a', the long vector of FIPS 180, crosses the pieces of reading.
  EXPECT_EQ(sha256_of_file(folder.write("million", std::string(1000000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  const std::string missing = (folder / "missing").string();
  expect_clear(message_of([&] { sha256_of_file(missing); }), missing, "No such file", "path");
  expect_clear(message_of([&] { sha256_of_file("/tmp"); }), "/tmp", "cannot be read", "path");
}

}  // namespace
}  // namespace emax::test
