#include "hls/lowering/port_names.h"

#include <cctype>
#include <stdexcept>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/source_text.h"

namespace emax {
namespace {

std::size_t after_blanks(std::string_view code, std::size_t at) {
  while (at < code.size() && std::isspace(static_cast<unsigned char>(code[at])) != 0) ++at;
  return at;
}

// The place after the bracket that closes the one at `open`.
std::size_t after_bracket(std::string_view code, std::size_t open, char opening, char closing) {
  int depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    depth += (code[i] == opening) - (code[i] == closing);
    if (depth == 0) return i + 1;
  }
  return code.size();
}

// The next place of `word` as a whole word.
std::size_t find_word(std::string_view code, std::string_view word, std::size_t from) {
  for (std::size_t at = code.find(word, from); at != code.npos; at = code.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_word(code[at - 1])) && (end == code.size() || !is_word(code[end]))) {
      return at;
    }
  }
  return code.npos;
}

// "Ray" of "const emax::Ray<Scalar>&": the last word before any template arguments.
std::string type_name(std::string_view declaration) {
  return last_word(declaration.substr(0, declaration.find('<')));
}

struct Declared {
  std::string type, name;
};

// "const Vector3<Scalar>& p" is p of type Vector3; "Scalar x" is x.
Declared declared(std::string_view text) {
  std::string name = last_word(text);
  return {type_name(text.substr(0, text.rfind(name))), std::move(name)};
}

class Names {
 public:
  explicit Names(std::string_view text)
      : code_(without_comments(text) + without_comments(source_text("hls/kernel/scalar.h"))) {}

  PortNames of(std::string_view function) const {
    const std::size_t at = definition(function);
    const std::size_t open = code_.find('(', at);
    const std::size_t close = after_bracket(code_, open, '(', ')') - 1;
    PortNames names;
    std::size_t begin = open + 1;
    for (const std::size_t end : ends(begin, close)) {
      const Declared parameter = declared(code_view(begin, end));
      add(parameter.type, parameter.name, names.inputs);
      names.parameter_of.resize(names.inputs.size(), names.parameters.size());
      names.parameters.push_back(parameter.name);
      begin = end + 1;
    }
    const std::string result = type_name(code_view(begin_of_result(at), at));
    if (fields_of(result).empty()) {
      names.outputs.emplace_back(function);
    } else {
      add(result, "", names.outputs);
    }
    return names;
  }

 private:
  std::string_view code_view(std::size_t begin, std::size_t end) const {
    return std::string_view(code_).substr(begin, end - begin);
  }

  std::vector<std::size_t> ends(std::size_t begin, std::size_t close) const {
    std::vector<std::size_t> all;
    int angles = 0;
    const auto inside = commas(code_, begin, close);
    std::size_t from = begin;
    for (const std::size_t comma : inside) {
      for (; from < comma; ++from) angles += (code_[from] == '<') - (code_[from] == '>');
      if (angles == 0) all.push_back(comma);
    }
    if (after_blanks(code_, begin) < close) all.push_back(close);
    return all;
  }

  std::size_t definition(std::string_view function) const {
    for (std::size_t at = find_word(code_, function, 0); at != code_.npos;
         at = find_word(code_, function, at + 1)) {
      const std::size_t open = after_blanks(code_, at + function.size());
      if (open >= code_.size() || code_[open] != '(') continue;
      const std::size_t body = after_blanks(code_, after_bracket(code_, open, '(', ')'));
      if (body < code_.size() && code_[body] == '{') return at;
    }
    throw std::invalid_argument("no function '" + std::string(function) +
                                "' is defined in the given header");
  }

  // After the statement before, and after "template <...>".
  std::size_t begin_of_result(std::size_t function) const {
    const std::size_t before = code_.find_last_of(";}{", function);
    const std::size_t begin = before == code_.npos ? 0 : before + 1;
    const std::size_t head = find_word(code_, "template", begin);
    return head < function ? after_bracket(code_, code_.find('<', head), '<', '>') : begin;
  }

  std::vector<Declared> fields_of(const std::string& type) const {
    std::vector<Declared> fields;
    for (std::size_t at = find_word(code_, "struct", 0); at != code_.npos;
         at = find_word(code_, "struct", at + 1)) {
      const std::size_t name = after_blanks(code_, at + std::string_view("struct").size());
      if (find_word(code_, type, name) != name) continue;
      const std::size_t open = after_blanks(code_, name + type.size());
      if (open >= code_.size() || code_[open] != '{') continue;
      const std::size_t close = after_bracket(code_, open, '{', '}') - 1;
      std::size_t begin = open + 1;
      for (std::size_t end = code_.find(';', begin); end < close; end = code_.find(';', begin)) {
        add_fields(begin, end, fields);
        begin = end + 1;
      }
      return fields;
    }
    return fields;
  }

  // One declaration of several fields: "Scalar x, y, z".
  void add_fields(std::size_t begin, std::size_t end, std::vector<Declared>& fields) const {
    std::string type;
    for (const std::size_t stop : ends(begin, end)) {
      Declared field = declared(code_view(begin, stop));
      if (type.empty()) type = field.type;
      fields.push_back({type, field.name});
      begin = stop + 1;
    }
  }

  void add(const std::string& type, const std::string& name, std::vector<std::string>& to) const {
    const std::vector<Declared> fields = fields_of(type);
    if (fields.empty()) to.push_back(name);
    for (const Declared& field : fields) {
      add(field.type, name.empty() ? field.name : name + "_" + field.name, to);
    }
  }

  std::string code_;
};

}  // namespace

PortNames port_names(std::string_view text, std::string_view function) {
  return Names(text).of(function);
}

}  // namespace emax
