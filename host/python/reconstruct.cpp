#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "host/app/search_settings.h"
#include "host/files/tolerance.h"
#include "host/optimize/run_bound.h"
#include "host/python/arrays.h"
#include "host/python/attended.h"
#include "host/python/bindings.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace nb = nanobind;

namespace emax {
namespace {

// The reference surface of a run.
struct FittedSurface {
  TriangleMesh mesh;
  CertifiedError points;  // over all points but the outliers
  std::vector<std::uint32_t> outliers;
  std::string method;
};

struct ReconstructQuestion {
  std::string max_error, method, exclude_outliers, worker;
  bool closed = false;
  unsigned jobs = 0;
};

FittedSurface reconstruct(const GivenCloud& cloud, const ReconstructQuestion& question,
                          const Watch& watch) {
  const Scan& scan = cloud.scan;
  const double epsilon =
      below_width(parse_tolerance(question.max_error, "max_error"), "max_error", scan);
  OptimizeOptions options;
  options.method = question.method;
  options.closed = question.closed;
  options.jobs = question.jobs;
  options.output = "reconstruction.ply";  // whose coordinates are not rounded
  OptimizeSettings settings = search_settings(options);
  suit_to_cloud(settings, options, scan.cloud.points.size());
  settings.worker = question.worker;
  settings.epsilon_back = epsilon;
  settings.interrupted = [&] { return watch.stopped(); };
  ErrorConstraint constraint(scan.cloud.points, epsilon, parse_share(question.exclude_outliers),
                             false, processor_threads());
  ReferenceFit fit;
  DecimationBound bound = decimation_bound(scan.cloud.points, constraint, settings, &fit);
  FittedSurface made;
  made.points = in_file_indices(
      certify(scan.cloud.points, bound.reference.view(), bound.outliers, processor_threads()),
      scan.cloud);
  made.outliers = made.points.excluded;
  made.method = fit.tried.empty() ? settings.method : fit.best().chain.method;
  made.mesh = std::move(bound.reference);
  return made;
}

}  // namespace

void bind_reconstruct(nb::module_& module) {
  using Self = nb::handle_t<FittedSurface>;
  nb::class_<ReconstructQuestion>(module, "ReconstructQuestion")
      .def(nb::init<>())
      .def_rw("max_error", &ReconstructQuestion::max_error)
      .def_rw("method", &ReconstructQuestion::method)
      .def_rw("exclude_outliers", &ReconstructQuestion::exclude_outliers)
      .def_rw("worker", &ReconstructQuestion::worker)
      .def_rw("closed", &ReconstructQuestion::closed)
      .def_rw("jobs", &ReconstructQuestion::jobs);
  nb::class_<FittedSurface>(module, "FittedSurface")
      .def_prop_ro(
          "vertices",
          [](Self self) { return view_of(nb::cast<FittedSurface&>(self).mesh.vertices, self); },
          nb::rv_policy::reference)
      .def_prop_ro(
          "faces",
          [](Self self) { return view_of(nb::cast<FittedSurface&>(self).mesh.triangles, self); },
          nb::rv_policy::reference)
      .def_prop_ro("e_max", [](const FittedSurface& self) { return self.points.e_max_upper; })
      .def_prop_ro("outliers",
                   [](const FittedSurface& self) {
                     nb::list outliers;
                     for (const std::uint32_t i : self.outliers) outliers.append(i);
                     return outliers;
                   })
      .def_ro("method", &FittedSurface::method);
  module.def(
      "reconstruct",
      [](const GivenCloud& cloud, const ReconstructQuestion& question) {
        return attended(nb::none(), [&](Watch& watch) -> std::function<nb::object()> {
          auto made = std::make_shared<FittedSurface>(reconstruct(cloud, question, watch));
          return [made] { return nb::cast(std::move(*made)); };
        });
      },
      nb::arg("cloud"), nb::arg("question"));
}

}  // namespace emax
