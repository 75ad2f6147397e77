#pragma once

#include <string>
#include <vector>

#include "core/lie/so3.hpp"

namespace bowstring {

/// One curve of a result document, with one entry per node in every array. A number that is null or absent in the
/// document is not a number here.
struct ResultCurve {
  std::string name;
  bool wire = false;
  std::vector<Vector3> points;     ///< State 2, mm; third coordinate 0 in the plane
  std::vector<Vector3> reference;  ///< State 1, mm
  std::vector<double> arc;         ///< State 2 arc length from the first end, mm
  std::vector<double> radius;      ///< mm
  std::vector<double> curvature;   ///< 1/mm
  std::vector<double> twist;       ///< 1/mm
  std::vector<Vector3> moment;     ///< N mm, in the axes of the frame: torsion, then bending; in the plane the third
  std::vector<lie::Rotation> frames;

  int nodes() const noexcept { return static_cast<int>(points.size()); }
};

struct ResultContact {
  int wire = 0;        ///< index of the curve
  double arc = 0.0;    ///< State 2 arc length along the wire, mm
  double force = 0.0;  ///< N
  double edge = 0.0;   ///< of the wire
  double part = 0.0;   ///< of that edge, in [0, 1]
  double gap = 0.0;    ///< mm
  Vector3 direction;   ///< unit, of the force on the wire
};

struct ResultSupport {
  int curve = 0;
  bool last = false;  ///< which end is held
};

/// What the writers take from a `bowstring.result/1` document.
struct Result {
  std::string title, status, reason;
  int dimension = 2;
  bool patient_axes = false;  ///< the geometry came from a file: x, y, z are left, posterior, superior
  double peak_displacement = 0.0, total_energy = 0.0;  ///< mm, N mm
  double contact_count = 0.0, contact_force = 0.0;     ///< number; sum, N
  std::vector<ResultCurve> curves;
  std::vector<ResultContact> contacts;
  std::vector<ResultSupport> supports;
};

/// Reads the text of a document. Throws a StatusError with `invalid_input` that says where, and what was expected,
/// when the text is not JSON or not such a document.
Result read_result(const char* text);

/// The node of `curve` whose arc length is nearest to `arc`; −1 where nothing is known.
int nearest_node(const ResultCurve& curve, double arc);

}  // namespace bowstring
