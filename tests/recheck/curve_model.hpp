#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tests/recheck/result_file.hpp"
#include "tests/recheck/tape.hpp"

namespace recheck {

/// One number of the state, as the certificate sees it.
struct Unknown {
  std::string place;
  bool free = true;
  double per_length = 1.0;  ///< mm that a rotation's entry of the gradient is divided by
  double value = 0.0, lower = -std::numeric_limits<double>::infinity();
};

/// The orientation on one side of a station, of which a scene uses one part.
template <class Scalar>
struct Side {
  bool has_angle = false;
  Scalar angle{};
  Vector<Scalar> tangent;
  Frame<Scalar> frame;
};

/// The rotation between two orientations: edges 0 … n − 2, then the held tangents.
struct Station {
  int earlier = 0, later = 0;
  double reference_length = 0.0;  ///< mm of material of the rest state that it is spread over
  double arc = 0.0;               ///< mm of State 1
};

/// A curve's places as functions of the unknowns. `Result` must outlive it.
class CurveModel {
 public:
  /// Appends the curve's unknowns.
  CurveModel(const Curve& curve, std::vector<Unknown>& unknowns);

  const Curve& curve() const { return *curve_; }
  const std::vector<Station>& stations() const { return stations_; }
  const std::vector<double>& arc() const { return arc_; }  ///< nodes: State 1's polyline, mm
  double reference_length(int edge) const;                 ///< of the rest state, mm
  double held_length() const;                              ///< of the held edges, mm
  double end_distance() const;            ///< of the end nodes in State 1 with their prescribed moves, mm
  double current_length(int edge) const;  ///< |e|, mm

  Vector<Variable> node(Tape& tape, int node) const;
  Side<Variable> side(Tape& tape, int orientation) const;
  Side<double> reference_side(int orientation) const;
  Variable edge_length(Tape& tape, int edge) const;
  /// Length of material of a station, mm: depends on L where a wire slides.
  Variable station_length(Tape& tape, const Station& station) const;
  Variable free_length(Tape& tape) const;  ///< L of a sliding wire

  /// Largest distance of what the ends hold from where the composition holds it: mm or rad.
  double held_error() const;
  int orientation_slot(int edge) const { return orientation_slot_ + edge * rotations_; }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  void add_positions(std::vector<Unknown>& unknowns);
  void add_orientations(std::vector<Unknown>& unknowns);
  void add_lengths(std::vector<Unknown>& unknowns);
  void find_reference_orientations();
  void add_stations();
  double mean_length_near(int edge) const;
  Vector<Variable> edge_vector(Tape& tape, int edge) const;
  Side<Variable> own_side(Tape& tape, int edge) const;
  Side<Variable> node_side(Tape& tape, int edge) const;
  Side<double> held_side(int held) const;
  Side<double> expected_held(int end) const;

  const Curve* curve_;
  std::vector<double> arc_;
  std::vector<Station> stations_;
  std::vector<Side<double>> reference_;  ///< edges, then held tangents
  int position_slot_ = 0, orientation_slot_ = 0, rotations_ = 0, edge_length_slot_ = 0, length_slot_ = 0;
};

/// Strain times length of a station. In the plane the angle stands in z; of a direction it is no vector.
template <class Scalar>
Scalar plane_angle(const Side<Scalar>& a, const Side<Scalar>& b) {
  using std::atan2;
  if (a.has_angle && b.has_angle) return b.angle - a.angle;
  return atan2(cross(a.tangent, b.tangent).z, dot(a.tangent, b.tangent));
}

}  // namespace recheck
