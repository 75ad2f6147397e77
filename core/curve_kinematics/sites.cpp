#include "core/curve_kinematics/sites.hpp"

#include <algorithm>
#include <cstddef>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void fill(Span<double> numbers, double value) noexcept { std::fill(numbers.begin(), numbers.end(), value); }

}  // namespace

SiteDeclaration node_site(const CurveMesh& mesh, const FieldSlot& position) {
  const int d = mesh.dimension();
  SiteDeclaration site;
  site.site = Site::node;
  site.count = mesh.nodes();
  site.values = site.width = d;
  site.identity = site.linear = true;
  for (int i = 0; i < mesh.nodes(); ++i) {
    double material = 0.0;
    if (i > 0) material += 0.5 * mesh.curve.edge_length[i - 1];
    if (i < mesh.edges()) material += 0.5 * mesh.curve.edge_length[i];
    site.ds.push_back(material);
    site.arc.push_back(mesh.node_arc[at(i)].at(mesh.start_length()));
    for (int k = 0; k < d; ++k) site.stencil.push_back(position.unknown_of(i) + k);
  }
  return site;
}

void evaluate_nodes(const CurveMesh& mesh, const FieldSlot& position, const SiteEvaluation& out) noexcept {
  const int d = mesh.dimension();
  if (!out.values.empty()) std::copy_n(out.q.data() + position.coordinate, mesh.nodes() * d, out.values.data());
  fill(out.curvature, 0.0);
  if (out.jacobian.empty()) return;
  fill(out.jacobian, 0.0);
  for (int k = 0; k < mesh.nodes() * d; ++k) out.jacobian[at(k * d + k % d)] = 1.0;
}

SiteDeclaration length_site(const CurveMesh& mesh, const FieldSlot& length) {
  SiteDeclaration site;
  site.site = Site::length;
  site.count = site.values = site.width = 1;
  site.linear = true;
  site.stencil = {length.unknown};
  site.ds = {mesh.start_length() + mesh.curve.held_length};
  site.arc = {mesh.node_arc.back().at(mesh.start_length())};
  return site;
}

void evaluate_length(const CurveMesh& mesh, const FieldSlot& length, const SiteEvaluation& out) noexcept {
  if (!out.values.empty()) out.values[0] = out.q[at(length.coordinate)] + mesh.curve.held_length;
  fill(out.jacobian, 1.0);
  fill(out.curvature, 0.0);
}

SiteDeclaration station_site(const CurveMesh& mesh, int components, int width, const FieldSlot& length) {
  SiteDeclaration site;
  site.site = Site::station;
  site.count = static_cast<int>(mesh.stations.size());
  site.lengths_vary = mesh.sliding();
  site.values = components + (site.lengths_vary ? 2 : 0);
  site.width = width;
  site.bent_count = width - (site.lengths_vary ? 1 : 0);
  site.stencil.assign(at(site.count * width), -1);
  for (int k = 0; k < site.count; ++k) {
    const Station& station = mesh.stations[at(k)];
    site.ds.push_back(station.ds.at(mesh.start_length()));
    site.arc.push_back(station.arc.at(mesh.start_length()));
    if (site.lengths_vary) site.stencil[at((k + 1) * width - 1)] = length.unknown;
  }
  return site;
}

SiteDeclaration edge_site(const CurveMesh& mesh, int width) {
  SiteDeclaration site;
  site.site = Site::edge;
  site.count = mesh.edges();
  site.values = 1;
  site.width = width;
  site.stencil.reserve(at(mesh.edges() * width));
  for (int i = 0; i < mesh.edges(); ++i) {
    site.ds.push_back(mesh.curve.edge_length[i]);
    site.arc.push_back(mesh.edge_middle(i));
  }
  return site;
}

SiteDeclaration closure_site(const CurveMesh& mesh, const std::vector<int>& edges, int values, int width) {
  SiteDeclaration site;
  site.site = Site::closure;
  site.count = static_cast<int>(edges.size());
  site.values = values;
  site.width = width;
  site.stencil.reserve(edges.size() * at(width));
  for (const int edge : edges) {
    site.ds.push_back(mesh.edge_length[at(edge)].at(mesh.start_length()));
    site.arc.push_back(mesh.edge_middle(edge));
  }
  return site;
}

}  // namespace bowstring
