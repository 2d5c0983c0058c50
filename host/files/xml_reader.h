#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/files/input_file.h"

namespace emax {

// The attributes of an element. A name of a namespace is "URI|name"; others are without a bar.
class XmlAttributes {
 public:
  explicit XmlAttributes(const char* const* list) : list_(list) {}
  std::optional<std::string_view> find(std::string_view name) const;

 private:
  const char* const* list_;  // names and values in turn
};

// XML in UTF-8 or UTF-16, read in pieces by expat. A document type declaration, and with it every
// entity of its own, is an error.
class XmlReader {
 public:
  struct Handler {
    // Namespace, name and attributes. An Error thrown here ends the reading.
    std::function<void(std::string_view, std::string_view, const XmlAttributes&)> begin;
    std::function<void(std::string_view, std::string_view)> end;
    // A prefix that stands for a namespace from here on.
    std::function<void(std::string_view, std::string_view)> prefix = {};
  };

  // `part` names the text in messages; it and the input must outlive the reader.
  XmlReader(const NamedInput& input, std::string part, Handler handler);
  ~XmlReader();
  XmlReader(const XmlReader&) = delete;
  XmlReader& operator=(const XmlReader&) = delete;

  // Throw Error where the text is not XML, or what the handler throws.
  void take(std::string_view piece) { parse(piece, false); }
  void finish() { parse({}, true); }

  // "<file>: <part>, line <n>: <what>; <remedy>"
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const;

 private:
  void parse(std::string_view piece, bool is_last);
  struct Calls;

  const NamedInput& input_;
  std::string part_;
  Handler handler_;
  void* parser_;
  std::exception_ptr thrown_;  // by the handler
};

}  // namespace emax
