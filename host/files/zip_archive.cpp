#include "host/files/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

namespace emax {
namespace {

constexpr std::size_t kEntryPieceBytes = std::size_t{1} << 16;

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  return text;
}

void require(bool done) {
  if (!done) throw std::runtime_error("libzip cannot write an archive");
}

}  // namespace

ZipReader::ZipReader(const InputFile& input) : input_(input), limit_(input, input.bytes.size()) {
  zip_error_t error{};
  zip_source_t* source =
      zip_source_buffer_create(input.bytes.data(), input.bytes.size(), 0, &error);
  if (source == nullptr) throw std::bad_alloc();
  archive_ = zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive_ == nullptr) {
    zip_source_free(source);
    input_.fail("is not a ZIP archive", kExportAgain);
  }
  const auto count = static_cast<std::uint64_t>(zip_get_num_entries(archive_, 0));
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive_, i, 0);
    if (name != nullptr) entries_.emplace(in_lower_case(name), i);
  }
}

ZipReader::~ZipReader() { zip_discard(archive_); }

void ZipReader::read(const std::string& name, const std::function<void(std::string_view)>& take) {
  const auto fail = [&](std::string_view what, std::string_view remedy) {
    input_.fail(fmt::format("{}: {}", printable(name), what), remedy);
  };
  const auto entry = entries_.find(in_lower_case(name));
  if (entry == entries_.end()) fail("the archive has no such entry", kExportAgain);
  zip_stat_t about{};
  if (zip_stat_index(archive_, entry->second, 0, &about) == 0 &&
      (about.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && about.encryption_method != ZIP_EM_NONE) {
    fail("the entry is encrypted", "export it without a password");
  }
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
      zip_fopen_index(archive_, entry->second, 0), zip_fclose);
  if (file == nullptr) {
    const bool is_unknown = zip_error_code_zip(zip_get_error(archive_)) == ZIP_ER_COMPNOTSUPP;
    fail(is_unknown ? "the entry is compressed in an unknown way" : "the entry is damaged",
         kExportAgain);
  }
  std::array<char, kEntryPieceBytes> piece;
  zip_int64_t count = 0;
  while ((count = zip_fread(file.get(), piece.data(), piece.size())) > 0) {
    limit_.spend(static_cast<std::uint64_t>(count));
    take({piece.data(), static_cast<std::size_t>(count)});
  }
  if (count < 0) fail("the entry is damaged", kExportAgain);
}

ZipWriter::ZipWriter() : bytes_(zip_source_buffer_create(nullptr, 0, 0, nullptr)) {
  require(bytes_ != nullptr);
  zip_source_keep(bytes_);  // it must outlive the archive
  archive_ = zip_open_from_source(bytes_, ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  require(archive_ != nullptr);
}

ZipWriter::~ZipWriter() {
  if (archive_ != nullptr) zip_discard(archive_);
  zip_source_free(bytes_);
}

void ZipWriter::add(const std::string& name, std::string bytes) {
  constexpr zip_uint16_t kFirstDay = 1 << 5 | 1;  // 1980-01-01, the first that the format can name
  const std::string& kept = entries_.emplace_back(std::move(bytes));
  zip_source_t* source = zip_source_buffer(archive_, kept.data(), kept.size(), 0);
  require(source != nullptr);
  const zip_int64_t index = zip_file_add(archive_, name.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) zip_source_free(source);
  require(index >= 0);
  const auto entry = static_cast<zip_uint64_t>(index);
  require(zip_set_file_compression(archive_, entry, ZIP_CM_DEFLATE, 0) == 0);
  require(zip_file_set_dostime(archive_, entry, 0, kFirstDay, 0) == 0);
}

std::string ZipWriter::finish() {
  require(zip_close(archive_) == 0);
  archive_ = nullptr;
  zip_stat_t about{};
  require(zip_source_stat(bytes_, &about) == 0 && (about.valid & ZIP_STAT_SIZE) != 0);
  std::string bytes(about.size, '\0');
  require(zip_source_open(bytes_) == 0);
  const zip_int64_t count = zip_source_read(bytes_, bytes.data(), bytes.size());
  zip_source_close(bytes_);
  require(count >= 0 && static_cast<std::uint64_t>(count) == bytes.size());
  return bytes;
}

}  // namespace emax
