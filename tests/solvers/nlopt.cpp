#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/solvers/solver_case.hpp"

namespace bowstring::testing {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const char* const algorithms[] = {"slsqp", "mma", "ccsaq"};

struct Keys {
  std::string algorithm = "slsqp";
  double time_limit = 0.0;  // 0: none
  long max_iterations = 0;  // 0: the default
  long max_unknowns = 0;    // 0: the default
};

OwnedSolver make_solver(const Keys& keys) {
  return solver_plugin("nlopt", [&](const SetParameter& value) {
    value("algorithm", ParameterType::choice).text = keys.algorithm;
    if (keys.time_limit > 0.0) value("time-limit", ParameterType::scalar).number = keys.time_limit;
    if (keys.max_iterations > 0) value("max-iterations", ParameterType::integer).integer = keys.max_iterations;
    if (keys.max_unknowns > 0) value("max-unknowns", ParameterType::integer).integer = keys.max_unknowns;
  });
}

Answer solve_problem(Problem& problem, const std::vector<double>& start, const Keys& keys = {},
                     const std::function<bool(const IterationRecord&)>& progress = {}) {
  return solve_with(*make_solver(keys), problem, start, progress);
}

}  // namespace

TEST_CASE("every algorithm finds the rest of a quadratic, and says what it did") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem(stiffness, rest);
    int calls = 0;
    const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm}, [&](const IterationRecord& record) {
      CHECK(record.iteration == calls++);
      return true;
    });
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    const SolverResult& result = answer.result;
    CHECK(result.claim == Claim::optimal);
    CHECK(result.reason == "the first-order conditions hold within the tolerance");
    check_point(result.q, rest, 1e-8);
    CHECK(result.multipliers.empty());
    CHECK(result.evaluations > 1);
    CHECK(static_cast<int>(result.history.size()) == result.iterations + 1);
    CHECK(calls == result.iterations + 1);
    CHECK(result.history.front().energy == doctest::Approx(9.0));
    CHECK(result.history.front().stationarity == doctest::Approx(4.0));
    CHECK(result.history.back().stationarity <= 1e-8);
    CHECK(problem.guards == std::vector<double>{0.5, infinity});
    CHECK(problem.reference == result.q);
  }
}

TEST_CASE("equality rows, both sides of a row, and bounds") {
  // x + y = 2 moves (3, 1) to (2, 0), and z comes to lie on a side of its row, or on its bound.
  struct Variant {
    double lower, upper, bound;
    double z;
  };
  for (const Variant& variant :
       {Variant{-1.0, 4.0, -infinity, -1.0}, Variant{-9.0, -3.0, -infinity, -3.0}, Variant{-9.0, 4.0, -1.5, -1.5}}) {
    for (const char* algorithm : algorithms) {
      CAPTURE(std::string(algorithm));
      CAPTURE(variant.z);
      RowProblem problem(stiffness, rest,
                         {{{1.0, 1.0, 0.0}, 2.0, 2.0}, {{0.0, 0.0, 1.0}, variant.lower, variant.upper}});
      problem.lower_bounds[2] = variant.bound;
      const Answer answer = solve_problem(problem, {0.5, 0.0, -1.0}, {algorithm});
      REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
      const bool exact = algorithm == std::string("slsqp");
      check_point(answer.result.q, {2.0, 0.0, variant.z}, exact ? 1e-8 : 1e-4);
      if (exact) CHECK(answer.result.claim == Claim::optimal);
    }
  }
}

TEST_CASE("inequality rows alone, which MMA and CCSAQ take as they are") {
  // The point of the unit disc that is nearest to (3, 4).
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem({1.0, 1.0}, {3.0, 4.0}, {{{0.0, 0.0}, -infinity, 1.0, 1.0}});
    const Answer answer = solve_problem(problem, {0.1, 0.0}, {algorithm});
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    check_point(answer.result.q, {0.6, 0.8}, 1e-6);
    CHECK(answer.result.history.back().penetration <= 1e-6);
  }
}

