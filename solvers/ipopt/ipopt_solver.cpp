#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include <IpCompoundVector.hpp>
#include <IpIpoptApplication.hpp>
#include <IpIpoptCalculatedQuantities.hpp>
#include <IpIpoptData.hpp>
#include <IpOrigIpoptNLP.hpp>
#include <IpTNLP.hpp>
#include <IpTNLPAdapter.hpp>
#include <IpTimingStatistics.hpp>

#include "core/interfaces/solver.hpp"
#include "plugins/sdk/plugin.hpp"
#include "solvers/shared/backend.hpp"

namespace bowstring {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double unbounded = 2e19;  // what Ipopt takes for infinity
constexpr double first_barrier = 0.1;
constexpr double least_warm_barrier = 1e-6;  // of a start with multipliers
constexpr double far_barrier = 1e-2;         // of one whose forces are out of balance by as much as rows press

constexpr ParameterDeclaration schema[] = {
    backend::tolerance_key,
    backend::max_iterations_key("500", "over all epochs"),
    backend::time_limit_key,
    {.key = "hessian",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"exact\"",
     .description = "second derivatives: exact, or a limited-memory quasi-Newton approximation",
     .choices = "exact|limited-memory"},
    {.key = "ordering",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"automatic\"",
     .description = "the order that MUMPS eliminates in; \"pord\" is up to three times faster for a sliding wire with "
                    "kinematics nodes on fine meshes, and slower for frames",
     .choices = "automatic|amd|amf|pord|metis|qamd"},
    backend::step_guard_key,
};

struct Settings {
  double tolerance = 1e-8;
  int max_iterations = 500;
  double time_limit = std::numeric_limits<double>::infinity();
  bool exact_hessian = true;
  int ordering = 7;  // MUMPS' ICNTL(7)
  double guard = 0.5;
};

int ordering_of(const std::string& name) {
  const std::pair<const char*, int> orderings[] = {{"amd", 0}, {"amf", 2}, {"pord", 4}, {"metis", 5}, {"qamd", 6}};
  for (const auto& [known, number] : orderings) {
    if (name == known) return number;
  }
  return 7;
}

/// MUMPS keeps static state: one Ipopt at a time in a process, from its construction until its destructors have run.
std::mutex& ipopt_lock() {
  static std::mutex lock;
  return lock;
}

/// Holds that lock. A progress function that starts another run would wait for itself; it is refused instead.
class IpoptTurn {
 public:
  IpoptTurn() {
    if (taken()) {
      throw StatusError(Code::unsupported,
                        "a progress function of Ipopt has started another solve by Ipopt, which "
                        "solves one problem at a time; solve after it has returned");
    }
    ipopt_lock().lock();
    taken() = true;
  }
  ~IpoptTurn() {
    taken() = false;
    ipopt_lock().unlock();
  }
  IpoptTurn(const IpoptTurn&) = delete;
  IpoptTurn& operator=(const IpoptTurn&) = delete;

 private:
  /// By this thread.
  static bool& taken() {
    static thread_local bool value = false;
    return value;
  }
};

/// Why the intermediate callback ended a run.
enum class Stop { none, epoch, iterations, time, user };

struct Multipliers {
  std::vector<double> rows, lower, upper;
};

/// One chart of one epoch as Ipopt sees it.
class ChartProgram final : public Ipopt::TNLP {
 public:
  ChartProgram(Problem& problem, EuclideanProblem& chart, const Settings& settings, const SolverContext& context,
               SolverResult& result, Clock::time_point begin)
      : problem_(problem),
        chart_(chart),
        settings_(settings),
        context_(context),
        result_(result),
        begin_(begin),
        x(static_cast<std::size_t>(problem.unknowns())),
        q_(static_cast<std::size_t>(problem.coordinates())),
        rows_(static_cast<std::size_t>(problem.rows())) {
    chart.start(x);
  }

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& jacobian, Ipopt::Index& hessian,
                    IndexStyleEnum& style) override {
    n = problem_.unknowns();
    m = problem_.rows();
    jacobian = problem_.jacobian_pattern().entries();
    hessian = problem_.hessian_pattern().entries();
    style = TNLP::C_STYLE;
    return true;
  }

