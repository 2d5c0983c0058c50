#include "host/report/report_page.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <stdexcept>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

// A zlib stream (RFC 1950).
std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  std::string stream(size, '\0');
  const int failure = compress2(reinterpret_cast<Bytef*>(stream.data()), &size,
                                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 9);
  if (failure != Z_OK) throw std::runtime_error("zlib cannot compress the geometry of a report");
  stream.resize(size);
  return stream;
}

// In pieces, as OpenSSL counts bytes with an int.
std::string base64(std::string_view bytes) {
  constexpr std::size_t kPiece = 3 << 20;  // each but the last without padding
  std::string text;
  for (std::size_t begin = 0; begin < bytes.size(); begin += kPiece) {
    const std::string_view piece = bytes.substr(begin, kPiece);
    const std::size_t before = text.size();
    text.resize(before + 4 * ((piece.size() + 2) / 3) + 1);  // OpenSSL ends it with a zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data() + before),
                    reinterpret_cast<const unsigned char*>(piece.data()),
                    static_cast<int>(piece.size()));
    text.pop_back();
  }
  return text;
}

std::string replaced(std::string_view text, char what, std::string_view by) {
  std::string result;
  for (const char c : text) {
    if (c == what) {
      result += by;
    } else {
      result += c;
    }
  }
  return result;
}

// For the value of an attribute in double quotes.
std::string attribute(std::string_view text) {
  return replaced(replaced(replaced(text, '&', "&amp;"), '"', "&quot;"), '<', "&lt;");
}

}  // namespace

std::string report_page(const ReportData& report, std::string_view page_template) {
  const std::size_t at = page_template.find(kReportMarker);
  if (at == std::string_view::npos ||
      page_template.find(kReportMarker, at + 1) != std::string_view::npos) {
    throw std::logic_error("the template of reports does not hold its marker exactly once");
  }
  std::string json = report_json(report);
  if (!EMAX_FAULT(kReportUnescaped)) json = replaced(json, '<', "\\u003c");
  std::string page(page_template.substr(0, at));
  page += R"(<script type="application/json" id="emax-data">)" + json + "</script>\n";
  page += R"(<script type="application/octet-stream" id="emax-geometry">)" +
          base64(deflated(report.measured.geometry.bytes)) + "</script>\n";
  page += R"(<img id="emax-picture" alt=")" + attribute(report.title + ": " + report.verdict) +
          R"(" src="data:image/png;base64,)" + base64(report.measured.page_picture) + "\">";
  page += page_template.substr(at + kReportMarker.size());
  return page;
}

}  // namespace emax