TEST_CASE("a refused trial shortens the step, from wherever the algorithm steps") {
  for (const char* algorithm : algorithms) {
    for (const bool rows : {false, true}) {
      CAPTURE(std::string(algorithm));
      CAPTURE(rows);
      std::vector<QuadraticRow> list;
      if (rows) list = {{{1.0, 1.0, 0.0}, 2.0, 2.0}, {{0.0, 0.0, 1.0}, -1.0, infinity}};
      RowProblem problem(stiffness, rest, list);
      int refused = 0;
      problem.answer = [&](const RowProblem& self, const std::vector<double>& q) {
        Status status = within_reach(self, q);
        refused += status.ok() ? 0 : 1;
        return status;
      };
      const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm});
      REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
      CHECK(refused > 0);
      check_point(answer.result.q, rows ? std::vector<double>{2.0, 0.0, -1.0} : rest, rows ? 1e-4 : 1e-6);
      for (const IterationRecord& record : answer.result.history) CHECK(std::isfinite(record.energy));
    }
  }
}

TEST_CASE("rows are bound anew where an epoch is due, and where trials leave a window") {
  for (const char* algorithm : algorithms) {
    for (const bool due : {false, true}) {
      CAPTURE(std::string(algorithm));
      CAPTURE(due);
      RowProblem problem(stiffness, rest);
      if (due) {
        problem.wants_epoch = [](const RowProblem& self) { return self.reference[0] > 1.0 + self.epochs_begun; };
        problem.answer = within_reach;
      } else {
        problem.answer = [](const RowProblem& self, const std::vector<double>& q) {
          return q[0] > 1.0 + self.epochs_begun ? Status{Code::left_window, {}} : Status{};
        };
      }
      const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm});
      REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
      CHECK(problem.epochs_begun >= 2);
      check_point(answer.result.q, rest, 1e-6);
      for (std::size_t k = 0; k < answer.result.history.size(); ++k) {
        CHECK(answer.result.history[k].iteration == static_cast<int>(k));
      }
    }
  }
}

TEST_CASE("no step at all: the solver stalls where it is") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem(stiffness, rest);
    problem.answer = [](const RowProblem& self, const std::vector<double>& q) {
      return q == self.reference ? Status{} : Status{Code::refused, {}};
    };
    const Answer answer = solve_problem(problem, {0.5, 0.25, 0.0}, {algorithm});
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    CHECK(answer.result.claim == Claim::stalled);
    CHECK(answer.result.reason == "every trial step was refused, however short");
    CHECK(answer.result.q == std::vector<double>{0.5, 0.25, 0.0});
  }
}

TEST_CASE("an evaluation that breaks down away from the solution is passed by") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    int broken = 0;
    RowProblem problem(stiffness, rest);
    problem.answer = [&](const RowProblem&, const std::vector<double>& q) {
      if (q[0] < 3.02 && q[1] < 1.02 && q[2] > -2.02) return Status{};
      ++broken;
      return Status::failure(Code::failed, "a law broke");
    };
    const Answer answer = solve_problem(problem, {-2.0, 0.0, 0.0}, {algorithm});
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    CHECK(broken > 0);
    CHECK(answer.result.claim == Claim::optimal);
    check_point(answer.result.q, rest, 1e-6);
  }
}

TEST_CASE("an evaluation that breaks down around the solution is the result's reason") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem(stiffness, rest);
    problem.answer = [](const RowProblem&, const std::vector<double>& q) {
      return q[0] > 2.0 ? Status::failure(Code::failed, "a law broke") : Status{};
    };
    const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm});
    REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
    CHECK(answer.result.claim == Claim::failed);
    CHECK(answer.result.reason == "a law broke");
  }
}

TEST_CASE("an evaluation that ends the solve") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem(stiffness, rest);
    problem.answer = [](const RowProblem&, const std::vector<double>&) {
      return Status::failure(Code::failed, "a law broke");
    };
    const Answer at_start = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm});
    CHECK(at_start.status.code == Code::failed);
    CHECK(at_start.status.text == "the point that it starts from cannot be evaluated: a law broke");
    CHECK(problem.guards.back() == infinity);

    problem.answer = [](const RowProblem&, const std::vector<double>& q) {
      return q[0] > 0.5 ? Status::failure(Code::interrupted, "somebody pulled the plug") : Status{};
    };
    const Answer later = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm});
    CHECK(later.status.code == Code::interrupted);
    CHECK(later.status.text == "somebody pulled the plug");
  }
}

TEST_CASE("an exception from a callback keeps its text") {
  for (const char* algorithm : algorithms) {
    for (const int last : {0, 2}) {
      for (const bool rows : {false, true}) {
        CAPTURE(std::string(algorithm));
        std::vector<QuadraticRow> list;
        if (rows) list = {{{1.0, 1.0, 0.0}, 2.0, 2.0}};
        RowProblem problem(stiffness, rest, list);
        int calls = 0;
        const Answer answer = solve_problem(problem, {0.0, 0.0, 0.0}, {algorithm}, [&](const IterationRecord& record) {
          ++calls;
          if (record.iteration == last) throw std::runtime_error("the progress bar fell off");
          return true;
        });
        CHECK(answer.status.code == Code::failed);
        CHECK(answer.status.text == "the progress bar fell off");
        CHECK(calls == last + 1);
        CHECK(problem.guards.back() == infinity);
      }
    }
  }
}

