#include "core/curve_kinematics/curve_mesh.hpp"

#include <cstddef>

namespace bowstring {

namespace {

LinearInLength edge_length(const CurveMesh& mesh, int edge) {
  const auto i = static_cast<std::size_t>(edge);
  if (mesh.sliding() && !mesh.edge_held(edge)) return {0.0, mesh.curve.fraction[i]};
  return {mesh.curve.edge_length[i], 0.0};
}

void add_stations(CurveMesh& mesh) {
  const int last = mesh.edges() - 1;
  if (mesh.held_tangent[0] >= 0) {
    const LinearInLength edge = mesh.edge_length.front();
    mesh.stations.push_back({mesh.edges() + mesh.held_tangent[0], 0, 0.5 * edge, mesh.node_arc.front() + 0.25 * edge});
  }
  for (int i = 1; i <= last; ++i) {
    const auto node = static_cast<std::size_t>(i);
    mesh.stations.push_back(
        {i - 1, i, 0.5 * (mesh.edge_length[node - 1] + mesh.edge_length[node]), mesh.node_arc[node]});
  }
  if (mesh.held_tangent[1] >= 0) {
    const LinearInLength edge = mesh.edge_length.back();
    mesh.stations.push_back(
        {last, mesh.edges() + mesh.held_tangent[1], 0.5 * edge, mesh.node_arc.back() + (-0.25) * edge});
  }
}

}  // namespace

bool CurveMesh::edge_held(int edge) const noexcept {
  return curve.rigid || (edge == 0 && curve.end[0].edge_held) || (edge == edges() - 1 && curve.end[1].edge_held);
}

double CurveMesh::edge_middle(int edge) const noexcept {
  const auto i = static_cast<std::size_t>(edge);
  return (0.5 * (node_arc[i] + node_arc[i + 1])).at(start_length());
}

CurveMesh make_curve_mesh(const CurveView& curve) {
  CurveMesh mesh;
  mesh.curve = curve;
  mesh.node_arc.push_back({curve.arc[0], 0.0});
  for (int i = 0; i < mesh.edges(); ++i) {
    mesh.edge_length.push_back(edge_length(mesh, i));
    const LinearInLength sum = mesh.node_arc.back() + mesh.edge_length.back();
    mesh.node_arc.push_back(mesh.sliding() ? sum : LinearInLength{curve.arc[i + 1], 0.0});
  }
  for (int e = 0; e < 2; ++e) {
    if (curve.rigid || !curve.end[e].rotation_held || curve.end[e].edge_held) continue;
    mesh.held_tangent[e] = mesh.held_tangents++;
  }
  add_stations(mesh);
  return mesh;
}

}  // namespace bowstring
