#include "host/files/xml_reader.h"

#include <expat.h>
#include <fmt/format.h>

#include <new>

namespace emax {
namespace {

constexpr char kSeparator = '|';

// "URI|name" as the two.
std::pair<std::string_view, std::string_view> split(std::string_view name) {
  const std::size_t bar = name.rfind(kSeparator);
  if (bar == name.npos) return {{}, name};
  return {name.substr(0, bar), name.substr(bar + 1)};
}

XML_Parser expat(void* parser) { return static_cast<XML_Parser>(parser); }

}  // namespace

std::optional<std::string_view> XmlAttributes::find(std::string_view name) const {
  for (const char* const* at = list_; *at != nullptr; at += 2) {
    if (name == at[0]) return at[1];
  }
  return std::nullopt;
}

// What expat calls. No exception may pass through expat, which is C.
struct XmlReader::Calls {
  template <class Act>
  static void guarded(void* self, const Act& act) {
    auto& reader = *static_cast<XmlReader*>(self);
    if (reader.thrown_) return;
    try {
      act(reader);
    } catch (...) {
      reader.thrown_ = std::current_exception();
      XML_StopParser(expat(reader.parser_), XML_FALSE);
    }
  }
  static void begin(void* self, const char* name, const char** attributes) {
    guarded(self, [&](XmlReader& reader) {
      const auto [space, local] = split(name);
      reader.handler_.begin(space, local, XmlAttributes(attributes));
    });
  }
  static void end(void* self, const char* name) {
    guarded(self, [&](XmlReader& reader) {
      const auto [space, local] = split(name);
      reader.handler_.end(space, local);
    });
  }
  static void prefix(void* self, const char* prefix, const char* uri) {
    guarded(self, [&](XmlReader& reader) {
      if (!reader.handler_.prefix || prefix == nullptr || uri == nullptr) return;
      reader.handler_.prefix(prefix, uri);
    });
  }
  static void doctype(void* self, const char*, const char*, const char*, int) {
    guarded(self, [](XmlReader& reader) {
      reader.fail("a document type declaration", "export it without one");
    });
  }
};

XmlReader::XmlReader(const NamedInput& input, std::string part, Handler handler)
    : input_(input),
      part_(std::move(part)),
      handler_(std::move(handler)),
      parser_(XML_ParserCreateNS(nullptr, kSeparator)) {
  if (parser_ == nullptr) throw std::bad_alloc();
  XML_SetUserData(expat(parser_), this);
  XML_SetElementHandler(expat(parser_), Calls::begin, Calls::end);
  XML_SetStartNamespaceDeclHandler(expat(parser_), Calls::prefix);
  XML_SetStartDoctypeDeclHandler(expat(parser_), Calls::doctype);
}

XmlReader::~XmlReader() { XML_ParserFree(expat(parser_)); }

void XmlReader::fail(std::string_view what, std::string_view remedy) const {
  input_.fail(fmt::format("{}, line {}: {}", part_, XML_GetCurrentLineNumber(expat(parser_)), what),
              remedy);
}

void XmlReader::parse(std::string_view piece, bool is_last) {
  const XML_Status status = XML_Parse(expat(parser_), piece.data(), static_cast<int>(piece.size()),
                                      is_last ? XML_TRUE : XML_FALSE);
  if (thrown_) std::rethrow_exception(thrown_);
  if (status == XML_STATUS_OK) return;
  fail(fmt::format("is not XML ({})", XML_ErrorString(XML_GetErrorCode(expat(parser_)))),
       kExportAgain);
}

}  // namespace emax