TEST_CASE("limits and the user's stop") {
  for (const char* algorithm : algorithms) {
    CAPTURE(std::string(algorithm));
    RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 2.0, 2.0}});
    const std::vector<double> start = {0.5, 1.5, 0.0};
    const auto claim = [&](const Keys& keys, const std::function<bool(const IterationRecord&)>& progress = {}) {
      const Answer answer = solve_problem(problem, start, keys, progress);
      REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
      CHECK(answer.result.claim == Claim::stalled);
      CHECK(answer.result.q.size() == start.size());
      return answer.result.reason;
    };
    CHECK(claim({algorithm, 0.0, 1}) == "the iteration limit was reached");
    CHECK(claim({algorithm, 1e-9}) == "the time limit was reached");
    CHECK(claim({algorithm}, [](const IterationRecord&) { return false; }) == "stopped by the user");
  }
}

TEST_CASE("the best feasible point is the answer where the solver is stopped") {
  // SLSQP leaves the feasible start of this row for lower energies outside.
  RowProblem problem({1.0, 1.0}, {3.0, 4.0}, {{{0.0, 0.0}, -infinity, 1.0, 1.0}});
  const std::vector<double> start = {0.1, 0.0};
  std::vector<IterationRecord> seen;
  const Answer answer = solve_problem(problem, start, {}, [&](const IterationRecord& record) {
    seen.push_back(record);
    return record.iteration < 1;
  });
  REQUIRE_MESSAGE(answer.status.ok(), answer.status.text);
  REQUIRE(seen.back().penetration > 0.1);
  CHECK(seen.back().energy < seen.front().energy);
  CHECK(answer.result.q == start);
}

TEST_CASE("two solves at the same time do not disturb each other") {
  const auto solve_with = [](const char* algorithm, Answer& out) {
    RowProblem problem(stiffness, rest, {{{1.0, 1.0, 0.0}, 2.0, 2.0}, {{0.0, 0.0, 1.0}, -1.0, infinity}});
    SolverContext context;
    const OwnedSolver solver = make_solver({algorithm});
    const std::vector<double> start(3, 0.0);
    for (int k = 0; k < 20; ++k) {
      out.result = {};
      out.status = solver->solve(problem, start, context, out.result);
    }
  };
  Answer alone, one, other;
  solve_with("slsqp", alone);
  solve_with("ccsaq", other);
  const std::vector<double> other_alone = other.result.q;
  std::thread first([&] { solve_with("slsqp", one); });
  solve_with("ccsaq", other);
  first.join();
  REQUIRE(largest(alone.result.q) > 0.5);
  CHECK(one.result.q == alone.result.q);
  CHECK(other.result.q == other_alone);
}

TEST_CASE("what it does not take") {
  ProblemSummary summary;
  summary.unknowns = 301;
  CHECK(make_solver({})->can(summary).text ==
        "it has 301 free unknowns, more than max-unknowns = 300, and the dense matrices of this solver cost the cube "
        "of that number in each iteration; take another solver, such as 'ipopt', a larger max-unknowns, fewer nodes, "
        "or kinematics with fewer unknowns, such as 'nodes'");
  CHECK(make_solver({})->can(summary).code == Code::unsupported);
  CHECK(make_solver({"slsqp", 0.0, 0, 301})->can(summary).ok());
  summary.unknowns = 300;
  CHECK(make_solver({})->can(summary).ok());
  summary.equalities = 302;
  CHECK(make_solver({})->can(summary).text ==
        "NLopt takes no problem with more equality rows (302) than unknowns (300)");
}

namespace {

std::string with_nlopt(const SmallScene& scene, const std::string& keys) {
  std::string text = contact_text(scene, keys);
  const std::string ipopt = "type = \"ipopt\"";
  text.replace(text.find(ipopt), ipopt.size(), "type = \"nlopt\"");
  return text;
}

}  // namespace

