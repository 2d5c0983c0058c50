#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/scan.h"
#include "host/files/atomic_file.h"
#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/files/scan_folder.h"
#include "host/geometry/bounds.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/scan_estimate.h"
#include "host/report/json_parts.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kFewest = 100;  // points that say something of a scan

// What a file of a cloud or a mesh holds.
struct Contents {
  PointCloud cloud;  // of a mesh: its vertices
  std::optional<MeshFile> mesh;
  MeshValidity validity;  // of the mesh
  MeshTopology topology;  // likewise
  Bounds bounds;
  ScanEstimate scan;
};

Contents read(const InfoOptions& options) {
  Contents contents;
  if (is_surface(options.file)) {
    if (!options.reading.left_out_classes.empty()) {
      throw Error(fmt::format(
          "{}: --class: only LAS and LAZ files have classes; leave the option out", options.file));
    }
    contents.mesh = read_mesh_file(options.file);
    contents.cloud.points = contents.mesh->mesh.vertices;
    contents.cloud.unit = contents.mesh->unit;
    contents.validity = check_mesh(contents.mesh->mesh.view(), processor_threads());
    contents.topology = topology_of(contents.mesh->mesh.view());
  } else {
    contents.cloud = read_cloud(options.file, options.reading);
  }
  contents.bounds = bounds_of(contents.cloud.points);
  if (contents.cloud.points.size() >= kFewest) contents.scan = estimate_scan(contents.cloud.points);
  return contents;
}

void print(const InfoOptions& options, const Contents& c) {
  Facts facts;
  fmt::print("file           {}, {} bytes\n", options.file, grouped(bytes_of_input(options.file)));
  if (c.mesh) {
    fmt::print("mesh           {} triangles, {} vertices; {}\n",
               grouped(c.mesh->mesh.triangles.size()), grouped(c.cloud.points.size()),
               describe(c.validity));
    fmt::print("topology       {}\n", describe(c.topology));
    if (!c.mesh->attributes.empty()) {
      fmt::print("also has       {}; emax does not keep these\n",
                 fmt::join(c.mesh->attributes, ", "));
    }
  } else {
    fmt::print("cloud          {} points{}\n", grouped(c.cloud.points.size()),
               c.cloud.normals.empty() ? "" : ", with normals");
    print_left_out(facts, c.cloud);
    if (!c.cloud.scans.empty()) {
      std::vector<std::string> names;
      for (const ScanPart& scan : c.cloud.scans) names.push_back(scan.name);
      fmt::print("scans          {}: {}\n", names.size(), fmt::join(names, ", "));
    }
    if (c.cloud.resolution > 0) {
      fmt::print("resolution     stored within {:.3g}: enough for --max-error {:.3g} and more\n",
                 c.cloud.resolution, c.cloud.resolution / kResolutionShare);
    }
  }
  if (c.cloud.unit) fmt::print("unit           {}\n", c.cloud.unit->name);
  const Point size = c.bounds.upper - c.bounds.lower;
  fmt::print("extent         {:.6g} x {:.6g} x {:.6g}, from ({:.6g}, {:.6g}, {:.6g})\n", size.x(),
             size.y(), size.z(), c.bounds.lower.x(), c.bounds.lower.y(), c.bounds.lower.z());
  print_doubtful_unit(facts, c.bounds.width(), c.cloud.unit);
  if (const std::optional<double> suggested = suggested_tolerance(c.scan)) {
    fmt::print("scan           points {:.3g} apart, noise {:.2g}\n", c.scan.spacing, c.scan.noise);
    fmt::print("suggested      --max-error {:.2g} ({:.2g}% of the width): {}\n", *suggested,
               100 * *suggested / c.bounds.width(), kWhySuggested);
  }
}

Json to_json(const InfoOptions& options, const Contents& c) {
  const auto place = [](const Point& p) { return Json{p.x(), p.y(), p.z()}; };
  Json json = {{"schema", "emax-info-1"},
               {"file", options.file},
               {"points", c.cloud.points.size()},
               {"triangles", nullptr},
               {"attributes", Json::array()},
               {"normals", !c.cloud.normals.empty()},
               {"lower", place(c.bounds.lower)},
               {"upper", place(c.bounds.upper)},
               {"width", c.bounds.width()},
               {"unit", nullptr},
               {"resolution", c.cloud.resolution},
               {"scans", Json::array()},
               {"left_out", Json::object()},
               {"spacing", nullptr},
               {"noise", nullptr},
               {"suggested_max_error", nullptr},
               {"validity", nullptr},
               {"topology", nullptr}};
  if (c.cloud.unit) json["unit"] = c.cloud.unit->name;
  for (const ScanPart& scan : c.cloud.scans) {
    json["scans"].push_back({{"name", scan.name}, {"begin", scan.begin}});
  }
  for (const LeftOut& part : c.cloud.left_out) json["left_out"][part.reason] = part.points;
  if (c.mesh) {
    json["triangles"] = c.mesh->mesh.triangles.size();
    json["attributes"] = c.mesh->attributes;
    json["validity"] = to_json(c.validity);
    json["topology"] = to_json(c.topology);
  }
  if (const std::optional<double> suggested = suggested_tolerance(c.scan)) {
    json["spacing"] = c.scan.spacing;
    json["noise"] = c.scan.noise;
    json["suggested_max_error"] = *suggested;
  }
  return json;
}

}  // namespace

int run_info(const InfoOptions& options) {
  if (!options.json.empty()) {
    check_output(options.json, kJsonEndings);
    check_distinct({options.json}, {options.file});
  }
  const Contents contents = read(options);
  print(options, contents);
  if (json_is_wanted(options.json)) {
    write_json(options.json, to_json(options, contents).dump(2) + "\n");
  }
  return kExitOk;
}

}  // namespace emax
