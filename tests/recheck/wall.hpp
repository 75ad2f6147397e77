#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/recheck/curve_model.hpp"

namespace recheck {

/// A polynomial of one vessel segment and its first two derivatives by σ, in segments.
template <class Value>
struct Jet {
  Value value{}, first{}, second{};
};

/// What a gap function has of A = |x − q|² and the clearance c.
struct GapJet {
  double value = 0.0, by_a = 0.0, by_c = 0.0, by_aa = 0.0, by_ac = 0.0, by_cc = 0.0;
};

enum class GapForm { squared, distance, smooth_distance };

/// squared (A − c²)/(2c); distance √A − c; smooth √(A + δ²) − δ − c, δ = 1e-3 mm.
GapJet gap_of(GapForm form, double a, double c);

/// A point of the wire's material against the wall: what it is near to, and how deep.
struct WallPoint {
  double sigma = 0.0;  ///< segments from the vessel's first node
  double gap = 0.0;    ///< the gap function's value there
  double depth = 0.0;  ///< |x − q| − c, mm; beyond the vessel's ends only across it
};

/// The wall of a vessel at given nodes: centerline q(σ) and lumen radius R(σ) by the same interpolation.
class Wall {
 public:
  /// `spline`: the uniform cubic B-spline with control points b_i = p_i − (p_{i+1} − 2p_i + p_{i−1})/6, b_i = p_i at
  /// the ends and one reflected point beyond; otherwise straight between the nodes.
  Wall(const std::vector<Point>& nodes, const std::vector<double>& radius, bool spline, GapForm form, bool outside);

  int segments() const { return static_cast<int>(nodes_) - 1; }

  /// The local minimum over σ that lies downhill from `start`; `wire_radius` in mm.
  WallPoint descend(const Point& x, double wire_radius, double start) const;
  /// The lowest local minimum within `window` segments of `near`; of the whole vessel for a negative window.
  WallPoint lowest(const Point& x, double wire_radius, double near, int window) const;
  /// Where the wall has ridges the lowest minimum jumps from one place to another: the lowest one that can be reached
  /// from `place` (inside of the tube) by steps between places whose two balls hold the centerline between them;
  /// `place` where there is none lower. The union of two balls that both hold x has no wall between x and any point of
  /// it, so that such places are of one limb.
  WallPoint past_ridges(const Point& x, double wire_radius, const WallPoint& place) const;
  /// At a given σ.
  WallPoint at(const Point& x, double wire_radius, double sigma) const;

  /// Vessel nodes and their weights in q(σ), and in R(σ).
  std::vector<std::pair<int, double>> weights(double sigma) const;
  double lumen_radius(double sigma) const;

 private:
  struct Local {
    double value = 0.0, first = 0.0, second = 0.0;
  };
  void split(double sigma, int& segment, double& u) const;
  Jet<Point> center(int segment, double u) const;
  Jet<double> lumen(int segment, double u) const;
  double clearance(double lumen_radius, double wire_radius) const;
  Local gap(const Point& x, double wire_radius, int segment, double u) const;
  bool within_reach(double wire_radius, double from, double to) const;
  bool one_limb(double wire_radius, double from, double to) const;
  double minimise(const Point& x, double wire_radius, int segment, double u) const;

  std::size_t nodes_;
  bool spline_;
  GapForm form_;
  bool outside_;
  std::vector<Point> control_;  ///< of a spline with one more at both ends
  std::vector<double> control_radius_;
};

}  // namespace recheck
