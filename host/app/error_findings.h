#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/app/measured_mesh.h"
#include "host/app/piece_runner.h"
#include "host/app/scan_pieces.h"
#include "host/measure/error_constraint.h"
#include "host/report/result_json.h"

namespace emax {

// The reference that a mesh is measured against: a surface, or a cloud as triangles of no size.
struct ErrorReference {
  std::string name;
  // kScan: the cloud that is measured; kCloud: another cloud.
  enum class Kind { kScan, kCloud, kSurface } kind;
  TriangleMesh mesh;
};
ErrorReference cloud_reference(std::string name, ErrorReference::Kind kind,
                               std::vector<Point> points);

// What is asked of a mesh.
struct ErrorQuestion {
  std::optional<Tolerance> tolerance;  // in the scan's unit
  double excluded_share = 0;
  std::vector<double> quantiles;  // percent; empty: the usual ones
  std::size_t worst = 5;
  bool brute_force = false;
  Evaluator* device = nullptr;               // nullptr: this processor
  std::uint64_t memory = standard_memory();  // bytes; some are for the distances of the points
  std::function<bool()> interrupted;
  std::function<void(double)> advance;  // told the share of the points that are measured
  PieceRunner* runner = nullptr;        // nullptr: the threads of this processor
  MeterFiles files = {};                // of the mesh, where the runner has other processes
};

// All results for the mesh. Indices of points are the file's, but those of `measured.excluded` are
// the cloud's where it is in memory.
struct ErrorFindings {
  std::optional<Tolerance> tolerance;
  MeasuredError measured = {};
  double seconds = 0;
  std::uint64_t points = 0;  // of the scan
  CertifiedError certified;
  MeshValidity validity;
  MeshTopology topology;
  std::size_t triangles = 0;  // of the mesh
  Normalization transform;
  std::size_t excludable = 0;
  std::vector<double> distances;  // of every point of the scan, where they are in memory
  ErrorReport errors;

  std::optional<MeshTopology> reference_topology() const {
    return errors.reference ? errors.reference->topology : std::nullopt;
  }
  // Names the parts that are farther than the tolerance; empty if it is kept.
  std::string_view exceeding() const;
  bool feasible() const { return errors.limit && exceeding().empty(); }
};

// `mesh` has no vertex without a triangle. `measured`, if given, is called once a device has
// measured the mesh. For a device the points must be in memory and the mesh whole, for a reference
// the mesh whole. The same results wherever they are and for any number of threads. Throws Error as
// ErrorConstraint and require_resolution() do, and Interrupted.
ErrorFindings find_errors(
    const MeasuredMesh& mesh, const ScanPieces& scan,
    const std::optional<ErrorReference>& reference, const ErrorQuestion& question,
    const std::function<void(ErrorConstraint&, const ErrorFindings&)>& measured = nullptr);

// The JSON of the findings, without what a device adds.
ResultReport report_of(const ErrorFindings& findings, const Scan& scan);

}  // namespace emax
