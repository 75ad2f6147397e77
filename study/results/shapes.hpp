#pragma once

#include <string>
#include <vector>

namespace bowstring::study {

struct ShapeCurve {
  std::string name;
  bool wire = false;
  std::vector<double> points;  ///< x, y in the plane of the picture, node by node, mm
  std::vector<double> rest;    ///< the same of the rest state; empty of a wire
};

/// A contact force on the wire, in the plane of the picture.
struct ShapeContact {
  double x = 0.0, y = 0.0;    ///< mm
  double fx = 0.0, fy = 0.0;  ///< N
  double force = 0.0;         ///< N, in space
};

/// A run as it can be drawn.
struct Shape {
  int run = 0;
  std::string label;
  std::vector<ShapeCurve> curves;
  std::vector<ShapeContact> contacts;
};

struct Shapes {
  std::vector<Shape> shapes;
  std::string text;  ///< which plane they are drawn in, or why there are none
};

}  // namespace bowstring::study
