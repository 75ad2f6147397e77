#include <doctest/doctest.h>

#include <cmath>

#include "core/lie/so3.hpp"
#include "core/model/manifold.hpp"
#include "tests/assembly/small_scene.hpp"

namespace bowstring::testing {

namespace {

constexpr double tolerance = 1e-12;
const Vector3 shift{{17.0, -5.0, 11.0}};

/// x ↦ R x + shift of a whole state, in the plane about the normal.
std::vector<double> moved(const Session& session, const std::vector<double>& q, const Vector3& turn) {
  const int d = session.scene->dimension;
  const Vector3 axis = d == 2 ? Vector3{{0.0, 0.0, turn[2]}} : turn;
  const lie::Rotation rotation = lie::exp(axis);
  std::vector<double> out = q;
  for (const FieldEntry& entry : session.assembly->entries()) {
    double* own = out.data() + entry.coordinate;
    switch (entry.manifold) {
      case Manifold::real:
        break;
      case Manifold::circle:
        own[0] += axis[2];
        break;
      case Manifold::vector: {
        Vector3 p;
        for (int k = 0; k < d; ++k) p[k] = own[k];
        p = rotation * p + shift;
        for (int k = 0; k < d; ++k) own[k] = p[k];
        break;
      }
      case Manifold::direction:
      case Manifold::rotation:
        (rotation * lie::Rotation::load(own)).store(own);
        break;
    }
  }
  return out;
}

struct Reading {
  std::vector<double> terms, rows;
};

Reading read(Session& session, const std::vector<double>& q) {
  Reading out;
  REQUIRE(session.assembly->term_energies(q, out.terms).ok());
  out.rows.resize(at(session.assembly->rows()));
  ProblemEvaluation evaluation;
  evaluation.rows = out.rows;
  const Status status = session.assembly->evaluate(q, evaluation);
  REQUIRE_MESSAGE(status.ok(), status.text);
  return out;
}

std::vector<SmallScene> scenes() {
  std::vector<SmallScene> out;
  for (const int dimension : {2, 3}) {
    for (const char* kinematics : {"nodes", "edge-frames"}) {
      for (const char* contact : {R"(centerline = "spline")", R"(centerline = "polyline")"}) {
        SmallScene scene;
        scene.dimension = dimension;
        scene.vessel_kinematics = scene.wire_kinematics = kinematics;
        scene.contact = contact;
        scene.wire_ends = R"(["clamped", "pinned"])";
        scene.vessel_frames = scene.wire_frames = dimension == 3 && std::string(kinematics) == "edge-frames";
        out.push_back(scene);
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("a rigid motion of the whole scene changes no energy that claims it, and no row but the closures' axes") {
  for (const SmallScene& scene : scenes()) {
    CAPTURE(scene.text());
    const auto session = session_of(scene);
    const std::vector<double> q = moved_start(*session, 0.2, 5);
    const Reading before = read(*session, q);
    for (const Vector3& turn : {Vector3{{0.4, -1.1, 0.7}}, Vector3{{1.9, 0.3, 2.4}}, Vector3{{1e-8, -2e-8, 1e-8}}}) {
      const Reading after = read(*session, moved(*session, q, turn));
      int claimed = 0;
      for (std::size_t e = 0; e < before.terms.size(); ++e) {
        const EnergyUse& use = session->scene->energies[e];
        CAPTURE(use.label);
        REQUIRE(std::fabs(before.terms[e]) > 0.0);
        if (!use.laws.front().description.objective) {
          CHECK(std::fabs(after.terms[e] - before.terms[e]) > 1e-3 * before.terms[e]);
          continue;
        }
        ++claimed;
        CHECK(std::fabs(after.terms[e] - before.terms[e]) <= tolerance * std::fabs(before.terms[e]));
      }
      CHECK(claimed >= 3);
      for (const RowOrigin& origin : session->assembly->row_origins()) {
        if (origin.constraint < 0) continue;  // closure rows are vectors of the global axes
        REQUIRE(origin.count > 0);
        for (int r = origin.first; r < origin.first + origin.count; ++r) {
          CHECK(std::fabs(after.rows[at(r)] - before.rows[at(r)]) <= 1e-11);
        }
      }
    }
  }
}

}  // namespace bowstring::testing
