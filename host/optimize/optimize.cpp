#include "host/optimize/optimize.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <utility>

#include "host/genocop/look_ahead_scheduler.h"
#include "host/optimize/search_result.h"
#include "host/parameters/registry.h"
#include "host/worker_pool/worker_pool.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// So many of the longest decimations is it expected to take: 1.3 to 1.6, and up to 3 where the
// reference is rough (decision 0020).
constexpr double kPolishDecimations = 3;
// One evaluation in so many has no rival, so that the search also knows how candidates rank that
// will not be the best.
constexpr std::uint64_t kWithoutRival = 4;

bool same_bits(const Genes& a, const Genes& b) {
  return std::ranges::equal(
      a, b, {}, [](double x) { return std::bit_cast<std::uint64_t>(x); },
      [](double x) { return std::bit_cast<std::uint64_t>(x); });
}

// What the search is told.
Evaluation evaluation_of(const Problem& problem, const LoggedEvaluation& e) {
  if (!e.failure.empty()) return {};
  const std::uint64_t triangles = e.expected_triangles.value_or(e.triangles);
  return make_evaluation(problem.nonlinear, static_cast<double>(triangles), e.constraints);
}

using Result = SearchResult;

class Run {
 public:
  Run(std::span<const Point> cloud, ErrorConstraint& constraint, Evaluator* device,
      const OptimizeSettings& settings, const OptimizeObserver& observe)
      : cloud_(cloud),
        constraint_(constraint),
        device_(device),
        settings_(settings),
        observe_(observe),
        problem_(search_problem(settings)),
        walked_(walked_gene(settings)),
        genocop_(problem_, settings.config.search, settings.seed),
        scheduler_(genocop_, settings.config.search.budget) {
    state_.budget = settings.config.search.budget;
    if (settings.log != nullptr) {
      for (const auto& [index, e] : settings.log->evaluations()) {
        seconds_before_ = std::max(seconds_before_, e.seconds);
      }
    }
    search_.interrupted = [this] { return !stopping_ && settings_.interrupted(); };
  }

