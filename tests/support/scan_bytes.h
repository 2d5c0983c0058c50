#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace emax::test {

template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
  static_assert(std::endian::native == std::endian::little);
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

// LAS 1.2, point format 0, scale 0.01, offset (1, 2, 3): points of three whole numbers and a class.
inline std::string las_bytes(const std::vector<std::array<std::int32_t, 4>>& points) {
  constexpr std::uint32_t kHeader = 227, kPoint = 20;
  std::string bytes(kHeader + kPoint * points.size(), '\0');
  bytes.replace(0, 4, "LASF");
  bytes[24] = 1;
  bytes[25] = 2;
  put(bytes, 94, static_cast<std::uint16_t>(kHeader));
  put(bytes, 96, kHeader);
  put(bytes, 105, static_cast<std::uint16_t>(kPoint));
  put(bytes, 107, static_cast<std::uint32_t>(points.size()));
  for (std::size_t k = 0; k < 3; ++k) {
    put(bytes, 131 + 8 * k, 0.01);
    put(bytes, 155 + 8 * k, static_cast<double>(k + 1));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t at = kHeader + kPoint * i;
    for (std::size_t k = 0; k < 3; ++k) put(bytes, at + 4 * k, points[i][k]);
    bytes[at + 15] = static_cast<char>(points[i][3]);
  }
  return bytes;
}

// Bytes of a page of an E57 file, without its checksum.
inline constexpr std::size_t kE57Page = 1020;

// The page of this content, with its checksum.
inline std::string e57_page(std::string_view content) {
  std::uint32_t crc = ~0u;  // CRC-32C
  for (const char c : content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0x82f63b78u : 0u);
  }
  crc = ~crc;
  std::string page(content);
  for (int shift = 24; shift >= 0; shift -= 8) page += static_cast<char>(crc >> shift);
  return page;
}

// The E57 file of this content: cut into pages with their checksums, and its length in the header.
inline std::string e57_pages(std::string content) {
  content.resize(std::max<std::size_t>(1, (content.size() + kE57Page - 1) / kE57Page) * kE57Page);
  put(content, 16, std::uint64_t{content.size() / kE57Page * 1024});
  std::string file;
  for (std::size_t at = 0; at < content.size(); at += kE57Page) {
    file += e57_page(std::string_view(content).substr(at, kE57Page));
  }
  return file;
}

// The content of an E57 file of one scan: (0 0 0), (1 0 0), (0 1 0) and (0 0 1), the last of them
// marked as invalid, in steps of 0.01 and with a turn of 90 degrees about z and a shift (1 2 3).
inline std::string e57_content(std::string_view rotation_w = "0.70710678118654752",
                               std::string_view rotation_z = "0.70710678118654752") {
  constexpr std::string_view kHeader("ASTM-E57\1\0\0\0\0\0\0\0", 16);
  // The section and its only packet: four streams of 4 bytes.
  constexpr std::string_view kPacket("\1\0\33\0\4\0\4\0\4\0\4\0\1\0d\310dddd\310dddd\310\200\0",
                                     28);
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><e57Root type=\"Structure\" "
      "xmlns=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\"><formatName type=\"String\">ASTM E57 "
      "3D "
      "Imaging Data File</formatName><guid type=\"String\">a</guid><versionMajor "
      "type=\"Integer\">1</versionMajor><versionMinor type=\"Integer\">0</versionMinor><data3D "
      "type=\"Vector\" allowHeterogeneousChildren=\"1\"><vectorChild type=\"Structure\"><guid "
      "type=\"String\">b</guid><name type=\"String\">north</name><pose "
      "type=\"Structure\"><rotation "
      "type=\"Structure\"><w type=\"Float\">";
  xml += rotation_w;
  xml += "</w><x type=\"Float\">0</x><y type=\"Float\">0</y><z type=\"Float\">";
  xml += rotation_z;
  xml +=
      "</z></rotation><translation type=\"Structure\"><x type=\"Float\">1</x><y "
      "type=\"Float\">2</y><z type=\"Float\">3</z></translation></pose><points "
      "type=\"CompressedVector\" fileOffset=\"48\" recordCount=\"4\"><prototype "
      "type=\"Structure\">";
  for (const char* axis : {"X", "Y", "Z"}) {
    xml += std::string("<cartesian") + axis +
           " type=\"ScaledInteger\" minimum=\"-100\" maximum=\"100\" scale=\"0.01\"/>";
  }
  xml +=
      "<cartesianInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/></prototype></points>"
      "</vectorChild></data3D><images2D type=\"Vector\"/></e57Root>";

  std::string content(80, '\0');
  content.replace(0, kHeader.size(), kHeader);
  put(content, 24, std::uint64_t{80 + kPacket.size()});  // the XML, on the first page
  put(content, 32, std::uint64_t{xml.size()});
  put(content, 40, std::uint64_t{1024});
  content[48] = 1;
  put(content, 56, std::uint64_t{32 + kPacket.size()});
  put(content, 64, std::uint64_t{80});
  content += kPacket;
  return content + xml;
}

}  // namespace emax::test
