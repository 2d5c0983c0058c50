#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/genocop/local_model.h"

namespace emax {

// A local search on the continuous genes; the other genes are held. It interpolates points around
// the best one and takes the step that is best for the models within a trust region. It adds points
// where the models leave a direction open, as COBYLA does (Powell 1994); the models have the least
// curvature that fits (COBYQA, Ragonneau & Zhang 2024). The merit is the objective plus a penalty
// on the violation, so the search may start outside the constraints and pass through there.
class Finish {
 public:
  // `coordinates`: continuous, movable coordinates of the domain, at least one. Domain and problem
  // must outlive the search.
  Finish(const LinearDomain& domain, const Problem& problem, std::vector<std::size_t> coordinates);

  // Starts a search, unless no model can start from the evaluation (LocalSpace::point).
  void start(const Genes& free, const Evaluation& evaluation, double radius);
  bool running() const { return running_; }
  void stop();
  // Whether the last step gained a good part of what the model predicted.
  bool predicts_well() const { return predicts_well_; }

  // The next trial. Nothing if the search has ended, or if the models have all points except those
  // in flight.
  std::optional<Genes> propose();
  void asked(const Genes& free);  // call this when the trial from propose() is in flight
  // Takes any result, also of points that are not trials.
  void told(const Genes& free, const Evaluation& evaluation);

  // The best point of the present or last search; nullptr before the first search and after stop().
  const Genes* centre() const { return points_.empty() ? nullptr : &points_[centre_].free; }

 private:
  struct Trial {
    Genes free;
    Eigen::VectorXd at;
    std::optional<double> reduction;  // predicted; nothing for a point that only the model needs
  };
  struct Selection {
    std::vector<std::size_t> points;  // nearest first
    std::optional<Genes> missing;     // a point that the models need
  };

  double merit(const LocalPoint& point) const;
  void choose_centre();
  void judge_step(const Trial& trial, const LocalPoint& point);
  Selection select() const;
  LocalModel fit(const std::vector<std::size_t>& chosen);
  void scale_constraints(const LocalModel& model);
  void shrink(double factor);

  const LinearDomain& domain_;
  const Problem& problem_;
  std::vector<std::size_t> coordinates_;
  std::optional<LocalSpace> space_;  // of the present search
  bool running_ = false;
  double radius_ = 0;
  double penalty_ = 0;
  bool scaled_ = false;  // the constraints are
  std::vector<LocalPoint> points_;
  std::size_t centre_ = 0;
  std::vector<Eigen::MatrixXd> hessians_;  // of the last models
  bool predicts_well_ = false;
  int failures_ = 0;           // steps in a row that gained little of the predicted reduction
  std::vector<Trial> trials_;  // in flight
  std::optional<Trial> next_;  // the last result of propose()
};

}  // namespace emax