TEST_CASE("a scene with too many unknowns is refused when it is composed") {
  const std::string refusal = refusal_of(with_nlopt(SmallScene{}, "max-unknowns = 20"));
  CAPTURE(refusal);
  CHECK(
      contains(refusal, "solver 'nlopt' refuses this problem: it has 43 free unknowns, more than max-unknowns = 20, "));
  CHECK(contains(refusal, "edge closure of 'vessel'"));
}

TEST_CASE("SLSQP agrees with Ipopt on scenes with contact, and the kernel certifies it") {
  struct Variant {
    int dimension;
    const char* vessel;
    const char* wire;
  };
  for (const Variant& variant : {Variant{2, "edge-frames", "edge-frames"}, Variant{2, "nodes", "nodes"},
                                 Variant{3, "nodes", "nodes"}, Variant{3, "edge-frames", "nodes"}}) {
    CAPTURE(variant.dimension);
    CAPTURE(std::string(variant.vessel));
    SmallScene scene = contact_scene(variant.dimension, variant.vessel, variant.wire);
    scene.wire_nodes = 12;
    scene.geometry.replace(scene.geometry.find("nodes = 20"), 10, "nodes = 12");
    const SolvedScene ipopt = solved(session_of_text(contact_text(scene)));
    const SolvedScene nlopt = solved(session_of_text(with_nlopt(scene, "")));
    CAPTURE(nlopt.solution.certificate.reason);
    CHECK(ipopt.solution.certificate.verdict == Verdict::converged);
    CHECK(nlopt.solution.certificate.verdict == Verdict::converged);
    CHECK(nlopt.solution.solver.claim == Claim::optimal);
    CHECK(nlopt.solution.warnings == ipopt.solution.warnings);
    CHECK(nlopt.solution.estimated_multipliers);
    REQUIRE(largest(ipopt.solution.multipliers) > 0.1);
    CHECK(largest_difference(nlopt.solution.multipliers, ipopt.solution.multipliers) <= 1e-5);
    const auto energy = [](const SolvedScene& solved) { return solved.solution.solver.history.back().energy; };
    REQUIRE(energy(ipopt) != 0.0);
    CHECK(std::fabs(energy(nlopt) / energy(ipopt) - 1.0) <= 1e-8);
  }
}

TEST_CASE("a wire that has to lie in two rigid vessels at once ends with violated rows, and no word of success") {
  // A line and a sinusoid that are up to 9 mm apart, where the wire has 2.6 mm in each.
  SmallScene small = contact_scene(2);
  small.radius = "\"3 mm\"\nrigid = true";
  std::string text = with_nlopt(small, "");
  text.insert(text.find("[[wire]]"),
              "[[vessel]]\nname = \"straight\"\ngeometry = { type = \"line\", length = \"60 mm\", nodes = 20 }\n"
              "radius = \"3 mm\"\nrigid = true\n");
  text.insert(text.find("[solver]"),
              "[[constraint]]\nname = \"second\"\ntype = \"node-wise-contact\"\n"
              "on = [\"wire\", \"straight\"]\nwindow = 20\n");
  const SolvedScene found = solved(session_of_text(text));
  CAPTURE(found.solution.certificate.reason);
  CAPTURE(found.solution.solver.iterations);
  CHECK(found.solution.solver.claim != Claim::optimal);
  CHECK(found.solution.certificate.penetration > 1.0);
  CHECK(contains(found.solution.certificate.reason, "row penetration "));
  CHECK(found.solution.certificate.verdict == Verdict::stalled);
}

TEST_CASE("MMA and CCSAQ inside an augmented Lagrangian come near, and say that they stall") {
  const SmallScene scene = contact_scene(2, "nodes", "nodes");
  const SolvedScene reference = solved(session_of_text(with_nlopt(scene, "")));
  REQUIRE(reference.solution.certificate.verdict == Verdict::converged);
  for (const char* algorithm : {"mma", "ccsaq"}) {
    CAPTURE(std::string(algorithm));
    const SolvedScene found =
        solved(session_of_text(with_nlopt(scene, std::string("algorithm = \"") + algorithm + "\"")));
    CAPTURE(found.solution.certificate.reason);
    CHECK(found.solution.certificate.verdict == Verdict::stalled);
    CHECK(contains(found.solution.certificate.reason, "NLopt ended short of the tolerance (FTOL_REACHED); "));
    CHECK(found.solution.certificate.stationarity <= 1e-3);
    CHECK(found.solution.certificate.penetration <= 1e-6);
    REQUIRE(largest(reference.solution.q) > 1.0);
    CHECK(largest_difference(found.solution.q, reference.solution.q) <= 1e-2);
  }
}

}  // namespace bowstring::testing
