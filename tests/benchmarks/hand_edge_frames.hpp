#pragma once

#include "tests/benchmarks/hand_curve.hpp"

namespace bowstring::benchmarks {

/// A curve with an orientation per edge, closure rows p_{i+1} − p_i = ℓ_i R_i e₁ and the laws that the shipped scenes
/// have on it. A wire slides, ℓ_i = share_i L; a vessel stretches, ℓ_i being unknowns.
template <Manifold manifold, bool sliding>
class HandEdgeFrames {
  using EdgeOrientation = Orientation<manifold>;
  static constexpr int d = EdgeOrientation::dimension, m = EdgeOrientation::components;
  static constexpr int numbers = EdgeOrientation::coordinates;

 public:
  HandEdgeFrames(const BenchScene& bench, const Curve& curve, const Positions& positions, int& row)
      : position_(field_place(curve, "position")),
        orientation_(field_place(curve, "orientation")),
        length_(field_place(curve, sliding ? "length" : "edge-length")) {
    const FieldPlace held = field_place(curve, "held-tangent");
    const int edges = curve.view.nodes - 1;
    // A clamp stands at the first end only, before the other stations.
    if (curve.view.end[0].rotation_held) add_station(held, 0, 0, positions);
    for (int i = 0; i + 1 < edges; ++i) add_station(orientation_, i, i + 1, positions);
    for (int i = 0; i < edges; ++i) add_closure(curve, i, row, positions);
    row += edges * d;

    const std::vector<double> reference = bench.scene->reference_coordinates();
    std::vector<double> strain;
    for (const Station& station : stations_) {
      const auto value = strain_at(station, reference.data()).value;
      strain.insert(strain.end(), value.data.begin(), value.data.end());
    }
    has_strain_ = read_station_laws(bench, curve, strain, laws_);
    const LawUse* stretch = sliding ? nullptr : find_law(*bench.scene, "vessel-strain", Site::edge);
    for (int i = 0; stretch != nullptr && i < edges; ++i) {
      const int unknown = length_.unknown + i;
      edges_.push_back({stretch->parameters[0][at(i)], 1.0 / curve.edge_length[at(i)], positions.gradient(unknown),
                        positions.hessian(unknown, unknown)});
    }
    if (sliding) {
      length_gradient_ = positions.gradient(length_.unknown);
      length_hessian_ = positions.hessian(length_.unknown, length_.unknown);
    }
  }

  void add(const double* q, double factor, const double* multipliers, HandOutput& out) const {
    const double length = sliding ? q[length_.coordinate] : 0.0;
    if (has_strain_) add_strain(q, length, factor, out);
    if (!edges_.empty()) add_stretch(q, factor, out);
    add_rows(q, length, multipliers, out);
  }

 private:
  struct Station {
    int earlier = 0, later = 0;  // coordinates
    ElementMap<2 * m> map;
    int by_length[2 * m] = {};
  };
  struct Closure {
    int point = 0, orientation = 0, length = 0;  // coordinates
    double share = 0.0;
    int row = 0;
    int jacobian[d][2 + m + 1] = {};  // of each row: its own coordinate of both nodes, the orientation, the length
    int turn[packed_size(m)] = {}, by_length[m] = {};
  };
  struct Edge {
    double stiffness = 0.0, by_rest_length = 0.0;
    int gradient = 0, hessian = 0;
  };

  void add_station(FieldPlace earlier, int index, int later, const Positions& positions) {
    int unknown[2 * m];
    set_unknowns<m>(earlier.unknown, index, unknown);
    set_unknowns<m>(orientation_.unknown, later, unknown + m);
    Station station;
    station.earlier = earlier.coordinate + index * numbers;
    station.later = orientation_.coordinate + later * numbers;
    station.map = ElementMap<2 * m>(positions, unknown);
    for (int k = 0; sliding && k < 2 * m; ++k) {
      station.by_length[k] = positions.hessian(length_.unknown, unknown[k]);
    }
    stations_.push_back(station);
  }

  void add_closure(const Curve& curve, int edge, int row, const Positions& positions) {
    Closure closure;
    closure.point = position_.coordinate + edge * d;
    closure.orientation = orientation_.coordinate + edge * numbers;
    closure.length = length_.coordinate + (sliding ? 0 : edge);
    closure.share = sliding ? curve.fraction[at(edge)] : 1.0;
    closure.row = row + edge * d;
    const int length = length_.unknown + (sliding ? 0 : edge);
    int turn[m];
    set_unknowns<m>(orientation_.unknown, edge, turn);
    for (int a = 0; a < d; ++a) {
      int* jacobian = closure.jacobian[a];
      *jacobian++ = positions.jacobian(closure.row + a, position_.unknown + edge * d + a);
      *jacobian++ = positions.jacobian(closure.row + a, position_.unknown + (edge + 1) * d + a);
      for (int k = 0; k < m; ++k) *jacobian++ = positions.jacobian(closure.row + a, turn[k]);
      *jacobian = positions.jacobian(closure.row + a, length);
    }
    for (int i = 0, k = 0; i < m; ++i) {
      for (int j = 0; j <= i; ++j, ++k) closure.turn[k] = positions.hessian(turn[i], turn[j]);
      closure.by_length[i] = positions.hessian(length, turn[i]);
    }
    closures_.push_back(closure);
  }

