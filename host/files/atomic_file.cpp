#include "host/files/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <deque>
#include <map>
#include <utility>

#include "host/files/input_file.h"
#include "sw_model/base/error.h"

namespace emax {
namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// The file that writing to `path` makes or replaces. Symbolic links are followed, even to a file
// that does not exist yet. The result is still a link if the links form a circle.
fs::path target_of(fs::path path) {
  constexpr int kMostLinks = 40;
  std::error_code failure;
  for (int links = 0; links < kMostLinks && fs::is_symlink(path, failure); ++links) {
    const fs::path next = fs::read_symlink(path, failure);
    if (failure) break;
    path = next.is_absolute() ? next : folder_of(path) / next;
  }
  return path;
}

// The canonical path with links followed. If a part cannot be read, the path itself; opening it
// then fails.
fs::path place_of(const fs::path& path) {
  std::error_code failure;
  fs::path place = fs::weakly_canonical(fs::absolute(target_of(path), failure), failure);
  return failure ? path : place;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path) : path_(path), target_(target_of(path)) {
  std::error_code ignored;
  if (fs::is_symlink(target_, ignored)) fail(ELOOP);
  static std::atomic<unsigned> serial{0};
  // If a leftover of a killed process has this name, the next number is tried.
  do {
    temporary_ = folder_of(target_) / fmt::format(".{}.{}-{}.tmp", target_.filename().string(),
                                                  getpid(), serial.fetch_add(1));
    descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) fail(errno);
  // A replaced file passes its permissions on where the system permits that.
  struct stat old {};
  if (stat(target_.c_str(), &old) == 0) (void)!fchmod(descriptor_, old.st_mode & 0777);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!published_) unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(errno);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void AtomicFile::finish() {
  if (fsync(descriptor_) != 0) fail(errno);
  const int closing = std::exchange(descriptor_, -1);
  if (close(closing) != 0) fail(errno);
}

void AtomicFile::publish() {
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  published_ = true;
  // The folder is synchronised so that the new name is durable, too. It is not an error if the file
  // system cannot do that.
  const int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    fsync(folder);
    close(folder);
  }
}

void AtomicFile::fail(int error) const {
  throw Error(
      fmt::format("{}: cannot be written ({}); check the folder, its permissions and the "
                  "space on the disk",
                  path_.string(), std::strerror(error)));
}

void write_atomically(const fs::path& path, std::string_view bytes) {
  write_atomically(path, [&](AtomicFile& file) { file.write(bytes); });
}

void write_atomically(const fs::path& path, const std::function<void(AtomicFile&)>& fill) {
  AtomicFile file(path);
  fill(file);
  file.finish();
  file.publish();
}

void write_together(std::span<const OutputFile> files) {
  std::deque<AtomicFile> written;
  for (const OutputFile& file : files) written.emplace_back(file.path).write(file.bytes);
  for (AtomicFile& file : written) file.finish();
  for (AtomicFile& file : written) file.publish();
}

void check_output(const fs::path& path, std::span<const std::string_view> endings) {
  const auto fail = [&](std::string_view what, std::string_view remedy) {
    throw Error(fmt::format("{}: {}; {}", path.string(), what, remedy));
  };
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail("is a folder", "name a file in it");
  const std::string ending = lower_case_ending(path);
  if (std::ranges::find(endings, ending) == endings.end()) {
    fail(fmt::format("unknown ending \"{}\"", printable(ending)),
         fmt::format("end the name in {}", fmt::join(endings, ", ")));
  }
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) {
    fail("is not a regular file", "name another output");
  }
  const fs::path target = target_of(path);
  if (!fs::is_directory(folder_of(target), ignored)) {
    fail(fmt::format("the folder {} does not exist", folder_of(target).string()),
         "create it first");
  }
  if (fs::exists(target, ignored) && access(target.c_str(), W_OK) != 0) {
    fail("is write-protected", "name another output, or allow it to be written");
  }
  AtomicFile probe(path);
}

void check_distinct(std::initializer_list<fs::path> outputs,
                    std::initializer_list<fs::path> inputs) {
  std::map<fs::path, std::string_view> taken;
  for (const fs::path& path : inputs) {
    if (!path.empty()) taken.emplace(place_of(path), "read and replaced");
  }
  for (const fs::path& path : outputs) {
    if (path.empty()) continue;
    const auto [file, free] = taken.emplace(place_of(path), "written twice");
    if (free) continue;
    throw Error(fmt::format("{}: would be {}; name another output", path.string(), file->second));
  }
}

void check_outside(std::initializer_list<fs::path> outputs, const fs::path& folder) {
  for (const fs::path& path : outputs) {
    if (path.empty() || place_of(path).parent_path() != place_of(folder)) continue;
    throw Error(fmt::format("{}: lies in {}, which is for the run's own files; name another output",
                            path.string(), folder.string()));
  }
}

}  // namespace emax
