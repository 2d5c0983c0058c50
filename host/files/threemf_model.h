#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/files/copy_limit.h"
#include "host/files/file_content.h"
#include "host/files/pose.h"
#include "host/files/zip_archive.h"

namespace emax {

// An object of a 3MF package: its number in the part that defines it.
struct ThreeMfKey {
  std::string part;
  std::uint64_t id;
  auto operator<=>(const ThreeMfKey&) const = default;
};

// An object in its place: an item of the build, or a component of another object.
struct ThreeMfUse {
  ThreeMfKey object;
  Pose place;
};

struct ThreeMfObject {
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;
  std::vector<ThreeMfUse> components;
};

// A part of a package with objects and, in the first part, what is built of them.
struct ThreeMfModel {
  std::map<std::uint64_t, ThreeMfObject> objects;
  std::vector<ThreeMfUse> build;
  std::optional<Unit> unit;
  bool has_materials = false;
};

// Reads the part and allows what it holds to `limit`. Throws Error where it is not a model or needs
// an extension that emax does not read.
ThreeMfModel read_threemf_model(const InputFile& input, ZipReader& zip, const std::string& part,
                                CopyLimit& limit);

// The name of the part that an absolute or relative name means.
std::string threemf_part(std::string_view name);

}  // namespace emax