  bool get_bounds_info(Ipopt::Index n, Ipopt::Number* lower, Ipopt::Number* upper, Ipopt::Index m,
                       Ipopt::Number* row_lower, Ipopt::Number* row_upper) override {
    const auto clip = [](double bound) { return std::clamp(bound, -unbounded, unbounded); };
    std::transform(problem_.lower().begin(), problem_.lower().begin() + n, lower, clip);
    std::transform(problem_.upper().begin(), problem_.upper().begin() + n, upper, clip);
    std::transform(problem_.row_lower().begin(), problem_.row_lower().begin() + m, row_lower, clip);
    std::transform(problem_.row_upper().begin(), problem_.row_upper().begin() + m, row_upper, clip);
    return true;
  }

  bool get_starting_point(Ipopt::Index n, bool, Ipopt::Number* start, bool init_z, Ipopt::Number* z_lower,
                          Ipopt::Number* z_upper, Ipopt::Index m, bool init_lambda, Ipopt::Number* lambda) override {
    std::copy_n(x.begin(), n, start);
    if (init_z) {
      std::copy_n(multipliers.lower.begin(), n, z_lower);
      std::copy_n(multipliers.upper.begin(), n, z_upper);
    }
    if (init_lambda) std::copy_n(multipliers.rows.begin(), m, lambda);
    return true;
  }

  bool eval_f(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number& energy) override {
    ProblemEvaluation evaluation;
    evaluation.energy = &energy;
    return evaluate(n, at, evaluation);
  }

  bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number* gradient) override {
    ProblemEvaluation evaluation;
    evaluation.gradient = {gradient, static_cast<std::size_t>(n)};
    return evaluate(n, at, evaluation);
  }

  bool eval_g(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Index m, Ipopt::Number* rows) override {
    ProblemEvaluation evaluation;
    evaluation.rows = {rows, static_cast<std::size_t>(m)};
    return evaluate(n, at, evaluation);
  }

  bool eval_jac_g(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Index m, Ipopt::Index entries,
                  Ipopt::Index* row, Ipopt::Index* column, Ipopt::Number* values) override {
    if (values == nullptr) {
      const SparsityPattern pattern = problem_.jacobian_pattern();
      for (int r = 0; r < m; ++r) {
        for (int k = pattern.begin[static_cast<std::size_t>(r)]; k < pattern.begin[static_cast<std::size_t>(r) + 1];
             ++k) {
          row[k] = r;
          column[k] = pattern.inner[static_cast<std::size_t>(k)];
        }
      }
      return true;
    }
    ProblemEvaluation evaluation;
    evaluation.jacobian = {values, static_cast<std::size_t>(entries)};
    return evaluate(n, at, evaluation);
  }

  bool eval_h(Ipopt::Index n, const Ipopt::Number* at, bool, Ipopt::Number factor, Ipopt::Index m,
              const Ipopt::Number* lambda, bool, Ipopt::Index entries, Ipopt::Index* row, Ipopt::Index* column,
              Ipopt::Number* values) override {
    if (values == nullptr) {
      const SparsityPattern pattern = problem_.hessian_pattern();
      for (int c = 0; c < n; ++c) {
        for (int k = pattern.begin[static_cast<std::size_t>(c)]; k < pattern.begin[static_cast<std::size_t>(c) + 1];
             ++k) {
          row[k] = pattern.inner[static_cast<std::size_t>(k)];
          column[k] = c;
        }
      }
      return true;
    }
    const auto start = Clock::now();
    const Status status =
        chart_.lagrangian_hessian({at, static_cast<std::size_t>(n)}, factor, {lambda, static_cast<std::size_t>(m)},
                                  {values, static_cast<std::size_t>(entries)});
    result_.evaluation_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    return note(status);
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Ipopt::Index, Ipopt::Number energy, Ipopt::Number inf_pr,
                             Ipopt::Number inf_du, Ipopt::Number mu, Ipopt::Number, Ipopt::Number, Ipopt::Number,
                             Ipopt::Number alpha_pr, Ipopt::Index, const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override {
    barrier = mu;
    // The first callback of a restart repeats the iterate that the run before ended with.
    if (!first_callback_ || result_.history.empty()) {
      const int iteration = result_.history.empty() ? 0 : result_.history.back().iteration + 1;
      result_.history.push_back({iteration, energy, inf_du, inf_pr, alpha_pr});
      result_.iterations = iteration;
      if (context_.on_iteration && !context_.on_iteration(result_.history.back())) stop = Stop::user;
    }
    first_callback_ = false;
    if (read_iterate(*data, *quantities)) {
      chart_.state(x, q_);
      note(problem_.accept(q_));
      // A restoration ends with an iterate of the problem itself; until then there is none to restart from.
      const bool restartable = mode == Ipopt::RegularMode;
      if (restartable && (problem_.epoch_due() || chart_.recentre_due(x))) stop = Stop::epoch;
    }
    if (result_.iterations >= settings_.max_iterations) stop = Stop::iterations;
    if (std::chrono::duration<double>(Clock::now() - begin_).count() > settings_.time_limit) stop = Stop::time;
    return stop == Stop::none;
  }

  void finalize_solution(Ipopt::SolverReturn, Ipopt::Index n, const Ipopt::Number* at, const Ipopt::Number* z_lower,
                         const Ipopt::Number* z_upper, Ipopt::Index m, const Ipopt::Number*,
                         const Ipopt::Number* lambda, Ipopt::Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    x.assign(at, at + n);
    multipliers.rows.assign(lambda, lambda + m);
    multipliers.lower.assign(z_lower, z_lower + n);
    multipliers.upper.assign(z_upper, z_upper + n);
  }

 private:
  bool evaluate(Ipopt::Index n, const Ipopt::Number* at, const ProblemEvaluation& evaluation) {
    const auto start = Clock::now();
    const Status status = chart_.evaluate({at, static_cast<std::size_t>(n)}, evaluation);
    result_.evaluation_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    ++result_.evaluations;
    return note(status);
  }

  bool note(const Status& status) {
    if (status.code == Code::failed && failure.ok()) failure = status;
    return status.ok();
  }

  /// The iterate as the user's problem numbers it. Inside Ipopt's restoration problem it is the first part of that
  /// problem's variables, in the order of the problem around it.
  bool read_iterate(const Ipopt::IpoptData& data, Ipopt::IpoptCalculatedQuantities& quantities) {
    const Ipopt::Vector* iterate = Ipopt::GetRawPtr(data.curr()->x());
    if (auto* nlp = dynamic_cast<Ipopt::OrigIpoptNLP*>(Ipopt::GetRawPtr(quantities.GetIpoptNLP()))) {
      adapter_ = dynamic_cast<Ipopt::TNLPAdapter*>(Ipopt::GetRawPtr(nlp->nlp()));
    } else if (const auto* parts = dynamic_cast<const Ipopt::CompoundVector*>(iterate)) {
      iterate = Ipopt::GetRawPtr(parts->GetComp(0));
    } else {
      return false;
    }
    if (adapter_ == nullptr) return false;
    adapter_->ResortX(*iterate, x.data());
    return true;
  }

  Problem& problem_;
  EuclideanProblem& chart_;
  const Settings& settings_;
  const SolverContext& context_;
  SolverResult& result_;
  Clock::time_point begin_;
  bool first_callback_ = true;
  Ipopt::TNLPAdapter* adapter_ = nullptr;  // Ipopt's own, alive as long as its run

 public:
  std::vector<double> x;
  Multipliers multipliers;
  double barrier = first_barrier;
  Stop stop = Stop::none;
  Status failure;

 private:
  std::vector<double> q_, rows_;
};

