#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/session/session.hpp"

namespace bowstring {

/// A contact row at the solution.
struct ContactRecord {
  int wire = 0, vessel = 0, row = 0;
  double wire_coordinate = 0.0;  ///< in edges of the wire: 2.25 is a quarter along the third
  double wire_arc = 0.0;         ///< State 2, mm
  double vessel_arc = 0.0;       ///< State 1, mm
  double gap = 0.0;              ///< mm
  double force = 0.0;            ///< N: the multiplier
  double direction[3] = {};      ///< unit, of the force on the wire
};

/// What holds one end of a curve.
struct SupportRecord {
  int curve = 0;
  int end = 0;            ///< 0 first, 1 last
  double force[3] = {};   ///< N, exerted on the curve
  double moment[3] = {};  ///< N mm, exerted on the curve, about the end node
};

/// One curve at the solution, per node unless said otherwise.
struct CurveRecord {
  int curve = 0;
  std::vector<double> points, arc;       ///< State 2
  std::vector<double> frames;            ///< quaternions (w, x, y, z), first axis along the curve
  std::vector<double> curvature, twist;  ///< 1/mm; twist empty without material frames
  std::vector<double> moment;            ///< N mm, body axes: 1 number in the plane, 3 in space
  std::vector<double> internal_force;    ///< N, global axes, per edge: what the later side exerts on the earlier one
};

struct Quantities {
  std::optional<double> peak_displacement, mean_displacement, mean_displacement_nodes;  ///< mm, of vessels
  std::optional<double> wire_length, vessel_length_change, arc_to_chord;
  int contact_count = 0;
  double contact_force = 0.0;                ///< N, sum
  std::optional<double> line_load_peak;      ///< N/mm, Tκ over nodes in contact (preprint eq. (20))
  std::optional<double> line_load_integral;  ///< N
};

struct Readings {
  std::vector<double> term_energy;  ///< N mm, in the order of the scene's energies
  std::vector<CurveRecord> curves;
  std::vector<ContactRecord> contacts;
  std::vector<SupportRecord> supports;
  Quantities quantities;
};

/// Everything that the result document says of a solution beyond its certificate.
Status read_solution(Session& session, const Solution& solution, Readings& out);

}  // namespace bowstring
