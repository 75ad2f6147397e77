#pragma once

#include <stdexcept>

#include "core/contact/gap.hpp"
#include "tests/benchmarks/hand_output.hpp"

namespace bowstring::benchmarks {

/// Node-wise contact with a spline wall and the squared gap: one row per free node of the wire, h ≤ 0.
template <int d>
class HandContact {
 public:
  HandContact(const BenchScene& bench, const Positions& positions, int first_row) {
    if (bench.scene->constraints.empty()) return;
    wire_ = field_place(bench.wire(), "position");
    vessel_ = field_place(bench.vessel(), "position");
    nodes_ = bench.vessel().view.nodes;
    radius_ = bench.vessel().radius;
    shape_.wire_radius = bench.wire().radius.front();
    const std::vector<double> start = bench.scene->start_coordinates();
    const RowDeclaration& declared = bench.scene->constraints.front().rows;
    for (int r = 0; r < declared.rows; ++r) {
      const Place* places = declared.places.data() + declared.place_begin[at(r)];
      Row row;
      row.point = wire_.coordinate + places[0].index * d;
      row.first_node = places[1].index;
      row.row = first_row + r;
      // The wire starts at the vessel's nodes.
      const contact::Window near = contact::window_around(places[0].index, 2, nodes_);
      row.sigma = contact::closest(centerline(start.data()), start.data() + row.point, shape_, near, places[0].index)
                      .at.sigma();
      row.window =
          declared_window(row.sigma, row.first_node, declared.place_begin[at(r) + 1] - declared.place_begin[at(r)] - 1);
      std::vector<int> unknown;
      for (int p = declared.place_begin[at(r)]; p < declared.place_begin[at(r) + 1]; ++p) {
        const int first = p == declared.place_begin[at(r)] ? wire_.unknown : vessel_.unknown;
        for (int k = 0; k < d; ++k) unknown.push_back(first + declared.places[at(p)].index * d + k);
      }
      row.jacobian = static_cast<int>(jacobian_.size());
      row.hessian = static_cast<int>(hessian_.size());
      for (std::size_t i = 0; i < unknown.size(); ++i) {
        jacobian_.push_back(positions.jacobian(row.row, unknown[i]));
        for (std::size_t j = 0; j <= i; ++j) hessian_.push_back(positions.hessian(unknown[i], unknown[j]));
      }
      rows_.push_back(row);
    }
  }

  void add(const double* q, const double* multipliers, HandOutput& out) const {
    const contact::Centerline wall = centerline(q);
    constexpr int most = (1 + contact::max_stencil) * d;
    double gradient[most], hessian[packed_size(most)];
    for (const Row& row : rows_) {
      const contact::ClosestPoint closest = contact::closest(wall, q + row.point, shape_, row.window, row.sigma);
      if (closest.location == contact::Location::window_edge) throw std::runtime_error("a row has left its window");
      out.rows[at(row.row)] = closest.gap;
      const contact::NodeRange nodes =
          contact::gap_derivatives(wall, q + row.point, shape_, closest, gradient, multipliers[row.row], hessian);
      const int shift = (nodes.first - row.first_node) * d;
      const int count = (1 + nodes.count) * d;
      const int* position = jacobian_.data() + row.jacobian;
      for (int k = 0; k < d; ++k) out.jacobian[at(position[k])] = gradient[k];
      for (int k = d; k < count; ++k) out.jacobian[at(position[shift + k])] = gradient[k];
      const double* h = hessian;
      for (int i = 0; i < count; ++i) {
        const int place = i < d ? i : shift + i;
        const int* in_row = hessian_.data() + row.hessian + packed_size(place);
        for (int j = 0; j < d && j <= i; ++j) out.hessian[at(in_row[j])] += *h++;
        for (int j = d; j <= i; ++j) out.hessian[at(in_row[shift + j])] += *h++;
      }
    }
  }

 private:
  struct Row {
    int point = 0;  // coordinate of the wire's node
    int row = 0;
    int first_node = 0;  // of the vessel, among those that the row covers
    double sigma = 0.0;
    contact::Window window;
    int jacobian = 0, hessian = 0;  // where its positions begin
  };

  contact::Centerline centerline(const double* q) const {
    return {contact::Interpolation::spline, d, nodes_, q + vessel_.coordinate, radius_.data()};
  }

  /// The window of two segments around σ's whose nodes the row declares. At a node σ's segment is a matter of rounding.
  contact::Window declared_window(double sigma, int first, int count) const {
    for (const double near : {sigma, sigma - 1e-6, sigma + 1e-6}) {
      const contact::Window window = contact::window_around(near, 2, nodes_);
      const contact::NodeRange nodes = contact::window_nodes(contact::Interpolation::spline, window, nodes_);
      if (nodes.first == first && nodes.count == count) return window;
    }
    throw std::runtime_error("no window of two segments covers the vessel nodes that a contact row declares");
  }

  FieldPlace wire_, vessel_;
  int nodes_ = 0;
  std::vector<double> radius_;
  contact::GapShape shape_;
  std::vector<Row> rows_;
  std::vector<int> jacobian_, hessian_;
};

}  // namespace bowstring::benchmarks
