#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <emax/genocop.h>
#include "host/genocop/linear_domain.h"

namespace emax {

// An evaluated point in the coordinates of a local search.
struct LocalPoint {
  Genes free;
  Eigen::VectorXd at;
  Eigen::VectorXd responses;
  double violation;
};

// Some coordinates of the domain as a space of its own, each scaled by its gene's width. The other
// coordinates stay as they are at the centre of a local search. Coordinates that have no meaning
// with the categories of `at` belong to neither.
class LocalSpace {
 public:
  LocalSpace(const LinearDomain& domain, const Problem& problem,
             const std::vector<std::size_t>& coordinates, const Genes& at);

  Eigen::Index size() const { return static_cast<Eigen::Index>(coordinates_.size()); }
  Eigen::VectorXd position(const Genes& free) const;
  Genes moved(const Genes& centre, const Eigen::VectorXd& step) const;  // pulled inside
  bool same_rest(const Genes& a, const Genes& b) const;
  // Returns nothing if the evaluation failed or a response is not finite. The responses are the
  // objective and the values of the nonlinear constraints, or only the greatest violation if the
  // single values are not known.
  std::optional<LocalPoint> point(const Genes& free, const Evaluation& evaluation) const;
  double violation(const Eigen::VectorXd& responses) const;
  // Notes an evaluation that failed here. Steps then stay nearer to their centre than to it.
  void failed(const Genes& free) { failed_.push_back(free); }
  // Whether a step from `centre` to `free` would not.
  bool nears_a_failure(const Genes& centre, const Genes& free) const;

  // Divides the values of the nonlinear constraints by these, from now on. The other function does
  // it for a point from before.
  void scale(const Eigen::VectorXd& scales);
  void scale(LocalPoint& point, const Eigen::VectorXd& scales) const;

  // The linear constraints, what the failures leave and last the domain as rows * step <= bounds,
  // within `radius` of the centre.
  void linear_rows(const Genes& centre, double radius, Eigen::MatrixXd& rows,
                   Eigen::VectorXd& bounds) const;
  const std::vector<NonlinearConstraint>& constraints() const { return constraints_; }

 private:
  std::vector<Eigen::VectorXd> ways_to_failures(const Genes& centre, double radius) const;

  const LinearDomain& domain_;
  std::vector<std::size_t> coordinates_;
  std::vector<bool> is_rest_;
  std::vector<Genes> failed_;
  Eigen::VectorXd widths_;
  std::vector<NonlinearConstraint> constraints_;
  Eigen::VectorXd scales_;  // that the constraints' values are divided by
  bool single_;             // only the greatest violation is known
};

// Models of all responses around a centre: value + gradient' s + s' hessian s / 2.
struct LocalModel {
  Eigen::VectorXd values;
  Eigen::MatrixXd gradients;              // a column for each response
  std::vector<Eigen::MatrixXd> hessians;  // empty: linear

  Eigen::VectorXd at(const Eigen::VectorXd& step) const;
  Eigen::VectorXd gradient(std::size_t response, const Eigen::VectorXd& step) const;
};

// Weighted least squares with a slight preference for small gradients; exact for linear responses
// if the steps span the space. `steps` and `values` have a row for each point; steps are relative
// to a centre with `centre_values`.
LocalModel fit_linear(const Eigen::MatrixXd& steps, const Eigen::MatrixXd& values,
                      const Eigen::VectorXd& centre_values, const Eigen::VectorXd& weights);
// Interpolation. Of all Hessians that fit, it takes those that differ least, in the Frobenius norm,
// from the `earlier` ones (Powell 2004), which may be none. O((points + coordinates)^3).
LocalModel fit_quadratic(const Eigen::MatrixXd& steps, const Eigen::MatrixXd& values,
                         const Eigen::VectorXd& centre_values,
                         const std::vector<Eigen::MatrixXd>& earlier);

struct LocalStep {
  Eigen::VectorXd step;
  double reduction = 0;    // of the merit objective + penalty * violation, predicted by the model
  double multipliers = 0;  // sum over the nonlinear constraints: the least exact penalty
};

// The best point of the model within `radius` of the centre and inside the linear domain. For a
// linear model it solves a linear program, else a few steps of sequential quadratic programming on
// the model. `penalty` is raised where the constraints need it (an exact penalty on the greatest
// violation; Byrd, Nocedal & Waltz 2008).
LocalStep best_step(const LocalSpace& space, const Genes& centre, const LocalModel& model,
                    double radius, double& penalty);

}  // namespace emax
