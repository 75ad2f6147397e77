#pragma once

#include <string>
#include <vector>

#include "core/interfaces/status.hpp"

namespace bowstring {

/// A named quantity given at the nodes of a curve: radius_mm, calcium, hounsfield.
struct PointData {
  std::string name;
  std::vector<double> value;
};

struct CurveGeometry {
  std::string name;                                 ///< of the curve within its graph; "" for a single curve
  std::vector<double> points;                       ///< nodes × dimension, mm; LPS where anatomical
  std::vector<PointData> data;                      ///< each with one value per node
  std::vector<std::string> label;                   ///< one per node, or empty: segment labels
  std::vector<double> first_tangent, last_tangent;  ///< exact end tangents along the curve, or empty
};

struct Junction {
  std::string parent, child;
  double parent_arc = 0.0;  ///< mm along the parent
};

/// A graph of named curves, even when it holds one.
struct CurveGraph {
  std::vector<CurveGeometry> curves;
  std::vector<Junction> junctions;
  std::vector<std::string> warnings;
};

/// kind `geometry`: a source of State 1 curves. `dimension` is the scene's.
class Geometry {
 public:
  virtual ~Geometry() = default;
  /// `invalid_input` where the parameters or a file cannot give a curve of that dimension.
  virtual Status build(int dimension, CurveGraph& out) noexcept = 0;
};

}  // namespace bowstring
