#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/interfaces/curve.hpp"

namespace bowstring::testing {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

inline double distance(const double* a, const double* b, int dimension) {
  double squared = 0.0;
  for (int k = 0; k < dimension; ++k) squared += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squared);
}

/// A curve that owns its numbers. Edit `reference`, `start` and `ends`, then ask for a view.
struct TestCurve {
  int dimension = 3;
  Extension extension = Extension::stretching;
  bool rigid = false;
  EndCondition end[2];
  std::vector<double> reference, start;

  int nodes() const { return static_cast<int>(reference.size()) / dimension; }

  /// What a scene derives from the points. Valid until the next call.
  CurveView view() {
    const int edges = nodes() - 1;
    if (start.empty()) start = reference;
    arc_.assign(1, 0.0);
    length_.clear();
    fraction_.assign(at(edges), 1.0);
    double held = 0.0;
    for (int i = 0; i < edges; ++i) {
      const double* p = start.data() + i * dimension;
      length_.push_back(distance(p, p + dimension, dimension));
      arc_.push_back(arc_.back() + length_.back());
      const bool edge_held = (i == 0 && end[0].edge_held) || (i == edges - 1 && end[1].edge_held);
      if (!edge_held) continue;
      fraction_[at(i)] = 0.0;
      held += length_.back();
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < fraction_.size(); ++i)
      sum += fraction_[i] *= 1.0 + 0.1 * std::sin(static_cast<double>(i));
    for (double& f : fraction_) f /= sum;

    CurveView view;
    view.name = "test";
    view.kind = extension == Extension::stretching ? CurveKind::vessel : CurveKind::wire;
    view.dimension = dimension;
    view.nodes = nodes();
    view.extension = extension;
    view.rigid = rigid;
    view.reference = reference.data();
    view.start = start.data();
    view.edge_length = length_.data();
    view.fraction = fraction_.data();
    view.arc = arc_.data();
    view.held_length = held;
    view.start_length = arc_.back() - held;
    view.end_distance = distance(start.data(), start.data() + edges * dimension, dimension);
    view.end[0] = end[0];
    view.end[1] = end[1];
    return view;
  }

  void hold_position(int e) {
    for (int k = 0; k < dimension; ++k) end[e].position_held[k] = true;
  }
  /// `tangent` need not be normalised.
  void clamp(int e, std::vector<double> tangent) {
    hold_position(e);
    end[e].rotation_held = true;
    double squared = 0.0;
    for (const double t : tangent) squared += t * t;
    for (std::size_t k = 0; k < tangent.size(); ++k) end[e].tangent[k] = tangent[k] / std::sqrt(squared);
  }
  void hold_edge(int e) {
    hold_position(e);
    end[e].edge_held = true;
  }

 private:
  std::vector<double> length_, fraction_, arc_;
};

/// Nodes of `point` at n parameters evenly spread over [0, 1].
inline TestCurve curve_of(int dimension, int nodes, const std::function<std::vector<double>(double)>& point) {
  TestCurve curve;
  curve.dimension = dimension;
  for (int i = 0; i < nodes; ++i) {
    const std::vector<double> p = point(static_cast<double>(i) / (nodes - 1));
    curve.reference.insert(curve.reference.end(), p.begin(), p.begin() + dimension);
  }
  return curve;
}

inline TestCurve straight_curve(int dimension, int nodes, double length) {
  return curve_of(dimension, nodes, [=](double t) -> std::vector<double> {
    return {0.8 * length * t, 0.6 * length * t, 0.0};
  });
}

/// A walk whose edges turn by random angles of up to about 1 rad.
inline TestCurve crooked_curve(int dimension, int nodes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  TestCurve curve = straight_curve(dimension, nodes, 2.5 * (nodes - 1));
  for (double& x : curve.reference) x += 0.5 * uniform(random);
  return curve;
}

}  // namespace bowstring::testing
