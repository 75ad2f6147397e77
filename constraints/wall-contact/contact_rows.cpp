#include "constraints/wall-contact/contact_rows.hpp"

#include <algorithm>
#include <cmath>

namespace bowstring::wall_contact {

namespace {

constexpr int most_places = 2 + contact::max_stencil;
constexpr double near_wall = 0.01;  // of the clearance: a row that is farther away carries nothing at either place

/// Inside h is the gap itself, outside its opposite with the wire's radius added to the tube's.
double sign(const Wall& wall) noexcept { return wall.outside ? -1.0 : 1.0; }

}  // namespace

RowPoint locate(const Row& row, const Wall& wall, const double* wire, contact::Window window) noexcept {
  RowPoint point;
  const int dimension = wall.centerline.dimension;
  point.wire.nodes = row.nodes;
  point.wire.points = wire + row.node * dimension;
  point.wire.t = row.extremal && row.midway ? row.part.middle() : row.t;
  for (int k = 0; k < 2; ++k) point.wire.radius[k] = sign(wall) * row.radius[k];
  if (row.extremal && !row.midway) {
    const contact::ChordExtremum extremum =
        contact::chord_extremum(wall.centerline, point.wire, wall.form, sign(wall), window, row.sigma, row.part);
    point.wire.t = extremum.t;
    point.wire.extremal = extremum.interior;
    point.closest = extremum.closest;
  } else {
    double x[3] = {};
    point.wire.position(dimension, x);
    const contact::GapShape shape = point.wire.shape(wall.form);
    point.closest = row.searches ? contact::closest(wall.centerline, x, shape, window, row.sigma)
                                 : contact::gap_at(wall.centerline, x, shape,
                                                   contact::coordinate(row.sigma, wall.centerline.nodes));
  }
  point.gap = sign(wall) * point.closest.gap;
  return point;
}

contact::GapExpansion expand(const Wall& wall, const RowPoint& point) noexcept {
  return contact::expand_gap(wall.centerline, point.wire, wall.form, point.closest);
}

RowSupport support(const Row& row, const contact::GapExpansion& expansion) noexcept {
  return {row.nodes, row.nodes + expansion.nodes.first - row.covers.first, expansion.nodes.count};
}

void write_gradient(const Row& row, const Wall& wall, const contact::GapExpansion& expansion, bool all_places,
                    double* out) noexcept {
  if (!all_places) return contact::gap_gradient(expansion, sign(wall), out);
  const int dimension = wall.centerline.dimension;
  double local[most_places * 3];
  contact::gap_gradient(expansion, sign(wall), local);
  std::fill(out, out + row.places() * dimension, 0.0);
  const RowSupport places = support(row, expansion);
  for (int k = 0; k < places.places() * dimension; ++k) {
    out[places.place(k / dimension) * dimension + k % dimension] = local[k];
  }
}

void write_hessian(const Row& row, const Wall& wall, const contact::GapExpansion& expansion, double weight,
                   bool all_places, double* out) noexcept {
  if (!all_places) return contact::gap_hessian(expansion, sign(wall) * weight, out);
  const int dimension = wall.centerline.dimension;
  double local[packed_size(most_places * 3)];
  contact::gap_hessian(expansion, sign(wall) * weight, local);
  std::fill(out, out + packed_size(row.places() * dimension), 0.0);
  const RowSupport places = support(row, expansion);
  const auto index = [&](int k) { return places.place(k / dimension) * dimension + k % dimension; };
  for (int a = 0, k = 0; a < places.places() * dimension; ++a) {
    for (int b = 0; b <= a; ++b, ++k) out[packed_index(index(a), index(b))] = local[k];
  }
}

contact::ClosestPoint lowest_place(const Row& row, const Wall& wall, const RowPoint& point) noexcept {
  if (!row.searches || row.extremal || wall.outside) return point.closest;
  double x[3] = {};
  point.wire.position(wall.centerline.dimension, x);
  return contact::lowest_connected(wall.centerline, wall.bounds, x, point.wire.shape(wall.form), point.closest);
}

void refer_to(Row& row, const Wall& wall, const double* wire, contact::Window window, const RowPoint* known) noexcept {
  RowPoint point = known != nullptr ? *known : locate(row, wall, wire, window);
  if (point.gap > -near_wall * point.closest.clearance) {
    const contact::ClosestPoint lowest = lowest_place(row, wall, point);
    if (lowest.gap < point.gap) {
      point.closest = lowest;
      point.gap = lowest.gap;
      row.jumped = true;
    }
  }
  const contact::CurvePoint q = contact::evaluate(wall.centerline, point.closest.at);
  const int dimension = wall.centerline.dimension;
  double x[3] = {};
  point.wire.position(dimension, x);
  row.t = point.wire.t;
  row.sigma = point.closest.at.sigma();
  for (double& sigma : row.end_sigma) sigma = row.sigma;
  if (row.extremal) {
    const contact::ChordExtremum extremum =
        contact::chord_extremum(wall.centerline, point.wire, wall.form, sign(wall), window, row.sigma, row.part);
    row.bend = extremum.bend;
    std::copy_n(extremum.end_sigma, 2, row.end_sigma);
  }
  row.stencil = contact::stencil(wall.centerline.interpolation, point.closest.at, wall.centerline.nodes);
  row.gap = point.gap;
  row.clearance = point.closest.clearance;
  const double speed = std::hypot(q.slope[0], q.slope[1], q.slope[2]);
  for (int k = 0; k < dimension; ++k) {
    row.offset[k] = x[k] - q.position[k];
    row.tangent[k] = q.slope[k] / speed;
  }
}

double travelled(const Row& row, int dimension, const double* wire, const double* vessel) noexcept {
  double motion[3] = {};
  double along = 0.0;
  for (int k = 0; k < dimension; ++k) {
    const double* p = wire + row.node * dimension + k;
    const double x = row.nodes == 1 ? p[0] : (1.0 - row.t) * p[0] + row.t * p[dimension];
    double q = 0.0;
    for (int j = 0; j < row.stencil.nodes.count; ++j) {
      q += row.stencil.value[j] * vessel[(row.stencil.nodes.first + j) * dimension + k];
    }
    motion[k] = x - q - row.offset[k];
    along += motion[k] * row.tangent[k];
  }
  double squared = 0.0;
  for (int k = 0; k < dimension; ++k) {
    const double across = motion[k] - along * row.tangent[k];
    squared += across * across;
  }
  return std::sqrt(squared) / row.clearance;
}

}  // namespace bowstring::wall_contact
