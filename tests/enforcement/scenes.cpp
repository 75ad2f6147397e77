#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/enforcement/enforcement_case.hpp"

namespace bowstring::testing {

namespace {

struct Scene {
  std::string name, file;
  std::vector<Override> overrides;
};

/// The planar iliac, a path in space, and the real artery where its data are.
std::vector<Scene> scenes() {
  std::vector<Scene> out = {{"planar", "planar-iliac-smooth.toml", {}},
                            {"tortuous", "tortuous-iliac.toml", {{"vessel.iliac.geometry.nodes", "100"}}}};
  const char* folder = std::getenv("BOWSTRING_DATA");
  const std::string path = folder == nullptr ? "" : std::string(folder) + "/vmr_0110/left_smoothed_200.csv";
  if (folder == nullptr || !std::filesystem::exists(path)) return out;
  out.push_back({"artery",
                 "tortuous-iliac.toml",
                 {{"vessel.iliac.geometry", "{ type = \"csv\", file = \"" + path + "\" }"},
                  {"vessel.iliac.radius", R"({ column = "radius_mm" })"},
                  {"wire.lunderquist.ends",
                   "[{ type = \"clamped\", tangent = [-0.492142416654365, 0.386515454003037, "
                   "0.78000105483674] }, \"pinned\"]"}}});
  return out;
}

SolvedScene solved_by(const Scene& scene, const std::string& solver, std::vector<Override> more = {}) {
  std::vector<Override> overrides = scene.overrides;
  overrides.push_back({"solver.type", solver});
  overrides.insert(overrides.end(), more.begin(), more.end());
  return solved(session_of_file(scene.file, overrides));
}

double energy_of(const SolvedScene& scene) {
  double energy = 0.0;
  ProblemEvaluation wanted;
  wanted.energy = &energy;
  REQUIRE(scene.assembly().evaluate(scene.solution.q, wanted).ok());
  return energy;
}

std::vector<double> contact_forces(const SolvedScene& scene) {
  const RowOrigin rows = contact_rows(scene.assembly());
  const auto first = scene.solution.multipliers.begin() + rows.first;
  return {first, first + rows.count};
}

/// Slope of log y over log x by least squares.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0.0, mean_y = 0.0, above = 0.0, below = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    REQUIRE(y[i] > 0.0);
    mean_x += std::log(x[i]) / static_cast<double>(x.size());
    mean_y += std::log(y[i]) / static_cast<double>(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    above += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
    below += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
  }
  return above / below;
}

}  // namespace

TEST_CASE("a penalty's errors fall as 1/weight over four decades, in both forms") {
  const std::vector<double> weights = {1e2, 1e3, 1e4, 1e5, 1e6};
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const SolvedScene exact = solved_by(scene, "active-set");
    REQUIRE(exact.solution.certificate.verdict == Verdict::converged);
    const double energy = energy_of(exact);
    REQUIRE(largest(contact_forces(exact)) > 0.1);
    for (const char* form : {"quadratic", "log-quadratic"}) {
      CAPTURE(std::string(form));
      std::vector<double> penetration, gap, forces;
      for (const double weight : weights) {
        const SolvedScene found = solved_by(scene, "interior-point",
                                            {{"enforcement.type", "penalty"},
                                             {"enforcement.form", form},
                                             {"enforcement.weight", std::to_string(weight)}});
        const SolverResult& result = found.solution.solver;
        CHECK_MESSAGE(result.claim == Claim::optimal, result.reason);
        CHECK(found.solution.certificate.verdict == Verdict::stalled);
        penetration.push_back(found.solution.certificate.penetration);
        CHECK(result.enforcement.penetration.value() == doctest::Approx(penetration.back()));
        gap.push_back(energy - energy_of(found));
        // The estimate leaves out what is of second order, and is a lower bound.
        CHECK(result.enforcement.energy.value() <= gap.back() + 1e-7);
        CHECK(result.enforcement.energy.value() >= (1.0 - 20.0 / weight) * gap.back() - 1e-7);
        forces.push_back(largest_difference(contact_forces(found), contact_forces(exact)));
      }
      const double of_penetration = exponent(weights, penetration), of_energy = exponent(weights, gap);
      MESSAGE(scene.name << ", " << std::string(form) << ": penetration falls as weight^" << of_penetration
                         << ", energy as weight^" << of_energy << ", forces as weight^" << exponent(weights, forces));
      CHECK(std::fabs(of_penetration + 1.0) <= 0.05);
      CHECK(std::fabs(of_energy + 1.0) <= 0.05);
      CHECK(forces.back() < 1e-2 * forces.front());
    }
  }
}

