// A model part of a 3MF package, by the core specification 1.3 and the production extension.

#include "host/files/threemf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <set>

#include "host/files/number_text.h"
#include "host/files/threemf_names.h"
#include "host/files/xml_reader.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr std::string_view kProductionPath =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06|path";
// Required extensions that leave shapes as they are, or that this reader knows.
constexpr std::array<std::string_view, 3> kKnownExtensions = {
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"};

// The elements that are read, each with the only one that it may stand in.
enum class Tag {
  kNone,
  kModel,
  kResources,
  kObject,
  kMesh,
  kVertices,
  kVertex,
  kTriangles,
  kTriangle,
  kComponents,
  kComponent,
  kBuild,
  kItem,
  kOther
};
struct TagName {
  std::string_view name;
  Tag tag, within;
};
constexpr std::array<TagName, 12> kTags = {{{"vertex", Tag::kVertex, Tag::kVertices},
                                            {"triangle", Tag::kTriangle, Tag::kTriangles},
                                            {"model", Tag::kModel, Tag::kNone},
                                            {"resources", Tag::kResources, Tag::kModel},
                                            {"object", Tag::kObject, Tag::kResources},
                                            {"mesh", Tag::kMesh, Tag::kObject},
                                            {"vertices", Tag::kVertices, Tag::kMesh},
                                            {"triangles", Tag::kTriangles, Tag::kMesh},
                                            {"components", Tag::kComponents, Tag::kObject},
                                            {"component", Tag::kComponent, Tag::kComponents},
                                            {"build", Tag::kBuild, Tag::kModel},
                                            {"item", Tag::kItem, Tag::kBuild}}};

class ModelReader {
 public:
  ModelReader(const InputFile& input, const std::string& part, CopyLimit& limit)
      : part_(part),
        limit_(limit),
        xml_(input, part,
             {.begin = [this](auto space, auto name,
                              const auto& attributes) { begin(space, name, attributes); },
              .end = [this](auto, auto) { open_.pop_back(); },
              .prefix = [this](auto prefix, auto uri) { prefixes_.emplace(prefix, uri); }}) {}

  ThreeMfModel read(ZipReader& zip) {
    zip.read(part_, [this](std::string_view piece) { xml_.take(piece); });
    xml_.finish();
    return std::move(model_);
  }

 private:
  void begin(std::string_view space, std::string_view name, const XmlAttributes& attributes) {
    const Tag within = open_.empty() ? Tag::kNone : open_.back();
    const auto known =
        space == kThreeMfCore ? std::ranges::find(kTags, name, &TagName::name) : kTags.end();
    Tag tag = Tag::kOther;
    if (known != kTags.end() && within != Tag::kOther) {
      if (known->within != within) {
        xml_.fail(fmt::format("<{}> cannot stand here", name), "export it again");
      }
      tag = known->tag;
    } else if (within == Tag::kNone) {
      xml_.fail("is not a 3MF model", "check that the file is of this format");
    } else if (within == Tag::kResources) {
      model_.has_materials = true;
    }
    open_.push_back(tag);
    read(tag, attributes);
  }

  void read(Tag tag, const XmlAttributes& attributes) {
    switch (tag) {
      case Tag::kModel:
        return read_model(attributes);
      case Tag::kObject:
        return read_object(attributes);
      case Tag::kVertex:
        return read_vertex(attributes);
      case Tag::kTriangle:
        return read_triangle(attributes);
      case Tag::kComponent:
        limit_.allow(1);
        return object_->components.push_back(use(attributes));
      case Tag::kItem:
        limit_.allow(1);
        return model_.build.push_back(use(attributes));
      default:
        return;
    }
  }

  void read_model(const XmlAttributes& attributes) {
    const std::string_view unit = attributes.find("unit").value_or("millimeter");
    const auto known =
        std::ranges::find(kThreeMfUnits, unit, [](const auto& names) { return names.first; });
    if (known == kThreeMfUnits.end()) {
      xml_.fail(fmt::format("no such unit \"{}\"", printable(unit)), "export it in millimeter");
    }
    model_.unit = unit_named(known->second);
    std::string_view required = attributes.find("requiredextensions").value_or("");
    while (!required.empty()) {
      const std::size_t end = std::min(required.find(' '), required.size());
      if (end > 0) require_known(required.substr(0, end));
      required.remove_prefix(std::min(end + 1, required.size()));
    }
  }

  void require_known(std::string_view prefix) {
    const auto uri = prefixes_.find(prefix);
    if (uri != prefixes_.end() &&
        std::ranges::find(kKnownExtensions, uri->second) != kKnownExtensions.end()) {
      return;
    }
    xml_.fail(fmt::format("it needs the extension \"{}\", which emax does not read",
                          printable(uri == prefixes_.end() ? prefix : uri->second)),
              "export it as a plain mesh");
  }

  void read_object(const XmlAttributes& attributes) {
    const std::uint64_t id = whole(attributes, "id");
    const auto [object, is_new] = model_.objects.try_emplace(id);
    if (!is_new) xml_.fail(fmt::format("a second object {}", id), "export it again");
    limit_.allow(1);
    object_ = &object->second;
  }

  void read_vertex(const XmlAttributes& attributes) {
    limit_.allow(1);
    object_->vertices.emplace_back(number(attributes, "x"), number(attributes, "y"),
                                   number(attributes, "z"));
  }

  void read_triangle(const XmlAttributes& attributes) {
    limit_.allow(1);
    Triangle triangle{};
    constexpr std::array<const char*, 3> kNames = {"v1", "v2", "v3"};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t corner = whole(attributes, kNames[k]);
      if (corner >= object_->vertices.size() && !EMAX_FAULT(kTrustsIndices)) {
        xml_.fail(
            fmt::format("vertex index {} is outside 0..{} - 1", corner, object_->vertices.size()),
            kExportAgain);
      }
      triangle[k] = static_cast<std::uint32_t>(corner);
    }
    object_->triangles.push_back(triangle);
  }

  ThreeMfUse use(const XmlAttributes& attributes) {
    const std::optional<std::string_view> path = attributes.find(kProductionPath);
    ThreeMfUse use{{path ? threemf_part(*path) : part_, whole(attributes, "objectid")}, {}};
    const std::optional<std::string_view> matrix = attributes.find("transform");
    if (matrix) use.place = placement(*matrix);
    return use;
  }

  // Twelve numbers: the images of the three axes, then the shift.
  Pose placement(std::string_view text) {
    Pose pose;
    for (int i = 0; i < 12; ++i) {
      text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
      const std::size_t end = std::min(text.find(' '), text.size());
      const std::optional<double> value = parse_double(text.substr(0, end));
      if (!value) xml_.fail("\"transform\" is not 12 numbers", "export it again");
      (i < 9 ? pose.rotation(i % 3, i / 3) : pose.shift[i - 9]) = *value;
      text.remove_prefix(end);
    }
    if (text.find_first_not_of(' ') != text.npos) {
      xml_.fail("\"transform\" is more than 12 numbers", "export it again");
    }
    return pose;
  }

  std::string_view required(const XmlAttributes& attributes, const char* name) {
    const std::optional<std::string_view> text = attributes.find(name);
    if (!text) xml_.fail(fmt::format("\"{}\" is missing", name), "export it again");
    return *text;
  }
  double number(const XmlAttributes& attributes, const char* name) {
    const std::string_view text = required(attributes, name);
    const std::optional<double> value = parse_double(text);
    if (!value) {
      xml_.fail(fmt::format("\"{}\" is not a 64-bit number", printable(text)), "export it again");
    }
    return *value;
  }
  std::uint64_t whole(const XmlAttributes& attributes, const char* name) {
    const std::string_view text = required(attributes, name);
    const std::optional<std::int64_t> value = parse_integer(text);
    if (!value || *value < 0) {
      xml_.fail(fmt::format("\"{}\" is not a whole number from 0", printable(text)),
                "export it again");
    }
    return static_cast<std::uint64_t>(*value);
  }

  const std::string& part_;
  CopyLimit& limit_;
  ThreeMfModel model_;
  ThreeMfObject* object_ = nullptr;  // the last that began
  std::vector<Tag> open_;
  std::map<std::string, std::string, std::less<>> prefixes_;  // the first of each name
  XmlReader xml_;
};

}  // namespace

ThreeMfModel read_threemf_model(const InputFile& input, ZipReader& zip, const std::string& part,
                                CopyLimit& limit) {
  return ModelReader(input, part, limit).read(zip);
}

std::string threemf_part(std::string_view name) {
  while (name.starts_with('/')) name.remove_prefix(1);
  return std::string(name);
}

}  // namespace emax
