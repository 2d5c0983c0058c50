#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/features/shapes.h"
#include "host/geometry/mesh_topology.h"
#include "host/geometry/mesh_validity.h"
#include "host/measure/error_constraint.h"
#include "host/report/certificate_file.h"
#include "host/report/error_report.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/protocol/cycle_model.h"
#include "sw_model/protocol/device.h"

namespace emax {

// The content of --json of `optimize` and `error`. The keys are stable. A value that was not asked
// for or not reached is null.
// A shape that triangles of a result lie on. Lengths in file units.
struct ResultRegion {
  std::string name;
  Shape shape;
  std::size_t triangles = 0;
  double area = 0;         // of these
  std::size_t points = 0;  // of the cloud, that the shape was found from
  double rms = 0;          // of their distances from it
};

struct ResultReport {
  std::optional<bool> feasible;  // null without an epsilon
  std::optional<MeshValidity> validity;
  std::optional<MeshTopology> topology;
  std::optional<std::size_t> triangles;  // of the best mesh, else of the one with the least error
  std::optional<double> epsilon;         // file units
  std::optional<std::string> unit;       // of the file, where it is known
  std::optional<CertifiedError> certified;  // indices are the file's
  std::optional<EmaxResult> kernel;         // over the kept points; the index is the file's
  std::size_t points = 0;
  Normalization transform;
  std::optional<std::uint64_t> evaluations;
  std::optional<std::uint64_t> seed;
  std::optional<std::map<std::string, std::uint64_t>> failures;  // of evaluations, by reason
  std::optional<std::string> ended_by;                           // of a search
  std::optional<std::size_t> reconstruction_triangles, unmeshed_points;
  std::optional<std::vector<std::string>> lost_attributes;  // of the mesh that was decimated
  std::string device;
  std::optional<DeviceCounters> counters;
  std::optional<BoardModel> board;    // the board whose time is to be predicted
  std::optional<double> cpu_seconds;  // time of the same work on this CPU
  std::optional<ErrorReport> errors;  // with a surface, the bound is two-sided
  // Where shapes of the scan were followed: those that triangles lie on.
  std::optional<std::vector<ResultRegion>> regions;
  bool two_sided = false;
  std::optional<ReferenceBound> reference;  // of a two-sided bound that holds
  std::string page, picture;                // files of --report and --picture; empty: none
};

std::string to_json_text(const ResultReport& report);

}  // namespace emax