TEST_CASE("an augmented Lagrangian has the energies and multipliers of exact rows") {
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const SolvedScene exact = solved_by(scene, "active-set", {{"solver.tolerance", "1e-10"}});
    for (const char* solver : {"interior-point", "active-set", "trust-region"}) {
      CAPTURE(std::string(solver));
      const SolvedScene found = solved_by(scene, solver, {{"enforcement.type", "augmented-lagrangian"}});
      const Solution& solution = found.solution;
      CHECK_MESSAGE(solution.solver.claim == Claim::optimal, solution.solver.reason);
      CHECK_MESSAGE(solution.certificate.verdict == Verdict::converged, solution.certificate.reason);
      CHECK(solution.certificate.second_order.curvature == Curvature::minimum);
      CHECK_FALSE(solution.estimated_multipliers);
      CHECK(solution.certificate.penetration <= 1e-8);
      CHECK(solution.certificate.complementarity <= 1e-8);
      CHECK(solution.certificate.stationarity <= 1e-8);
      const double off = relative_difference(contact_forces(found), contact_forces(exact));
      const double energy_off = std::fabs(energy_of(found) / energy_of(exact) - 1.0);
      MESSAGE(scene.name << ", " << std::string(solver) << ": multipliers to " << off << ", energy to " << energy_off
                         << ", " << solution.solver.enforcement.outer_iterations << " solves, "
                         << solution.solver.iterations << " iterations");
      CHECK(off <= 1e-6);
      CHECK(energy_off <= 1e-8);
    }
  }
}

TEST_CASE("the verdict of a penalty names the bias, its amount and both ways out; thresholds above it are one") {
  const Scene scene = scenes().front();
  const std::vector<Override> penalty = {{"enforcement.type", "penalty"}, {"enforcement.weight", "100 N/mm"}};
  const SolvedScene found = solved_by(scene, "trust-region", penalty);
  const Certificate& certificate = found.solution.certificate;
  CHECK(certificate.verdict == Verdict::stalled);
  const std::string& reason = certificate.reason;
  CHECK_MESSAGE(contains(reason, "; the penalty's weight 100 N/mm leaves a bias: rows are violated by up to 0.004"),
                reason);
  CHECK_MESSAGE(contains(reason, "complementarity is up to 0.002"), reason);
  CHECK_MESSAGE(contains(reason, "exact rows would add about 0.049"), reason);
  CHECK_MESSAGE(contains(reason, "take a larger weight (the bias falls as 1/weight)"), reason);
  CHECK_MESSAGE(contains(reason, "or accept it by setting 'penetration' and 'complementarity' of [certificate]"),
                reason);
  std::vector<Override> accepted = penalty;
  accepted.push_back({"certificate.penetration", "0.01 mm"});
  accepted.push_back({"certificate.complementarity", "\"0.01 N mm\""});
  const SolvedScene content = solved_by(scene, "trust-region", accepted);
  CHECK_MESSAGE(content.solution.certificate.verdict == Verdict::converged, content.solution.certificate.reason);
}

TEST_CASE("what is measured is what another solve with exact rows finds") {
  const Scene scene = scenes().front();
  const SolvedScene exact = solved_by(scene, "active-set");
  const SolvedScene found = solved_by(
      scene, "active-set",
      {{"enforcement.type", "penalty"}, {"enforcement.weight", "100 N/mm"}, {"enforcement.bias", "measured"}});
  const EnforcementReport& report = found.solution.solver.enforcement;
  REQUIRE(report.measured_energy.has_value());
  REQUIRE(report.measured_motion.has_value());
  CHECK(std::fabs(*report.measured_energy - (energy_of(exact) - energy_of(found))) <= 1e-8);
  CHECK(std::fabs(*report.measured_motion - exact.assembly().largest_motion(found.solution.q, exact.solution.q)) <=
        1e-6);
  CHECK(*report.measured_motion > 1e-3);
  CHECK(found.solution.certificate.penetration > 1e-3);
}

