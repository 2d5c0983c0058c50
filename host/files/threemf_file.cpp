// 3MF: a ZIP archive whose relationships name the model, from which the build is put together.

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "host/files/threemf_model.h"
#include "host/files/threemf_names.h"
#include "host/files/xml_reader.h"

namespace emax {
namespace {

constexpr std::size_t kDeepest = 64;  // components of components

std::string model_part(const InputFile& input, ZipReader& zip) {
  const std::string part = "_rels/.rels";
  std::string model;
  XmlReader xml(input, part,
                {.begin =
                     [&](std::string_view space, std::string_view name, const XmlAttributes& a) {
                       if (space == kRelationships && name == "Relationship" &&
                           a.find("Type") == kThreeMfModelType && a.find("Target")) {
                         model = threemf_part(*a.find("Target"));
                       }
                     },
                 .end = [](auto, auto) {}});
  zip.read(part, [&](std::string_view piece) { xml.take(piece); });
  xml.finish();
  if (model.empty()) input.fail("the archive names no 3D model", "check that it is a 3MF file");
  return model;
}

class Package {
 public:
  explicit Package(const InputFile& input) : input_(input), zip_(input), limit_(input) {}

  FileContent read() {
    const std::string first = model_part(input_, zip_);
    const ThreeMfModel& model = part(first);
    content_.unit = model.unit;
    for (const ThreeMfUse& item : model.build) place(item, {});
    const bool has_materials =
        std::ranges::any_of(parts_, [](const auto& named) { return named.second.has_materials; });
    if (has_materials) content_.note_attribute(kMaterials);
    return std::move(content_);
  }

 private:
  const ThreeMfModel& part(const std::string& name) {
    const auto known = parts_.find(name);
    if (known != parts_.end()) return known->second;
    ThreeMfModel model = read_threemf_model(input_, zip_, name, limit_);
    if (content_.unit && model.unit != content_.unit) {
      input_.fail(fmt::format("{} is in {}, the model in {}", printable(name), model.unit->name,
                              content_.unit->name),
                  "export it in one unit");
    }
    return parts_.emplace(name, std::move(model)).first->second;
  }

  void place(const ThreeMfUse& use, const Pose& outer) {
    const ThreeMfModel& model = part(use.object.part);
    const auto object = model.objects.find(use.object.id);
    const auto fail = [&](std::string_view what, std::string_view remedy) {
      input_.fail(fmt::format("{}: object {} {}", printable(use.object.part), use.object.id, what),
                  remedy);
    };
    if (object == model.objects.end()) fail("is used but not there", kExportAgain);
    if (std::ranges::find(open_, &object->second) != open_.end()) {
      fail("contains itself", kExportAgain);
    }
    if (open_.size() == kDeepest) fail("has components too deep in each other", "export the mesh");
    limit_.spend(1);
    const Pose pose = outer * use.place;
    add(object->second, pose);
    open_.push_back(&object->second);
    for (const ThreeMfUse& component : object->second.components) place(component, pose);
    open_.pop_back();
  }

  void add(const ThreeMfObject& object, const Pose& pose) {
    limit_.spend(object.vertices.size() + object.triangles.size());
    const auto first = static_cast<std::uint32_t>(content_.vertices.size());
    // A negative zero would become zero in its own place.
    const bool stays = pose.rotation.isIdentity(0) && pose.shift.isZero(0);
    for (const Point& vertex : object.vertices) {
      content_.add_vertex(stays ? vertex : pose(vertex), "vertex", content_.vertices.size());
    }
    const bool mirrored = pose.rotation.determinant() < 0;
    for (Triangle t : object.triangles) {
      if (mirrored) std::swap(t[1], t[2]);
      content_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }

  const InputFile& input_;
  ZipReader zip_;
  CopyLimit limit_;
  std::map<std::string, ThreeMfModel> parts_;
  std::vector<const ThreeMfObject*> open_;  // those around the one that is placed
  FileContent content_;
};

}  // namespace

FileContent read_threemf(const InputFile& input) { return Package(input).read(); }

}  // namespace emax