  OptimizeState run() {
    start_workers(settings_.jobs);
    while (!scheduler_.finished() && !cut_short() && !reached_its_end()) {
      look_for_the_end();
      if (cut_short()) break;
      hand_out();
      if (pool_->outstanding() > 0 && !reached_its_end()) {
        if (std::optional<Result> result = receive()) {
          const std::uint64_t index = result->evaluation.index;
          scheduler_.complete(index, evaluation_of(problem_, result->evaluation));
          results_[index] = std::move(*result);
        }
      }
      enter_in_order();
      state_.evaluations = genocop_.asked() - in_work_.size();
      if (pool_->outstanding() > 0) load_best();
      if (polishes()) state_.polish_seconds = expected_polish_seconds(ranking_.size());
      observe_(state_);
    }
    for (Result& result : stop_workers()) {
      const std::uint64_t index = result.evaluation.index;
      results_.insert_or_assign(index, std::move(result));
    }
    if (reached_its_end()) state_.evaluations = next_;
    if (cut_short()) enter_the_rest();
    if (settings_.polish && state_.best && may_polish()) polish();
    if (std::optional<BestMesh>& shown = state_.best ? state_.best : state_.least_error;
        shown && shown->mesh.triangles.empty()) {
      restore(*shown);
    }
    return std::move(state_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void look_for_the_end() {
    state_.interrupted = settings_.interrupted();
    state_.out_of_time = settings_.seconds_left() <= stopping_seconds() + polish_seconds();
  }

  // How long stopped workers may take until they have answered: the distances between mesh and
  // reference are still measured.
  double stopping_seconds() const {
    constexpr double kAlways = 0.3, kPerPoint = 6e-5, kShare = 0.15;
    return std::min(kAlways + kPerPoint * static_cast<double>(cloud_.size()), kShare * seconds_);
  }

  // What is kept of limited time for the deep decimation: it takes a few times as long as that of
  // an evaluation, and gains more than the last evaluations do.
  double polish_seconds() const {
    constexpr double kShare = 0.25;
    if (!polishes() || std::isinf(seconds_)) return 0;
    return std::min(kShare * seconds_, expected_polish_seconds(polished_candidates(cloud_.size())));
  }

  bool polishes() const { return settings_.polish && takes_bound(settings_.decimator); }

  double expected_polish_seconds(std::size_t meshes) const {
    const std::size_t rounds = (meshes + settings_.jobs - 1) / settings_.jobs;
    return static_cast<double>(rounds) *
           (surface_seconds_ + kPolishDecimations * decimation_seconds_);
  }

  bool may_polish() const {
    if (state_.interrupted || !state_.device_failure.empty() || state_.target_reached) return false;
    return settings_.seconds_left() > stopping_seconds() + surface_seconds_ + decimation_seconds_;
  }

  bool cut_short() const {
    return state_.interrupted || state_.out_of_time || !state_.device_failure.empty();
  }
  bool reached_its_end() const { return state_.target_reached || state_.stagnated; }

  void start_workers(unsigned jobs, int times = 1) {
    WorkerPoolOptions options = worker_pool_options(cloud_.size(), settings_);
    options.jobs = jobs;
    options.time_limit *= times;
    pool_.reset();  // first, so that never more than `jobs` run
    pool_ = settings_.make_pool(cloud_, settings_.bound, options);
  }

  // Of each evaluation, where there are fewer of them than workers.
  std::uint64_t threads_for(std::uint64_t evaluations) const {
    return std::max<std::uint64_t>(settings_.jobs / std::max<std::uint64_t>(evaluations, 1), 1);
  }

  // Gives the workers what they can take, and one more, so that none waits for the next candidate.
  // What the log knows is answered at once.
  void hand_out() {
    while (pool_->outstanding() <= settings_.jobs && !reached_its_end() &&
           !settings_.interrupted()) {
      std::optional<Candidate> candidate = scheduler_.next();
      if (!candidate) return;
      const std::uint64_t index = candidate->index;
      if (const LoggedEvaluation* known = logged(*candidate)) {
        scheduler_.complete(index, evaluation_of(problem_, *known));
        results_[index].evaluation = *known;
        ++state_.from_log;
        enter_in_order();
      } else {
        CandidateInWork& work = in_work_[index];
        work.genes = std::move(candidate->genes);
        work.rival = rival_of(index);
        if (walked_ &&
            chain(work.genes).parameters.by_name().contains(problem_.genes[*walked_].name)) {
          const Parameter& gene = settings_.config.genes[*walked_];
          work.walk.emplace(gene.lower, gene.upper);
        }
        pool_->submit({index, trial(work), work.rival, threads_for(state_.budget)});
      }
    }
  }

  // The fewest triangles of the results that the search had been told of when it made the
  // candidate; they do not depend on the number of workers.
  std::uint64_t rival_of(std::uint64_t index) const {
    const std::uint64_t look_ahead = settings_.config.search.look_ahead;
    return index < look_ahead || index % kWithoutRival == 0 ? 0 : fewest_.at(index - look_ahead);
  }

  const LoggedEvaluation* logged(const Candidate& candidate) const {
    const LoggedEvaluation* known =
        settings_.log != nullptr ? settings_.log->find(candidate.index) : nullptr;
    if (known != nullptr && known->stopped) return nullptr;
    if (known != nullptr && !same_bits(known->genes, candidate.genes)) {
      throw Error(settings_.log->folder().string() + ": evaluation " +
                  std::to_string(candidate.index) +
                  " has other parameters than this search asks for, so another program or machine "
                  "made it; name another folder");
    }
    return known;
  }

  ChainSettings chain(const Genes& genes) const { return chain_of(settings_, problem_, genes); }
  ChainSettings chain(const LoggedEvaluation& e) const {
    Genes genes = e.genes;
    if (e.walked && walked_) genes[*walked_] = *e.walked;
    return chain(genes);
  }

  ChainSettings trial(const CandidateInWork& work) const {
    Genes genes = work.genes;
    if (work.walk) genes[*walked_] = *work.walk->next();
    return chain(genes);
  }

  // In the log, if there is one.
  std::optional<Result> receive() {
    std::optional<Completed> completed = pool_->wait_for(kHeartbeat);
    if (!completed) return std::nullopt;
    const std::uint64_t index = completed->ticket;
    Result result;
    result.evaluation.index = index;
    CandidateInWork& work = in_work_.at(index);
    result.evaluation.genes = work.genes;
    try {
      judge(std::move(completed->outcome), result);
    } catch (const DeviceFailure& failure) {  // neither of these says anything of the candidate
      state_.device_failure = failure.what();
      return std::nullopt;
    } catch (const Interrupted&) {
      state_.interrupted = true;
      return std::nullopt;
    }
    work.worked += std::exchange(result.evaluation.worked, 0);
    if (work.walk && !work.walk_on(result)) {
      if (!stopping_) {
        pool_->submit({index, trial(work), work.rival, threads_for(state_.budget)});
      }
      return std::nullopt;
    }
    pool_->go_on();
    if (!result.failed()) result.evaluation.worked = work.worked;
    keep(result);
    in_work_.erase(index);
    return result;
  }

  // The best candidates with the deep effort, in order of their ranks. Empty where none has
  // another.
  std::vector<Genes> deep_candidates() const {
    std::vector<Genes> deep;
    const auto effort = std::ranges::find(problem_.genes, Bounded::kEffort.name, &Gene::name);
    if (effort == problem_.genes.end()) return deep;
    for (const auto& [rank, genes] : ranking_) {
      Genes polished = genes;
      polished[static_cast<std::size_t>(effort - problem_.genes.begin())] = Bounded::kDeepEffort;
      // It may be deep already, or have another decimator.
      if (same_bits(polished, genes) || !chain(polished).parameters.contains(Bounded::kEffort)) {
        continue;
      }
      const auto same = [&](const Genes& other) { return same_bits(other, polished); };
      if (std::ranges::none_of(deep, same)) deep.push_back(std::move(polished));
    }
    return deep;
  }

  // As the candidates behind the last one.
  void polish() {
    const std::vector<Genes> deep = deep_candidates();
    if (deep.empty()) return;
    const std::size_t before = state_.best->triangles;
    in_work_.clear();
    for (std::size_t i = 0; i < deep.size(); ++i) {
      const std::uint64_t index = kPolishIndex + i;
      const LoggedEvaluation* known =
          settings_.log != nullptr ? settings_.log->find(index) : nullptr;
      // What is known may be of another best, where the run then ended elsewhere.
      if (known != nullptr && !known->stopped && same_bits(known->genes, deep[i])) {
        enter_polished(Result{*known, {}, {}}, before);
      } else {
        in_work_[index].genes = deep[i];
      }
    }
    if (!in_work_.empty()) decimate_deep(before);
  }

  // What is in work. Which is the best does not depend on the order in which they enter.
  void decimate_deep(std::size_t before) {
    state_.polishing = true;
    state_.polish_seconds = expected_polish_seconds(in_work_.size());
    start_workers(settings_.jobs, kDeepTimeLimit);
    const std::size_t deep = in_work_.size();
    for (const auto& [index, work] : in_work_) {
      pool_->submit({index, chain(work.genes), 0, threads_for(deep)});
    }
    while (!in_work_.empty() && !state_.interrupted && state_.device_failure.empty() &&
           settings_.seconds_left() > stopping_seconds()) {
      observe_(state_);
      if (std::optional<Result> result = receive()) enter_polished(std::move(*result), before);
      state_.interrupted = settings_.interrupted();
    }
    state_.polish_stopped = !in_work_.empty() && !state_.interrupted;
    for (Result& result : stop_workers()) enter_polished(std::move(result), before);
  }

  // `before`: the triangles of the best before any.
  void enter_polished(Result result, std::size_t before) {
    if (!result.failed()) state_.polished = before;
    enter(std::move(result));
  }

  // The meshes at hand of what is in work, as far as they come soon, where somebody waits for the
  // end. The rest is given up: its workers end with the pool.
  std::vector<Result> stop_workers() {
    std::vector<Result> stopped;
    if (pool_ && (state_.interrupted || state_.out_of_time || state_.polishing) &&
        state_.device_failure.empty()) {
      stopping_ = true;
      pool_->stop();
      constexpr double kPatience = 2;  // of whoever pressed Ctrl-C
      const double most =
          state_.interrupted ? std::min(kPatience, stopping_seconds()) : stopping_seconds();
      const auto end = Clock::now() + std::chrono::duration<double>(most);
      while (pool_->outstanding() > 0 && Clock::now() < end) {
        std::optional<Result> result = receive();
        if (result && !result->failed()) stopped.push_back(std::move(*result));
      }
      for (auto& [index, work] : in_work_) {
        if (!work.best || !work.best->feasible()) continue;
        work.best->evaluation.stopped = true;
        ++state_.stopped;
        keep(*work.best);
        stopped.push_back(std::move(*work.best));
      }
      stopping_ = false;
    }
    pool_.reset();
    return stopped;
  }

  void judge(std::variant<ChainResult, Failure> outcome, Result& result) {
    LoggedEvaluation& e = result.evaluation;
    if (const auto* failure = std::get_if<Failure>(&outcome)) {
      e.failure = to_string(failure->reason);
      e.message = failure->message;
      return;
    }
    const ChainResult& made = std::get<ChainResult>(outcome);
    state_.stages += made.seconds;
    e.worked = made.seconds.sum();
    e.stopped = made.stopped;
    if (made.expected_triangles > 0) e.expected_triangles = made.expected_triangles;
    if (made.stopped) {
      if (!state_.polishing) ++state_.stopped;
    } else {
      surface_seconds_ =
          std::max(surface_seconds_, made.seconds.reconstruct + made.seconds.prepare);
      decimation_seconds_ = std::max(decimation_seconds_, made.seconds.decimate);
    }
    const MeshFormat format = mesh_format(settings_.output);
    const auto start = Clock::now();
    try {
      require_storable(made.mesh, format, constraint_.epsilon(), settings_.output);
      result.mesh = as_stored(made.mesh, storage_of(format));
      result.error = device_ != nullptr
                         ? constraint_.measure(result.mesh.view(), *device_, search_)
                         : constraint_.measure(result.mesh.view(), search_.interrupted);
    } catch (const DeviceFailure&) {
      throw;
    } catch (const Error& error) {
      e.failure = to_string(FailureReason::kError);
      e.message = error.what();
      return;
    }
    state_.measuring += std::chrono::duration<double>(Clock::now() - start).count();
    settings_.measured(result.mesh.view(), result.error);
    e.triangles = result.mesh.triangles.size();
    e.constraints = constraints_of(made, result.error, settings_.bound);
    e.squared_bits = result.error.kept.squared_bits;
    e.reconstruction_triangles = made.reconstruction_triangles;
    e.unmeshed_points = made.unmeshed_points;
  }

  // In the log before the search hears of it, its mesh if that may be the best.
  void keep(Result& result) {
    result.evaluation.seconds =
        seconds_before_ + std::chrono::duration<double>(Clock::now() - settings_.begun).count();
    const bool may_be_best = !result.failed() && beats_the_best(result);
    if (!may_be_best) result.mesh = {};
    if (settings_.log == nullptr) return;
    if (stopping_ && (result.failed() || (result.evaluation.stopped && !may_be_best))) return;
    if (may_be_best) {
      settings_.log->append(result.evaluation, result.mesh);
    } else {
      settings_.log->append(result.evaluation);
    }
  }

  // The order of completion depends on the workers, so results enter in that of the candidates.
  void enter_in_order() {
    while (next_ < genocop_.asked() && !reached_its_end() && !in_work_.contains(next_)) {
      // The search answers a repeated candidate itself.
      if (auto result = results_.extract(next_)) enter(std::move(result.mapped()));
      ++next_;
      const std::optional<BestMesh>& best = state_.best;
      fewest_.push_back(best ? best->triangles : 0);
      state_.target_reached =
          best && settings_.target_triangles && best->triangles <= *settings_.target_triangles;
      state_.stagnated = settings_.stagnation && next_ - improved_ >= *settings_.stagnation;
    }
  }

  // Also what the log knows and the search has not asked for yet.
  void enter_the_rest() {
    entering_the_rest_ = true;
    if (settings_.log != nullptr) {
      const auto& logged = settings_.log->evaluations();
      for (auto e = logged.lower_bound(next_); e != logged.end(); ++e) {
        if (e->second.stopped && !settings_.log->mesh(e->second)) continue;
        results_.try_emplace(e->first, Result{e->second, {}, {}});
      }
    }
    state_.evaluations = next_;
    for (auto& [index, result] : results_) {
      state_.evaluations += index < kPolishIndex && !result.evaluation.stopped ? 1 : 0;
      enter(std::move(result));
    }
    results_.clear();
  }

  bool beats_the_best(const Result& result) const {
    const bool feasible = result.feasible();
    if (!feasible && state_.best) return false;
    const std::optional<BestMesh>& place = feasible ? state_.best : state_.least_error;
    const LoggedEvaluation& e = result.evaluation;
    return !place || (feasible ? std::pair(e.triangles, e.index) <
                                     std::pair(std::uint64_t{place->triangles}, place->index)
                               : std::pair(e.violation(), e.index) <
                                     std::pair(place->violation, place->index));
  }

  void enter(Result result) {
    const LoggedEvaluation& e = result.evaluation;
    if (e.expected_triangles) ++state_.outpaced;
    if (result.failed()) {
      ++state_.failures[e.failure];
      state_.last_failure = e.message;
      return;
    }
    if (result.feasible()) rank(e);
    if (!beats_the_best(result)) {
      drop(e.index);
      return;
    }
    std::optional<BestMesh>& place = result.feasible() ? state_.best : state_.least_error;
    for (const auto& old : {&state_.best, &state_.least_error}) {
      if (*old) drop((*old)->index);
    }
    if (result.feasible()) {
      const double before = state_.course.empty() ? 0 : state_.course.back().seconds;
      state_.course.push_back({std::max(before, e.seconds), e.triangles});
    }
    place = BestMesh{e.index,
                     e.triangles,
                     e.violation(),
                     e.squared_bits,
                     chain(e),
                     e.reconstruction_triangles,
                     e.unmeshed_points,
                     std::move(result.mesh),
                     std::move(result.error)};
    improved_ = e.index + 1;
  }

  // Keeps the best candidates.
  void rank(const LoggedEvaluation& e) {
    ranking_.insert_or_assign({e.triangles, e.index}, e.genes);
    if (ranking_.size() > polished_candidates(cloud_.size()))
      ranking_.erase(std::prev(ranking_.end()));
  }

  // The folder keeps the mesh of the best alone; one that is the best by a result out of order may
  // have to give way again when the run continues.
  void drop(std::uint64_t index) {
    if (settings_.log != nullptr && !entering_the_rest_) settings_.log->drop_mesh(index);
  }

  // A best mesh that the folder has is there for the observer, too.
  void load_best() {
    if (!state_.best || !state_.best->mesh.triangles.empty() || settings_.log == nullptr) return;
    if (looked_for_ == state_.best->index) return;
    looked_for_ = state_.best->index;
    std::optional<TriangleMesh> mesh = settings_.log->mesh(*settings_.log->find(*looked_for_));
    if (!mesh) return;
    state_.best->mesh = std::move(*mesh);
    check_restored(*state_.best);
  }

  // The mesh of an evaluation that an earlier process made: from the folder, or made again.
  void restore(BestMesh& best) {
    const LoggedEvaluation& known = *settings_.log->find(best.index);
    std::optional<TriangleMesh> mesh = settings_.log->mesh(known);
    best.mesh = mesh ? std::move(*mesh) : make_again(known);
    check_restored(best);
  }

  void check_restored(BestMesh& best) {
    best.error = constraint_.measure(best.mesh.view());
    if (best.mesh.triangles.size() != best.triangles ||
        best.error.kept.squared_bits != best.squared_bits) {
      throw Error(settings_.log->folder().string() + ": the mesh of evaluation " +
                  std::to_string(best.index) +
                  " is lost, and made again it is another; run the search anew");
    }
  }

  TriangleMesh make_again(const LoggedEvaluation& known) {
    start_workers(1, known.index >= kPolishIndex ? kDeepTimeLimit : 1);
    pool_->submit({known.index, chain(known)});
    Completed completed = wait_for_next(*pool_, settings_);
    pool_.reset();
    if (const auto* failure = std::get_if<Failure>(&completed.outcome)) {
      throw Error(settings_.log->folder().string() +
                  ": the mesh of the best evaluation is lost: " + failure->message +
                  "; repeat the command, with more --evaluation-time or "
                  "--evaluation-memory if that is what it lacks");
    }
    return as_stored(std::get<ChainResult>(completed.outcome).mesh,
                     storage_of(mesh_format(settings_.output)));
  }

  std::span<const Point> cloud_;
  ErrorConstraint& constraint_;
  Evaluator* device_;
  const OptimizeSettings& settings_;
  const OptimizeObserver& observe_;
  const Problem problem_;
  const std::optional<std::size_t> walked_;
  const double seconds_ = settings_.seconds_left();
  Genocop genocop_;
  LookAheadScheduler scheduler_;
  std::unique_ptr<EvaluationPool> pool_;
  SearchOptions search_;
  bool stopping_ = false;
  double seconds_before_ = 0;                            // that earlier commands took, by the log
  double surface_seconds_ = 0, decimation_seconds_ = 0;  // the most that an evaluation took
  OptimizeState state_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, Genes> ranking_;  // by triangles and index
  std::map<std::uint64_t, CandidateInWork> in_work_;
  std::map<std::uint64_t, Result> results_;  // not entered yet
  std::uint64_t next_ = 0;                   // to enter
  std::vector<std::uint64_t> fewest_;        // triangles up to each that entered; 0: none feasible
  std::optional<std::uint64_t> looked_for_;  // the last best whose mesh was asked of the folder
  std::uint64_t improved_ = 0;               // behind the evaluation that was the last better one
  bool entering_the_rest_ = false;
};

}  // namespace

OptimizeState optimize(std::span<const Point> cloud, ErrorConstraint& constraint, Evaluator* device,
                       const OptimizeSettings& settings, const OptimizeObserver& observe) {
  // Before anything takes long; a candidate's own vertices are looked at as well.
  require_storable({{cloud.begin(), cloud.end()}, {}}, mesh_format(settings.output),
                   constraint.epsilon(), settings.output);
  return Run(cloud, constraint, device, settings, observe).run();
}

}  // namespace emax