void set_options(Ipopt::OptionsList& options, const Settings& settings, bool warm, double barrier) {
  options.SetStringValue("linear_solver", "mumps");
  options.SetIntegerValue("mumps_pivot_order", settings.ordering);
  options.SetStringValue("sb", "yes");
  options.SetIntegerValue("print_level", 0);
  options.SetIntegerValue("max_iter", settings.max_iterations + 1);
  options.SetNumericValue("tol", settings.tolerance);
  options.SetNumericValue("dual_inf_tol", settings.tolerance);
  options.SetNumericValue("constr_viol_tol", settings.tolerance);
  options.SetNumericValue("compl_inf_tol", settings.tolerance);
  options.SetNumericValue("bound_relax_factor", 0.0);  // rows would be missed by that much otherwise
  options.SetStringValue("nlp_scaling_method", "none");
  options.SetStringValue("hessian_approximation", settings.exact_hessian ? "exact" : "limited-memory");
  options.SetNumericValue("mu_init", barrier);
#if IPOPT_VERSION_MAJOR > 3 || IPOPT_VERSION_MINOR > 13  // earlier ones always measure
  options.SetStringValue("timing_statistics", "yes");
#endif
  if (warm) {
    options.SetStringValue("warm_start_init_point", "yes");
    for (const char* push : {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
                             "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      options.SetNumericValue(push, 1e-9);
    }
  }
}

/// Seconds of one run in the KKT system: its assembly, MUMPS' analyses, factorizations and solves. (Ipopt does not
/// time MUMPS' factorization by itself.)
double linear_solver_seconds(Ipopt::IpoptApplication& application) {
  return application.IpoptDataObject()->TimingStats().StdAugSystemSolverMultiSolve().TotalWallclockTime();
}

struct Verdict {
  Claim claim;
  std::string reason;
};

Verdict verdict(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return {Claim::optimal, "Ipopt reached its tolerance"};
    case Ipopt::Solved_To_Acceptable_Level:
      return {Claim::optimal, "Ipopt made no more progress near a solution"};
    case Ipopt::Infeasible_Problem_Detected:
      return {Claim::infeasible, "Ipopt converged to a point of local infeasibility"};
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return {Claim::stalled, "Ipopt's search direction became too small"};
    case Ipopt::Diverging_Iterates:
      return {Claim::diverged, "Ipopt's iterates grow without bound"};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {Claim::stalled, "the iteration limit was reached"};
    case Ipopt::Restoration_Failed:
      return {Claim::stalled, "Ipopt's restoration phase failed"};
    case Ipopt::Error_In_Step_Computation:
      return {Claim::stalled, "Ipopt could not compute a step"};
    case Ipopt::Invalid_Number_Detected:
      return {
          Claim::failed,
          "an evaluation gave no finite number, or at the start a row found no point of the wall within its window: "
          "give the constraint a larger 'window', or look at the start"};
    default:
      return {Claim::failed, "Ipopt ended with return code " + std::to_string(static_cast<int>(status))};
  }
}

class IpoptSolver final : public Solver {
 public:
  explicit IpoptSolver(const ParameterSet& parameters) {
    settings_.tolerance = parameters.scalar("tolerance");
    settings_.max_iterations = static_cast<int>(parameters.integer("max-iterations"));
    settings_.time_limit = backend::time_limit(parameters);
    settings_.exact_hessian = parameters.text("hessian") == "exact";
    settings_.ordering = ordering_of(parameters.text("ordering"));
    settings_.guard = backend::step_guard(parameters);
  }

  SolverTraits traits() const noexcept override { return backend::traits(); }

  Status can(const ProblemSummary& summary) const noexcept override {
    return guard([&] { backend::check_equalities("Ipopt", summary); });
  }

  Status solve(Problem& problem, Span<const double> start, const SolverContext& context,
               SolverResult& out) noexcept override {
    return guard([&] { run(problem, start, context, out); });
  }

