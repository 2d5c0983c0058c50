#pragma once

#include "host/reconstruct/reconstruction.h"

namespace emax {

class GreedyProjection : public ReconstructionMethod {
 public:
  std::string_view name() const override { return "gp3"; }

 private:
  Reconstruction run(const LocalCloud& cloud, const ParameterValues& values) const override;
};

class PoissonSurface : public ReconstructionMethod {
 public:
  std::string_view name() const override { return "poisson"; }

 private:
  Reconstruction run(const LocalCloud& cloud, const ParameterValues& values) const override;
};

class HoppeSurface : public ReconstructionMethod {
 public:
  std::string_view name() const override { return "hoppe"; }

 private:
  Reconstruction run(const LocalCloud& cloud, const ParameterValues& values) const override;
};

class ImplicitSurface : public ReconstructionMethod {
 public:
  std::string_view name() const override { return "imls"; }

 private:
  Reconstruction run(const LocalCloud& cloud, const ParameterValues& values) const override;
};

}  // namespace emax
