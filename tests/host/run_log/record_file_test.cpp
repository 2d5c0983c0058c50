#include "host/run_log/record_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using Content = std::vector<std::uint8_t>;

// Lengths from nothing to more than a block of a disk, bytes that hold zeros and look like lengths.
std::vector<Content> contents() {
  std::vector<Content> result;
  for (const std::size_t length : {5u, 0u, 1u, 300u, 5000u, 2u}) {
    Content content(length);
    for (std::size_t i = 0; i < length; ++i) {
      content[i] = static_cast<std::uint8_t>(i % 3 == 0 ? 0 : (7 * i + length) & 0xff);
    }
    result.push_back(content);
  }
  return result;
}

std::vector<Content> read(RecordFile& file, RecordFile::Loss* loss = nullptr) {
  std::vector<Content> result;
  const RecordFile::Loss lost = file.read([&result](std::span<const std::uint8_t> content) {
    result.emplace_back(content.begin(), content.end());
  });
  if (loss != nullptr) *loss = lost;
  return result;
}

class RecordFileTest : public testing::Test {
 protected:
  std::string filled() {
    std::filesystem::remove(path_);
    RecordFile file(path_);
    file.clear();
    for (const Content& content : contents()) file.append(content);
    return bytes_of(path_);
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "log";
};

TEST_F(RecordFileTest, GivesBackWhatWasAppended) {
  const std::string bytes = filled();
  std::size_t size = RecordFile::kHeaderBytes;
  for (const Content& content : contents()) size += RecordFile::kRecordBytes + content.size();
  EXPECT_EQ(bytes.size(), size);
  EXPECT_EQ(bytes.substr(0, 8), "emaxrun1");
  RecordFile file(path_);
  RecordFile::Loss loss;
  EXPECT_EQ(read(file, &loss), contents());
  EXPECT_EQ(loss.torn + loss.damaged, 0u);
}

// zlib.crc32(b"\x03\x00\x00\x00abc") in Python.
TEST_F(RecordFileTest, ARecordIsLengthChecksumContent) {
  const Content abc = {'a', 'b', 'c'};
  const Content expected = {3, 0, 0, 0, 0x33, 0x5d, 0xe1, 0x66, 'a', 'b', 'c'};
  EXPECT_EQ(record_bytes(abc), expected);
}

// A kill or a power cut may end the file anywhere.
TEST_F(RecordFileTest, CutAnywhereItKeepsTheWholeRecordsAndGoesOn) {
  const std::string bytes = filled();
  const std::vector<Content> all = contents();
  for (std::size_t length = 0; length < bytes.size(); length += length < 60 ? 1 : 97) {
    SCOPED_TRACE(length);
    std::size_t whole = 0, end = RecordFile::kHeaderBytes;
    while (whole < all.size() && end + RecordFile::kRecordBytes + all[whole].size() <= length) {
      end += RecordFile::kRecordBytes + all[whole++].size();
    }
    folder_.write("log", bytes.substr(0, length));
    std::vector<Content> expected(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(whole));
    {
      RecordFile file(path_);
      RecordFile::Loss loss;
      ASSERT_EQ(read(file, &loss), expected);
      EXPECT_EQ(loss.damaged, 0u);
      EXPECT_EQ(loss.torn, length < RecordFile::kHeaderBytes ? length : length - end);
      file.append(all.back());
    }
    expected.push_back(all.back());
    RecordFile file(path_);
    ASSERT_EQ(read(file), expected);
  }
}

// A power cut may leave zeros where bytes were to be.
TEST_F(RecordFileTest, ZerosAtTheEndAreNoRecords) {
  folder_.write("log", filled() + std::string(4096, '\0'));
  RecordFile file(path_);
  RecordFile::Loss loss;
  EXPECT_EQ(read(file, &loss), contents());
  EXPECT_EQ(loss.torn, 4096u);
}

TEST_F(RecordFileTest, AChangedByteCostsItsRecordAlone) {
  const std::string bytes = filled();
  const std::vector<Content> all = contents();
  std::size_t begin = RecordFile::kHeaderBytes;
  for (std::size_t hit = 0; hit < all.size(); ++hit) {
    const std::size_t end = begin + RecordFile::kRecordBytes + all[hit].size();
    for (std::size_t at = begin; at < end; at += at < begin + 20 ? 1 : 613) {
      SCOPED_TRACE(at);
      std::string changed = bytes;
      changed[at] = static_cast<char>(changed[at] ^ 0x11);
      folder_.write("log", changed);
      std::vector<Content> expected = all;
      expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(hit));
      RecordFile file(path_);
      RecordFile::Loss loss;
      ASSERT_EQ(read(file, &loss), expected);
      EXPECT_EQ(loss.torn + loss.damaged, end - begin);
      EXPECT_EQ(loss.torn > 0, hit + 1 == all.size());
    }
    begin = end;
  }
}

TEST_F(RecordFileTest, RefusesAnotherKindOfFile) {
  const std::string text = "solid of another kind";
  folder_.write("log", text);
  RecordFile file(path_);
  expect_clear(message_of([&] { read(file); }), path_.string(), "no log", "another folder");
  EXPECT_EQ(bytes_of(path_), text);
}

TEST_F(RecordFileTest, ASecondProcessIsRefusedUntilTheFirstIsKilled) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t first = fork();
  if (first == 0) {
    RecordFile file(path_);
    if (write(ready[1], "x", 1) != 1) _exit(1);
    while (true) pause();
  }
  char x;
  ASSERT_EQ(::read(ready[0], &x, 1), 1);
  const std::string message = message_of([this] { const RecordFile second(path_); });
  expect_clear(message, folder_.path().string(), "another process", "--resume");
  kill(first, SIGKILL);
  waitpid(first, nullptr, 0);
  close(ready[0]);
  close(ready[1]);
  const RecordFile second(path_);
}

// The largest size a file may have stands in for the disk's last block.
TEST_F(RecordFileTest, AFullDiskLeavesWhatWasThere) {
  const std::string bytes = filled();
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes.size() + 5, bytes.size() + 5};
    setrlimit(RLIMIT_FSIZE, &limit);
    RecordFile file(path_);
    read(file);
    try {
      file.append(contents()[3]);
    } catch (const Error& error) {
      const bool named = std::string(error.what()).find("make room") != std::string::npos;
      _exit(named ? 7 : 8);
    }
    _exit(9);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(bytes_of(path_), bytes);
}

}  // namespace
}  // namespace emax::test
