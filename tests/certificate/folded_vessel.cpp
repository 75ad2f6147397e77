#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/certificate/solved_scene.hpp"

namespace bowstring::testing {

namespace {

struct Fold {
  double smallest_stretch = 1e300;
  bool turned_back = false;  ///< an edge by more than 90 degrees against its neighbour
};

Fold measured_fold(const Session& session, const std::vector<double>& q) {
  Fold out;
  const Curve& vessel = *session.scene->find("iliac");
  const double* p = q.data() + vessel.coordinate_begin;
  double before[2] = {};
  for (int i = 0; i + 1 < vessel.view.nodes; ++i) {
    const double edge[2] = {p[2 * i + 2] - p[2 * i], p[2 * i + 3] - p[2 * i + 1]};
    out.smallest_stretch = std::min(out.smallest_stretch, std::hypot(edge[0], edge[1]) / vessel.view.edge_length[i]);
    out.turned_back = out.turned_back || edge[0] * before[0] + edge[1] * before[1] < 0.0;
    before[0] = edge[0], before[1] = edge[1];
  }
  return out;
}

}  // namespace

TEST_CASE("a stiff wire in a vessel without stretch stiffness never ends as converged with a folded edge") {
  for (const char* kinematics : {"edge-frames", "nodes"}) {
    CAPTURE(std::string(kinematics));
    const std::string quoted = std::string("\"") + kinematics + "\"";
    SolvedScene scene = solved(
        session_of_file("planar-iliac-smooth.toml", {{"energy.wire-bending.bending-stiffness", "\"6132 N mm^2\""},
                                                     {"energy.vessel-strain.stretch-stiffness", "\"0 N\""},
                                                     {"vessel.iliac.geometry.nodes", "160"},
                                                     {"vessel.iliac.kinematics", quoted},
                                                     {"wire.lunderquist.kinematics", quoted}}));
    const Certificate& certificate = scene.solution.certificate;
    const Fold fold = measured_fold(*scene.session, scene.solution.q);
    INFO(certificate.reason);
    CHECK(certificate.minimum_stretch == doctest::Approx(fold.smallest_stretch).epsilon(1e-12));
    const bool folded = fold.smallest_stretch <= 0.2 || fold.turned_back;
    CHECK(certificate.folds.empty() == !folded);
    const bool wrongly_converged = certificate.verdict == Verdict::converged && folded;
    CHECK_FALSE(wrongly_converged);
    const auto& warnings = scene.solution.warnings;
    CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& text) {
      return text.find("stretch-stiffness is 0") != std::string::npos;
    }));
  }
}

}  // namespace bowstring::testing
