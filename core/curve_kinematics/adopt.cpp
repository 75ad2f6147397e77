#include "core/curve_kinematics/adopt.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double unit_length = 1e-6;  // by how much a quaternion's length may miss 1
constexpr double whole_turn = 2.0 * M_PI;

double nearest_turns(double angle) { return whole_turn * std::round(angle / whole_turn); }

double edge_length(const CurveShape& shape, int d, int edge) {
  double squared = 0.0;
  for (int k = 0; k < d; ++k) {
    const double step = shape.position[at((edge + 1) * d + k)] - shape.position[at(edge * d + k)];
    squared += step * step;
  }
  return std::sqrt(squared);
}

Status wrong(const CurveMesh& mesh, const std::string& text) {
  return Status::failure(Code::invalid_input, std::string("a shape of '") + mesh.curve.name + "' with " + text);
}

}  // namespace

Status check_shape(const CurveMesh& mesh, const CurveShape& shape) {
  const int d = mesh.dimension();
  if (shape.position.size() != at(mesh.nodes() * d) || shape.orientation.size() != at(4 * mesh.edges())) {
    return wrong(mesh, std::to_string(shape.position.size()) + " coordinates and " +
                           std::to_string(shape.orientation.size()) + " numbers of orientations; expected " +
                           std::to_string(mesh.nodes() * d) + " and " + std::to_string(4 * mesh.edges()));
  }
  for (int i = 0; i < mesh.nodes(); ++i) {
    const double* p = shape.position.data() + i * d;
    if (!std::all_of(p, p + d, [](double x) { return std::isfinite(x); })) {
      return wrong(mesh, "a coordinate at node " + std::to_string(i) + " that is no finite number");
    }
  }
  for (int i = 0; i < mesh.edges(); ++i) {
    const double* r = shape.orientation.data() + 4 * i;
    const double norm = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
    if (!(std::fabs(norm - 1.0) <= unit_length)) {
      return wrong(mesh, "an orientation of edge " + std::to_string(i) + " that is no unit quaternion");
    }
    if (!(edge_length(shape, d, i) > 0.0)) return wrong(mesh, "edge " + std::to_string(i) + " of length zero");
  }
  return {};
}

void adopt_positions(const CurveMesh& mesh, const CurveShape& shape, const FieldSlot& position, const FieldSlot& length,
                     Span<double> q) {
  std::copy(shape.position.begin(), shape.position.end(), q.begin() + position.coordinate);
  if (!length.exists()) return;
  double sum = 0.0;
  for (int i = 0; i < mesh.edges(); ++i) sum += mesh.edge_held(i) ? 0.0 : edge_length(shape, mesh.dimension(), i);
  q[at(length.coordinate)] = sum;
}

std::vector<double> adopted_angles(const CurveMesh& mesh, const CurveShape& shape, const std::vector<double>& held,
                                   double near) {
  std::vector<double> out;
  for (int i = 0; i < mesh.edges(); ++i) {
    const double* r = shape.orientation.data() + 4 * i;
    const double angle = 2.0 * std::atan2(r[3], r[0]);
    out.push_back(i == 0 ? angle : angle - nearest_turns(angle - out.back()));
  }
  const bool by_last = mesh.held_tangent[0] < 0 && mesh.held_tangent[1] >= 0;
  const double miss = by_last ? out.back() - held.back() : out.front() - (held.empty() ? near : held.front());
  for (double& angle : out) angle -= nearest_turns(miss);
  return out;
}

}  // namespace bowstring
