#include "hls/lowering/source_text.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "hls/lowering/identifiers.h"
#include "hls/lowering/kernel_sources.h"

namespace emax {

std::string without_comments(std::string_view text) {
  std::string code(text);
  for (std::size_t i = 0; i + 1 < code.size(); ++i) {
    if (code[i] != '/' || (code[i + 1] != '/' && code[i + 1] != '*')) continue;
    const bool line = code[i + 1] == '/';
    std::size_t end = line ? code.find('\n', i) : code.find("*/", i + 2);
    end = end == std::string::npos ? code.size() : end + (line ? 0 : 2);
    std::replace_if(
        code.begin() + static_cast<std::ptrdiff_t>(i),
        code.begin() + static_cast<std::ptrdiff_t>(end), [](char c) { return c != '\n'; }, ' ');
    i = end - 1;
  }
  return code;
}

std::vector<std::size_t> commas(std::string_view code, std::size_t begin, std::size_t end) {
  std::vector<std::size_t> found;
  int depth = 0;
  for (std::size_t i = begin; i < end; ++i) {
    if (std::string_view("({[").find(code[i]) != std::string_view::npos) ++depth;
    if (std::string_view(")}]").find(code[i]) != std::string_view::npos) --depth;
    if (code[i] == ',' && depth == 0) found.push_back(i);
  }
  return found;
}

std::string last_word(std::string_view code) {
  std::size_t end = code.size();
  while (end > 0 && !is_word(code[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_word(code[begin - 1])) --begin;
  return std::string(code.substr(begin, end - begin));
}

std::string_view source_text(std::string_view path) {
  const std::string_view embedded = kernel_source(path);
  if (!embedded.empty()) return embedded;
  static std::map<std::string, std::string, std::less<>> read;
  const auto [text, is_new] = read.try_emplace(std::string(path));
  if (is_new) {
    std::ostringstream content;
    content << std::ifstream(text->first, std::ios::binary).rdbuf();
    text->second = content.str();
  }
  return text->second;
}

}  // namespace emax
