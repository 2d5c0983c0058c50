#include "host/files/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "host/files/number_text.h"
#include "host/files/spooled_input.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// As format_of_content(), but for all formats that can be told apart; .xyz if it is none of these.
std::string_view ending_shown_by(std::string_view head, std::uint64_t size) {
  const std::string_view known = format_of_content(head);
  if (!known.empty()) return known;
  constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;
  if (head.size() >= kStlHeader) {
    std::uint32_t triangles = 0;
    std::memcpy(&triangles, head.data() + kStlHeader - sizeof triangles, sizeof triangles);
    if (size == kStlHeader + std::uint64_t{triangles} * kStlTriangle) return ".stl";
  }
  std::string_view rest = head;
  while (!rest.empty()) {  // the first line that is not a comment
    const std::string_view line = trimmed(rest.substr(0, rest.find('\n')));
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
    if (line.empty() || line.starts_with('#')) continue;
    const std::string_view word = line.substr(0, line.find(' '));
    constexpr std::array<std::string_view, 7> kObj = {"v", "vn",     "vt",    "o",
                                                      "g", "mtllib", "usemtl"};
    if (std::ranges::find(kObj, word) != kObj.end()) return ".obj";
    if (line == "0" && trimmed(rest.substr(0, rest.find('\n'))) == "SECTION") return ".dxf";
    break;
  }
  return ".xyz";
}

constexpr std::string_view kCheckDisk = "check its permissions and the disk";

[[noreturn]] void fail_to_read(const NamedInput& input, int error) {
  input.fail(fmt::format("cannot be read ({})", std::strerror(error)), kCheckDisk);
}

}  // namespace

void NamedInput::fail(std::string_view what, std::string_view remedy) const {
  throw Error(fmt::format("{}: {}; {}", name, what, remedy));
}

InputStream::InputStream(const std::filesystem::path& path)
    : NamedInput{path == kStandardInput ? std::string(kStandardInputInMessages) : path.string()} {
  if (path == kStandardInput) {
    descriptor_ = standard_input();
    size_ = size_of(descriptor_);
    return;
  }
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    if (errno == ENOENT || errno == ENOTDIR) fail("no such file", "check the path");
    fail_to_read(*this, errno);
  }
  try {
    size_ = size_of(descriptor_);
    const Compression compression = compression_of(path);
    if (compression == Compression::kNone || size_ == 0) return;
    const int plain = inflated(*this, descriptor_, size_, compression);
    close(std::exchange(descriptor_, plain));
    size_ = size_of(plain);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

std::uint64_t InputStream::size_of(int descriptor) const {
  struct stat status {};
  if (fstat(descriptor, &status) != 0) fail_to_read(*this, errno);
  if (S_ISDIR(status.st_mode)) fail("is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) {
    fail("is not a regular file", "copy the data into a file, or give it to standard input as -");
  }
  return static_cast<std::uint64_t>(status.st_size);
}

InputStream::~InputStream() { close(descriptor_); }

void InputStream::require_content() const {
  if (size_ > 0) return;
  char byte = 0;
  if (pread(descriptor_, &byte, 1, 0) < 0) fail_to_read(*this, errno);
  fail("the file is empty", "export it again");
}

void InputStream::read(std::uint64_t offset, std::span<std::uint8_t> to) const {
  while (!to.empty()) {
    const ssize_t n = pread(descriptor_, to.data(), to.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_read(*this, errno);
    if (n == 0) fail("the file ends before its data", kExportAgain);
    to = to.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

std::string InputStream::head() const {
  std::string bytes(std::min<std::uint64_t>(size_, kHeadBytes), '\0');
  read(0, {reinterpret_cast<std::uint8_t*>(bytes.data()), bytes.size()});
  return bytes;
}

InputFile read_input(const std::filesystem::path& path) { return read_input(InputStream(path)); }

InputFile read_input(const InputStream& file) {
  InputFile input{{file.name}, {}};
  // One byte more than the size, so that the end of the file is found without growing the buffer.
  std::size_t used = 0;
  input.bytes.resize(static_cast<std::size_t>(file.size()) + 1);
  while (true) {
    if (used == input.bytes.size()) input.bytes.resize(2 * used);
    const ssize_t n = pread(file.descriptor(), input.bytes.data() + used, input.bytes.size() - used,
                            static_cast<off_t>(used));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_to_read(input, errno);
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
  }
  input.bytes.resize(used);
  if (used == 0) input.fail("the file is empty", "export it again");
  return input;
}

std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

std::string format_ending(const std::filesystem::path& path) {
  if (path == kStandardInput) {
    const InputStream input(path);
    return std::string(ending_shown_by(input.head(), input.size()));
  }
  const bool is_plain = compression_of(path) == Compression::kNone;
  return lower_case_ending(is_plain ? path : std::filesystem::path(path).replace_extension());
}

std::string_view format_of_content(std::string_view bytes) {
  if (bytes.starts_with("ASTM-E57")) return ".e57";
  constexpr std::size_t kPointFormat = 104;  // its highest bit marks compressed points
  if (bytes.starts_with("LASF") && bytes.size() > kPointFormat) {
    return (static_cast<unsigned char>(bytes[kPointFormat]) & 0x80) != 0 ? ".laz" : ".las";
  }
  if (bytes.starts_with("glTF")) return ".glb";
  if (bytes.starts_with("PK\3\4")) return ".3mf";
  const std::string_view first_line = trimmed(bytes.substr(0, bytes.find('\n')));
  if (first_line == "ply") return ".ply";
  if (first_line.starts_with("# .PCD") || first_line.starts_with("VERSION ")) return ".pcd";
  const std::string_view word = first_line.substr(0, first_line.find(' '));
  if (word.size() <= 8 && word.ends_with("OFF")) return ".off";
  if (word == "solid") return ".stl";
  return {};
}

void check_ending_fits(const NamedInput& input, std::string_view head, std::string_view ending) {
  const std::string_view content = format_of_content(head);
  if (!content.empty() && content != ending) {
    input.fail(
        fmt::format("the ending is {} but the content is that of a {} file", ending, content),
        fmt::format("rename it to {}", content));
  }
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  if (text.size() > kLongest) shown += "...";
  return shown;
}

}  // namespace emax
