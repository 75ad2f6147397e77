#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/lie/so3.hpp"
#include "tests/kinematics/differences.hpp"
#include "tests/kinematics/test_curve.hpp"

namespace bowstring::testing {

enum class Ends { free, clamped, held_edge_and_clamp };

struct Case {
  int dimension;
  bool material_frames;
  Extension extension;
  Ends ends;

  std::string text() const {
    const char* extensions[] = {"sliding", "fixed", "stretching"};
    const char* end_names[] = {"free ends", "clamped ends", "held edge and clamp"};
    return std::to_string(dimension) + "-D, " + (material_frames ? "material frames, " : "") +
           extensions[static_cast<int>(extension)] + ", " + end_names[static_cast<int>(ends)];
  }
  Needs needs() const {
    Needs needs;
    needs.material_frames = material_frames;
    needs.reason = "a test reads the twist";
    return needs;
  }
  TestCurve dressed(TestCurve curve) const {
    curve.extension = extension;
    const std::vector<double> first = {1.0, 0.4, dimension == 3 ? 0.3 : 0.0},
                              last = {0.7, 0.9, dimension == 3 ? -0.2 : 0.0};
    if (ends == Ends::clamped) curve.clamp(0, first);
    if (ends == Ends::held_edge_and_clamp) curve.hold_edge(0);
    if (ends != Ends::free) curve.clamp(1, last);
    return curve;
  }
};

inline std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Extension extension : {Extension::sliding, Extension::fixed, Extension::stretching}) {
    for (const Ends ends : {Ends::free, Ends::clamped, Ends::held_edge_and_clamp}) {
      cases.push_back({2, false, extension, ends});
      cases.push_back({3, false, extension, ends});
      cases.push_back({3, true, extension, ends});
    }
  }
  return cases;
}

/// Edges that double back on themselves: each turns by `turn` against the one before, about an axis of its own.
inline TestCurve zigzag(int dimension, int nodes, double turn, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  TestCurve curve;
  curve.dimension = dimension;
  Vector3 point = Vector3::zero(), direction = {{0.8, 0.6, 0.0}};
  for (int i = 0; i < nodes; ++i) {
    for (int k = 0; k < dimension; ++k) curve.reference.push_back(point[k]);
    point += (2.5 + 0.3 * uniform(random)) * direction;
    Vector3 axis = {{0.0, 0.0, uniform(random) < 0.0 ? -1.0 : 1.0}};
    if (dimension == 3) {
      const Vector3 any = {{uniform(random), uniform(random), uniform(random)}};
      axis = normalized(cross(direction, any));
    }
    direction = lie::exp(turn * axis) * direction;
  }
  return curve;
}

template <class Declared>
std::vector<double> perturbed(const Declared& curve, double size, unsigned seed) {
  std::vector<double> delta = random_numbers(curve.unknowns(), seed);
  for (double& x : delta) x *= size;
  return curve.retract(curve.start(), delta);
}

}  // namespace bowstring::testing
