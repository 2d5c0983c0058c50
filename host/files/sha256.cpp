#include "host/files/sha256.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>

#include "host/files/scan_folder.h"
#include "host/files/spooled_input.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

class Digest {
 public:
  Digest() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    require(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(std::string_view bytes) {
    require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
  }
  std::string hexadecimal() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
    unsigned size = 0;
    require(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size) == 1);
    return fmt::format("{:02x}", fmt::join(std::span(bytes.data(), size), ""));
  }

 private:
  static void require(bool ok) {
    if (!ok) throw std::runtime_error("OpenSSL cannot compute a SHA-256");
  }

  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

}  // namespace

std::string sha256(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hexadecimal();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const auto fail = [&] {
    throw Error(fmt::format("{}: cannot be read ({}); check the path and its permissions",
                            path.string(), std::strerror(errno)));
  };
  const int descriptor =
      path == kStandardInput ? standard_input() : open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail();
  Digest digest;
  std::array<char, 1 << 16> piece;
  ssize_t n = 0;
  for (off_t at = 0; (n = pread(descriptor, piece.data(), piece.size(), at)) != 0;) {
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;
    digest.add({piece.data(), static_cast<std::size_t>(n)});
    at += n;
  }
  const int error = errno;
  close(descriptor);
  errno = error;
  if (n < 0) fail();
  return digest.hexadecimal();
}

std::string sha256_of_input(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) ? sha256_of_folder(path) : sha256_of_file(path);
}

}  // namespace emax
