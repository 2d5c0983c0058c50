#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/files/input_file.h"

namespace emax {

// A JSON object of a GLB file, with its place for messages. Every function throws Error naming the
// place where the member has another type than it must have.
struct GltfObject {
  const InputFile* input;
  const nlohmann::json* json;
  std::string place;  // "node 3"

  bool has(const char* key) const { return json->contains(key); }
  std::optional<std::uint64_t> whole(const char* key) const;  // below 2^53; nothing if it is absent
  std::uint64_t whole(const char* key, std::uint64_t otherwise) const;
  std::uint64_t required(const char* key) const;
  std::string text(const char* key) const;  // empty if it is absent
  // `to.size()` numbers. Returns false and leaves `to` if the member is absent.
  bool numbers(const char* key, std::span<double> to) const;
  std::vector<std::uint64_t> wholes(const char* key) const;  // empty if it is absent
  std::vector<std::string> texts(const char* key) const;     // likewise
  std::vector<GltfObject> objects(const char* key) const;    // likewise
  GltfObject object(const char* key) const;                  // {} if it is absent

  [[noreturn]] void fail(std::string_view what) const;
  [[noreturn]] void fail(std::string_view what, std::string_view remedy) const;
};

// The elements of an accessor: `components` numbers each.
class GltfAccessor {
 public:
  std::size_t size() const { return count_; }
  double number(std::size_t element, std::size_t component) const;
  std::uint32_t index(std::size_t element) const;  // of an accessor of whole numbers

 private:
  friend class GlbContainer;
  const char* data_ = nullptr;
  std::size_t count_ = 0, stride_ = 0;
  int component_ = 0;
  bool normalized_ = false;
};

// A GLB file, its chunks found and its JSON parsed. The input must outlive it.
class GlbContainer {
 public:
  // Throws Error unless the file is a GLB file of version 2 whose required extensions leave shapes
  // as they are.
  explicit GlbContainer(const InputFile& input);

  GltfObject root() const { return {&input_, &json_, "the JSON"}; }
  std::size_t size(const char* list) const;  // of a list of the root
  // Throws Error where the list has no such object; `user` names what refers to it.
  GltfObject element(const char* list, std::uint64_t index, std::string_view user) const;

  // `type`: "VEC3", of any numbers, or "SCALAR", of whole numbers from 0. Every element lies within
  // the file.
  GltfAccessor accessor(std::uint64_t index, std::string_view type, std::string_view user) const;

 private:
  void find_chunks();
  void check_version() const;
  void check_extensions() const;
  std::string_view view_bytes(const GltfObject& view) const;

  const InputFile& input_;
  std::string_view text_, binary_;
  nlohmann::json json_;
};

}  // namespace emax