TEST_CASE("other kinematics, other rows, other constraints: an augmented Lagrangian ends where exact rows do") {
  struct Variant {
    const char* kinematics;
    const char* type;
    int dimension;
    std::string enforcement;
  };
  for (const Variant& variant : {Variant{"nodes", "node-wise-contact", 2, ""},
                                 {"nodes", "node-wise-contact", 3, ""},
                                 {"edge-frames", "segment-wise-contact", 2, ""},
                                 {"edge-frames", "segment-wise-contact", 3, ""},
                                 {"edge-frames", "concentric", 3, "on = \"lumen\"\n"},
                                 {"nodes", "concentric", 2, "on = \"lumen\"\n"}}) {
    CAPTURE(std::string(variant.kinematics));
    CAPTURE(std::string(variant.type));
    CAPTURE(variant.dimension);
    SmallScene scene = contact_scene(variant.dimension, variant.kinematics, variant.kinematics);
    scene.contact_type = variant.type;
    scene.vessel_frames = variant.dimension == 3;  // without torsion rows between nodes have several equilibria
    if (std::string(variant.type) == "concentric") scene.contact = "centerline = \"spline\"";
    const std::string text = edited(contact_text(scene, ""), "type = \"ipopt\"", "type = \"active-set\"");
    const SolvedScene exact = solved(session_of_text(text));
    REQUIRE_MESSAGE(exact.solution.certificate.verdict == Verdict::converged, exact.solution.certificate.reason);
    for (const char* solver : {"interior-point", "trust-region", "ipopt"}) {
      CAPTURE(std::string(solver));
      Status status;
      if (plugin_host().find(Kind::solver, solver, status) == nullptr) continue;
      const std::string table = "[enforcement]\ntype = \"augmented-lagrangian\"\n" + variant.enforcement + "[solver]";
      const SolvedScene found = solved(session_of_text(
          edited(edited(text, "[solver]", table), "type = \"active-set\"", "type = \"" + std::string(solver) + "\"")));
      CHECK_MESSAGE(found.solution.certificate.verdict == Verdict::converged, found.solution.certificate.reason);
      CHECK(std::fabs(energy_of(found) / energy_of(exact) - 1.0) <= 1e-8);
      // A barrier's end leaves multipliers of segments beside their nodes less certain than energies.
      CHECK(relative_difference(contact_forces(found), contact_forces(exact)) <= 1e-4);
    }
  }
}

TEST_CASE("a soft wire does not tunnel where weights begin firm enough: the guard watches rows that are energies") {
  const Scene scene = scenes().back();
  const std::vector<Override> soft = {{"energy.wire-bending.bending-stiffness", "\"521 N mm^2\""},
                                      {"energy.axial-tension.tension", "\"5 N\""}};
  const SolvedScene exact = solved_by(scene, "interior-point", soft);
  REQUIRE(exact.solution.certificate.verdict == Verdict::converged);
  for (const char* type : {"penalty", "augmented-lagrangian"}) {
    std::vector<Override> overrides = soft;
    overrides.push_back({"enforcement.type", type});
    const SolvedScene found = solved_by(scene, "interior-point", overrides);
    CHECK(found.solution.solver.claim == Claim::optimal);
    CHECK(found.solution.certificate.crossings.empty());
    CHECK(energy_of(found) == doctest::Approx(energy_of(exact)).epsilon(1e-3));
  }
}

TEST_CASE("a result is a start: a bias is no reason to begin anew, and few iterations are left to do") {
  const Scene scene = scenes().front();
  for (const char* type : {"penalty", "augmented-lagrangian"}) {
    CAPTURE(std::string(type));
    SolvedScene found = solved_by(scene, "interior-point", {{"enforcement.type", type}});
    const int cold = found.solution.solver.iterations;
    Start start;
    start.q = found.solution.q;
    start.multipliers = found.solution.multipliers;
    const Solution again = solve(*found.session, {}, &start);
    CHECK(again.certificate.verdict == found.solution.certificate.verdict);
    CHECK(again.solver.enforcement.outer_iterations == 1);
    CHECK(again.solver.iterations <= 3);
    CHECK(cold > 10);
    for (const std::string& warning : again.warnings) CHECK_FALSE(contains(warning, "from the given start"));
    CHECK(found.assembly().largest_motion(start.q, again.q) <= 1e-9);
  }
}

TEST_CASE("the same bits again") {
  const Scene scene = scenes().front();
  for (const char* type : {"penalty", "augmented-lagrangian"}) {
    const std::vector<Override> overrides = {{"enforcement.type", type}};
    CHECK(solved_by(scene, "interior-point", overrides).solution.q ==
          solved_by(scene, "interior-point", overrides).solution.q);
  }
}

}  // namespace bowstring::testing