 private:
  void run(Problem& problem, Span<const double> start, const SolverContext& context, SolverResult& out) const {
    const IpoptTurn turn;
    const auto begin = Clock::now();
    out.q.assign(start.begin(), start.end());
    const backend::Guarded guarded(problem, settings_.guard);
    Multipliers multipliers;
    double barrier = fitting_barrier(problem, start, context.multipliers);
    bool warm = barrier > 0.0;
    if (!warm) {
      barrier = first_barrier;
    } else {
      multipliers.rows.assign(context.multipliers.begin(), context.multipliers.end());
      multipliers.lower.assign(static_cast<std::size_t>(problem.unknowns()), 0.0);
      multipliers.upper = multipliers.lower;
    }
    for (;; warm = true) {
      const std::unique_ptr<EuclideanProblem> chart = problem.chart(out.q);
      Ipopt::SmartPtr<ChartProgram> program = new ChartProgram(problem, *chart, settings_, context, out, begin);
      program->multipliers = multipliers;
      Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
      application->RethrowNonIpoptException(true);
      set_options(*application->Options(), settings_, warm, barrier);
      if (application->Initialize("") != Ipopt::Solve_Succeeded) {
        throw StatusError(Code::failed, "Ipopt could not be initialised");
      }
      const Ipopt::ApplicationReturnStatus status = application->OptimizeTNLP(Ipopt::GetRawPtr(program));
      out.factorization_seconds += linear_solver_seconds(*application);
      chart->state(program->x, out.q);
      multipliers = program->multipliers;
      out.multipliers = multipliers.rows;
      barrier = program->barrier;
      if (program->stop == Stop::epoch) {
        if (Status epoch = problem.new_epoch(); !epoch.ok()) throw StatusError(epoch.code, epoch.text);
        continue;
      }
      conclude(*program, status, out);
      return;
    }
  }

  /// The barrier parameter that suits a start with multipliers: on Ipopt's central path it is the mean of multiplier
  /// times distance from the bound; where a parameter has changed since, forces are out of balance, and the more so
  /// compared with the multipliers, the larger a parameter the way to the new solution takes the fewest iterations with
  /// (fourth power: measured on the planar and the real iliac). 0 where no barrier belongs to the multipliers.
  static double fitting_barrier(Problem& problem, Span<const double> start, Span<const double> multipliers) {
    const auto rows = static_cast<std::size_t>(problem.rows());
    if (rows == 0 || multipliers.size() != rows) return 0.0;
    const SparsityPattern pattern = problem.jacobian_pattern();
    std::vector<double> residual(rows), jacobian(pattern.inner.size()),
        gradient(static_cast<std::size_t>(problem.unknowns()));
    ProblemEvaluation evaluation;
    evaluation.rows = residual;
    evaluation.jacobian = jacobian;
    evaluation.gradient = gradient;
    if (!problem.evaluate(start, evaluation).ok()) return 0.0;
    double complementarity = 0.0, largest = 0.0, imbalance = 0.0;
    int inequalities = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      for (auto k = static_cast<std::size_t>(pattern.begin[r]); k < static_cast<std::size_t>(pattern.begin[r + 1]);
           ++k) {
        gradient[static_cast<std::size_t>(pattern.inner[k])] += multipliers[r] * jacobian[k];
      }
      const double lower = problem.row_lower()[r], upper = problem.row_upper()[r];
      if (lower == upper) continue;
      const double distance = std::fmin(std::fabs(residual[r] - lower), std::fabs(upper - residual[r]));
      complementarity += std::fabs(multipliers[r]) * distance;
      largest = std::fmax(largest, std::fabs(multipliers[r]));
      ++inequalities;
    }
    if (inequalities == 0) return least_warm_barrier;
    if (largest == 0.0) return 0.0;
    for (std::size_t u = 0; u < gradient.size(); ++u) {
      imbalance = std::fmax(imbalance, std::fabs(gradient[u]) / problem.stationarity_scale()[u]);
    }
    const double share = std::fmin(imbalance / largest, 1.0);
    const double barrier = std::fmax(complementarity / inequalities, far_barrier * share * share * share * share);
    return std::clamp(barrier, least_warm_barrier, first_barrier);
  }

  static void conclude(const ChartProgram& program, Ipopt::ApplicationReturnStatus status, SolverResult& out) {
    Verdict verdict = bowstring::verdict(status);
    if (program.stop == Stop::iterations) verdict = {Claim::stalled, "the iteration limit was reached"};
    if (program.stop == Stop::time) verdict = {Claim::stalled, "the time limit was reached"};
    if (program.stop == Stop::user) verdict = {Claim::stalled, "stopped by the user"};
    if (verdict.claim != Claim::optimal && !program.failure.ok()) verdict = {Claim::failed, program.failure.text};
    out.claim = verdict.claim;
    out.reason = verdict.reason;
  }

  Settings settings_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Solver, bowstring::IpoptSolver>(
    bowstring::Kind::solver, "ipopt", "Ipopt's filter line-search interior-point method with MUMPS, on a chart",
    bowstring::schema))