  StationStrain<manifold> strain_at(const Station& station, const double* q) const {
    return station_strain(EdgeOrientation::load(q + station.earlier), EdgeOrientation::load(q + station.later));
  }

  void add_strain(const double* q, double length, double factor, HandOutput& out) const {
    double energy = 0.0;
    LengthSums sums;
    for (std::size_t k = 0; k < stations_.size(); ++k) {
      const Station& station = stations_[k];
      const auto earlier = EdgeOrientation::load(q + station.earlier);
      const auto later = EdgeOrientation::load(q + station.later);
      const StationStrain<manifold> strain = station_strain(earlier, later);
      const StationTerms<m> law = station_terms(laws_[k], strain.value, length);
      energy += law.energy;
      Matrix<m, 2 * m> b;
      b.set_block(0, 0, strain.by_a);
      b.set_block(0, m, strain.by_b);
      station.map.add_gradient(b.transpose() * law.force, out.gradient.data());
      Matrix<m, 2 * m> cb = b;
      for (int a = 0; a < m; ++a) {
        for (int j = 0; j < 2 * m; ++j) cb(a, j) *= law.modulus[a];
      }
      Matrix<2 * m, 2 * m> h = b.transpose() * cb;
      if constexpr (!EdgeOrientation::straight) h += station_curvature(strain, law.force);
      station.map.add_hessian(factor * h, out.hessian.data());
      if constexpr (sliding) {
        sums.gradient += law.by_length;
        sums.hessian += law.by_length_twice;
        const Vector<2 * m> mixed = b.transpose() * law.mixed;
        for (int i = 0; i < 2 * m; ++i) out.hessian[at(station.by_length[i])] += factor * mixed[i];
      }
    }
    out.energy += energy;
    if (!sliding) return;
    out.gradient[at(length_gradient_)] += sums.gradient;
    out.hessian[at(length_hessian_)] += factor * sums.hessian;
  }

  void add_stretch(const double* q, double factor, HandOutput& out) const {
    const double* length = q + length_.coordinate;
    double energy = 0.0;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Edge& edge = edges_[i];
      const double extension = length[i] * edge.by_rest_length - 1.0;
      energy += 0.5 * edge.stiffness * extension * extension / edge.by_rest_length;
      out.gradient[at(edge.gradient)] += edge.stiffness * extension;
      out.hessian[at(edge.hessian)] += factor * edge.stiffness * edge.by_rest_length;
    }
    out.energy += energy;
  }

  void add_rows(const double* q, double unknown_length, const double* multipliers, HandOutput& out) const {
    double* jacobian = out.jacobian.data();
    double* hessian = out.hessian.data();
    for (const Closure& closure : closures_) {
      const Matrix<d, d> r = axes(EdgeOrientation::load(q + closure.orientation));
      const double length = sliding ? closure.share * unknown_length : q[closure.length];
      const double slope = sliding ? closure.share : 1.0;
      const Vector<d> t = tangent(r);
      const double* p = q + closure.point;
      for (int a = 0; a < d; ++a) {
        out.rows[at(closure.row + a)] = p[d + a] - p[a] - length * t[a];
        const int* position = closure.jacobian[a];
        jacobian[*position++] = -1.0;
        jacobian[*position++] = 1.0;
        const Vector<m> gradient = tangent_gradient<manifold>(r, a);
        for (int k = 0; k < m; ++k) jacobian[*position++] = -length * gradient[k];
        jacobian[*position] = -slope * t[a];
      }
      const Vector<d> weight = Vector<d>::load(multipliers + closure.row);
      const Matrix<m, m> bend = tangent_curvature<manifold>(r, weight);
      Vector<m> pull;
      for (int a = 0; a < d; ++a) pull += weight[a] * tangent_gradient<manifold>(r, a);
      for (int i = 0, k = 0; i < m; ++i) {
        for (int j = 0; j <= i; ++j, ++k) hessian[closure.turn[k]] -= length * bend(i, j);
        hessian[closure.by_length[i]] -= slope * pull[i];
      }
    }
  }

  FieldPlace position_, orientation_, length_;
  std::vector<Station> stations_;
  std::vector<StationLaw<m, sliding>> laws_;
  std::vector<Closure> closures_;
  std::vector<Edge> edges_;
  bool has_strain_ = false;
  int length_gradient_ = 0, length_hessian_ = 0;
};

}  // namespace bowstring::benchmarks
