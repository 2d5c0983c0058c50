#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/genocop/local_model.h"

namespace emax {

// A local search on the continuous genes, the others held: interpolation on points around the best
// one, a step that is best for the models within a trust region, and points added where they leave
// a direction open, as COBYLA does (Powell 1994), with models of the least curvature that fits
// (COBYQA, Ragonneau & Zhang 2024). The merit is the objective plus a penalty on the violation, so
// it may start and pass outside the constraints.
class Finish {
 public:
  // `coordinates`: continuous and movable ones of the domain, at least one. Domain and problem
  // outlive it.
  Finish(const LinearDomain& domain, const Problem& problem, std::vector<std::size_t> coordinates);

  // Runs unless the evaluation is one that no model can start from (LocalSpace::point).
  void start(const Genes& free, const Evaluation& evaluation, double radius);
  bool running() const { return running_; }
  void stop();

  // The next trial; none when the search has ended, or when the models lack no point but wait for
  // one in flight.
  std::optional<Genes> propose();
  void asked(const Genes& free);  // what propose() gave is in flight
  // Any result, of a trial or not.
  void told(const Genes& free, const Evaluation& evaluation);

  // The best point of the search that runs or has ended; nullptr before the first and after stop().
  const Genes* centre() const { return points_.empty() ? nullptr : &points_[centre_].free; }

 private:
  struct Trial {
    Genes free;
    Eigen::VectorXd at;
    std::optional<double> reduction;  // predicted; none: asked for the model's sake
  };
  struct Selection {
    std::vector<std::size_t> points;  // nearest first
    std::optional<Genes> missing;     // a point that the models need
  };

  double merit(const LocalPoint& point) const;
  void choose_centre();
  void judge_step(const Trial& trial, const LocalPoint* point);
  Selection select() const;
  LocalModel fit(const std::vector<std::size_t>& chosen);
  void shrink(double factor);

  const LinearDomain& domain_;
  const Problem& problem_;
  std::vector<std::size_t> coordinates_;
  std::optional<LocalSpace> space_;  // of the search that runs
  bool running_ = false;
  double radius_ = 0;
  double penalty_ = 0;
  std::vector<LocalPoint> points_;
  std::size_t centre_ = 0;
  std::vector<Eigen::MatrixXd> hessians_;  // of the last models
  int failures_ = 0;                       // steps in a row that kept little of their promise
  std::vector<Trial> trials_;              // in flight
  std::optional<Trial> next_;              // what propose() gave last
};

}  // namespace emax
