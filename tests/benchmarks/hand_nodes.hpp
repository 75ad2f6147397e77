#pragma once

#include "tests/benchmarks/hand_curve.hpp"

namespace bowstring::benchmarks {

/// A curve whose edges' orientations follow their nodes (kinematics/nodes/README.md has the formulas): stations between
/// neighbouring edges, in the unknowns x = (e, φ) of both edges first, then at the nodes. A wire slides and has rows
/// |e_i| − share_i L; a vessel stretches. In space a vessel has material frames, a wire has none.
template <Manifold manifold, bool sliding>
class HandNodes {
  static constexpr int d = Orientation<manifold>::dimension, m = Orientation<manifold>::components;
  static constexpr int angles = manifold == Manifold::rotation ? 1 : 0;
  static constexpr int n = d + angles;              // unknowns of one edge
  static constexpr int width = 3 * d + 2 * angles;  // of a station: three nodes, then the angles of both edges

  struct Edge {
    Vector<d> tangent;
    double length = 0.0;
    lie::Rotation frame;   // in space
    Matrix<m, n> turn;     // ∂α/∂x
    Vector<d> twist_rate;  // with material frames
  };

 public:
  HandNodes(const BenchScene& bench, const Curve& curve, const Positions& positions, int& row)
      : edges_(curve.view.nodes - 1), position_(field_place(curve, "position")), angle_(field_place(curve, "angle")) {
    const FieldPlace length = field_place(curve, "length");
    const std::vector<double> reference = bench.scene->reference_coordinates();
    if (sliding) {
      length_ = length.coordinate;
      length_gradient_ = positions.gradient(length.unknown);
      length_hessian_ = positions.hessian(length.unknown, length.unknown);
    }
    if constexpr (angles != 0) {
      // State 1's frames: any at the first edge, parallel along the others.
      for (int i = 0; i < edges_; ++i) {
        const double* p = reference.data() + position_.coordinate + i * d;
        const Vector<d> t = normalized(Vector<d>::load(p + d) - Vector<d>::load(p));
        reference_.push_back(i == 0 ? lie::frame_from_tangent(t) : lie::transport(reference_.back(), t));
      }
    }
    clamped_ = curve.view.end[0].rotation_held;
    if constexpr (d == 3) {
      if (clamped_) held_ = lie::Rotation::load(reference.data() + field_place(curve, "held-tangent").coordinate);
    }
    for (int k = clamped_ ? -1 : 0; k + 1 < edges_; ++k) add_station(k, length.unknown, positions);
    std::vector<double> strain;
    for_stations(reference.data(), [&](int, const Edge& earlier, const Edge& later) {
      const auto value = strain_between(earlier, later).value;
      strain.insert(strain.end(), value.data.begin(), value.data.end());
    });
    has_strain_ = read_station_laws(bench, curve, strain, laws_);

    stretch_ = sliding ? nullptr : find_law(*bench.scene, "vessel-strain", Site::edge);
    for (int i = 0; i < edges_; ++i) add_measure(curve, i, row, length.unknown, positions);
    if (sliding) row += edges_;
  }

  void add(const double* q, double factor, const double* multipliers, HandOutput& out) const {
    const double length = sliding ? q[length_] : 0.0;
    if (has_strain_) add_strain(q, length, factor, out);
    if (sliding) add_rows(q, length, multipliers, out);
    if (stretch_ != nullptr) add_stretch(q, factor, out);
  }

 private:
  struct Station {
    ElementMap<width> map;
    int by_length[width] = {};
  };
  struct Measure {
    double share = 0.0, stiffness = 0.0;  // ℓ = share·L; or EA, and share the reciprocal of the rest length
    int row = 0;
    int jacobian[2 * d + 1] = {};
    ElementMap<2 * d> map;
  };

  /// Station k lies between edges k and k + 1; −1 before the first edge.
  void add_station(int k, int length, const Positions& positions) {
    int unknown[width];
    for (int i = 0; i < 3 * d; ++i) unknown[i] = k < 0 && i < d ? -1 : position_.unknown + k * d + i;
    for (int i = 0; i < 2 * angles; ++i) unknown[3 * d + i] = k < 0 && i == 0 ? -1 : angle_.unknown + k + i;
    Station station;
    station.map = ElementMap<width>(positions, unknown);
    for (int i = 0; sliding && i < width; ++i) station.by_length[i] = positions.hessian(length, unknown[i]);
    stations_.push_back(station);
  }

  void add_measure(const Curve& curve, int edge, int row, int length, const Positions& positions) {
    int unknown[2 * d];
    for (int i = 0; i < 2 * d; ++i) unknown[i] = position_.unknown + edge * d + i;
    Measure measure;
    measure.map = ElementMap<2 * d>(positions, unknown);
    measure.share = sliding ? curve.fraction[at(edge)] : 1.0 / curve.edge_length[at(edge)];
    if (stretch_ != nullptr) measure.stiffness = stretch_->parameters[0][at(edge)];
    measure.row = row + edge;
    for (int i = 0; sliding && i < 2 * d; ++i) measure.jacobian[i] = positions.jacobian(measure.row, unknown[i]);
    if (sliding) measure.jacobian[2 * d] = positions.jacobian(measure.row, length);
    measures_.push_back(measure);
  }

  Edge load(const double* q, int index) const {
    Edge edge;
    const double* p = q + position_.coordinate + index * d;
    const Vector<d> vector = Vector<d>::load(p + d) - Vector<d>::load(p);
    edge.length = norm(vector);
    const double scale = 1.0 / edge.length;
    edge.tangent = vector * scale;
    const Vector<d>& t = edge.tangent;
    if constexpr (d == 2) {
      edge.turn(0, 0) = -t[1] * scale;
      edge.turn(0, 1) = t[0] * scale;
    } else {
      if constexpr (angles == 0) {
        edge.frame = lie::frame_from_tangent(t);
      } else {
        const double angle = q[angle_.coordinate + index], half = 0.5 * angle;
        const lie::Rotation& reference = reference_[at(index)];
        edge.frame = lie::transport(reference, t) * lie::Rotation{std::cos(half), std::sin(half), 0.0, 0.0};
        const Vector3 a = reference.first_axis();
        const double cosine = dot(a, t), by = scale / (1.0 + cosine);
        const Vector3 twist = cross(t, a) * by;
        for (int k = 0; k < 3; ++k) edge.turn(0, k) = twist[k];
        edge.turn(0, 3) = 1.0;
        edge.twist_rate = ((2.0 + cosine) * t + a) * by;
      }
      const Matrix3 r = edge.frame.matrix();
      for (int k = 0; k < 3; ++k) {
        edge.turn(m - 2, k) = -r(k, 2) * scale;
        edge.turn(m - 1, k) = r(k, 1) * scale;
      }
    }
    return edge;
  }

  /// A held tangent as an edge that does not turn.
  Edge held() const {
    Edge edge;
    edge.frame = held_;
    edge.length = 1.0;
    if constexpr (d == 3) edge.tangent = held_.first_axis();
    return edge;
  }

  template <class Use>
  void for_stations(const double* q, const Use& use) const {
    Edge earlier = load(q, 0);
    int k = 0;
    if (clamped_) use(k++, held(), earlier);
    for (int i = 1; i < edges_; ++i) {
      const Edge later = load(q, i);
      use(k++, earlier, later);
      earlier = later;
    }
  }

  static StationStrain<manifold> strain_between(const Edge& earlier, const Edge& later) {
    if constexpr (d == 2) {
      return {{{std::atan2(cross(earlier.tangent, later.tangent), dot(earlier.tangent, later.tangent))}}};
    } else {
      return station_strain(Orientation<manifold>{earlier.frame}, Orientation<manifold>{later.frame});
    }
  }

  /// g·∂²α/∂x² of one edge.
  static Matrix<n, n> turn_curvature(const Edge& edge, const Vector<m>& g) {
    constexpr int across = m - (d - 1);
    Vector<n> t, v;
    for (int k = 0; k < d; ++k) {
      t[k] = edge.tangent[k] / edge.length;
      for (int i = across; i < m; ++i) v[k] += g[i] * edge.turn(i, k);
    }
    Matrix<n, n> out;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) out(i, j) = -t[i] * v[j] - t[j] * v[i];
    }
    if constexpr (angles != 0) {
      Vector<n> w, along, rate, s;
      for (int k = 0; k < n; ++k) {
        w[k] = 0.5 * edge.turn(0, k);
        s[k] = g[1] * edge.turn(2, k) - g[2] * edge.turn(1, k);
        if (k < d) along[k] = g[0] * w[k], rate[k] = edge.twist_rate[k];
      }
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j <= i; ++j) out(i, j) += w[i] * s[j] + w[j] * s[i] - along[i] * rate[j] - along[j] * rate[i];
      }
    }
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) out(j, i) = out(i, j);
    }
    return out;
  }

  /// Over the edges' unknowns → over the station's.
  static Vector<width> at_nodes(const Vector<n>& first, const Vector<n>& second) {
    Vector<width> out;
    for (int k = 0; k < d; ++k) {
      out[k] = -first[k];
      out[d + k] = first[k] - second[k];
      out[2 * d + k] = second[k];
    }
    if constexpr (angles != 0) out[3 * d] = first[d], out[3 * d + 1] = second[d];
    return out;
  }

  /// The lower triangle.
  static Matrix<width, width> at_nodes(const Matrix<n, n>& first, const Matrix<n, n>& mixed,
                                       const Matrix<n, n>& second) {
    Matrix<width, width> out;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) {
        out(i, j) = first(i, j);
        out(d + i, j) = mixed(i, j) - first(i, j);
        out(2 * d + i, j) = -mixed(i, j);
        out(d + i, d + j) = first(i, j) - mixed(i, j) - mixed(j, i) + second(i, j);
        out(2 * d + i, d + j) = mixed(i, j) - second(i, j);
        out(2 * d + i, 2 * d + j) = second(i, j);
      }
    }
    if constexpr (angles != 0) {
      for (int j = 0; j < d; ++j) {
        out(3 * d, j) = -first(d, j);
        out(3 * d, d + j) = first(d, j) - mixed(j, d);
        out(3 * d, 2 * d + j) = mixed(j, d);
        out(3 * d + 1, j) = -mixed(d, j);
        out(3 * d + 1, d + j) = mixed(d, j) - second(d, j);
        out(3 * d + 1, 2 * d + j) = second(d, j);
      }
      out(3 * d, 3 * d) = first(d, d);
      out(3 * d + 1, 3 * d) = mixed(d, d);
      out(3 * d + 1, 3 * d + 1) = second(d, d);
    }
    return out;
  }

  void add_strain(const double* q, double length, double factor, HandOutput& out) const {
    double energy = 0.0;
    LengthSums sums;
    for_stations(q, [&](int k, const Edge& earlier, const Edge& later) {
      const Station& station = stations_[at(k)];
      const StationStrain<manifold> strain = strain_between(earlier, later);
      const StationTerms<m> law = station_terms(laws_[at(k)], strain.value, length);
      energy += law.energy;
      // Over the tangent numbers of both orientations first: there the matrices are smallest.
      const Vector<m> pull = strain.by_a.transpose() * law.force;
      const Vector<m> push = strain.by_b.transpose() * law.force;
      Matrix<m, m> ca = strain.by_a, cb = strain.by_b;
      for (int a = 0; a < m; ++a) {
        for (int j = 0; j < m; ++j) ca(a, j) *= law.modulus[a], cb(a, j) *= law.modulus[a];
      }
      Matrix<m, m> first = strain.by_a.transpose() * ca;
      Matrix<m, m> mixed = strain.by_b.transpose() * ca;
      Matrix<m, m> second = strain.by_b.transpose() * cb;
      if constexpr (d == 3) {
        const Matrix<2 * m, 2 * m> bend = station_curvature(strain, law.force);
        first += bend.template block<m, m>(0, 0);
        mixed += bend.template block<m, m>(m, 0);
        second += bend.template block<m, m>(m, m);
      }
      const Matrix<n, m> first_turn = earlier.turn.transpose(), second_turn = later.turn.transpose();
      station.map.add_gradient(at_nodes(first_turn * pull, second_turn * push), out.gradient.data());
      station.map.add_hessian(factor * at_nodes(first_turn * (first * earlier.turn) + turn_curvature(earlier, pull),
                                                second_turn * (mixed * earlier.turn),
                                                second_turn * (second * later.turn) + turn_curvature(later, push)),
                              out.hessian.data());
      if constexpr (sliding) {
        sums.gradient += law.by_length;
        sums.hessian += law.by_length_twice;
        const Vector<width> by_length = at_nodes(first_turn * (strain.by_a.transpose() * law.mixed),
                                                 second_turn * (strain.by_b.transpose() * law.mixed));
        for (int i = 0; i < width; ++i) out.hessian[at(station.by_length[i])] += factor * by_length[i];
      }
    });
    out.energy += energy;
    if (!sliding) return;
    out.gradient[at(length_gradient_)] += sums.gradient;
    out.hessian[at(length_hessian_)] += factor * sums.hessian;
  }

  /// Adds along·t tᵀ + across·(I − t tᵀ) over an edge's nodes.
  static void add_edge_hessian(const Measure& measure, const Vector<d>& t, double along, double across, double* out) {
    Matrix<2 * d, 2 * d> h;
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) {
        const double entry = (along - across) * t[i] * t[j] + (i == j ? across : 0.0);
        h(i, j) = h(d + i, d + j) = entry;
        h(d + i, j) = -entry;
      }
    }
    measure.map.add_hessian(h, out);
  }

  void add_rows(const double* q, double unknown_length, const double* multipliers, HandOutput& out) const {
    const double* p = q + position_.coordinate;
    for (const Measure& measure : measures_) {
      const Vector<d> vector = Vector<d>::load(p + d) - Vector<d>::load(p);
      const double length = norm(vector), scale = 1.0 / length;
      const Vector<d> t = vector * scale;
      p += d;
      out.rows[at(measure.row)] = length - measure.share * unknown_length;
      for (int k = 0; k < d; ++k) {
        out.jacobian[at(measure.jacobian[k])] = -t[k];
        out.jacobian[at(measure.jacobian[d + k])] = t[k];
      }
      out.jacobian[at(measure.jacobian[2 * d])] = -measure.share;
      add_edge_hessian(measure, t, 0.0, multipliers[measure.row] * scale, out.hessian.data());
    }
  }

  void add_stretch(const double* q, double factor, HandOutput& out) const {
    const double* p = q + position_.coordinate;
    double energy = 0.0;
    for (const Measure& measure : measures_) {
      const Vector<d> vector = Vector<d>::load(p + d) - Vector<d>::load(p);
      const double length = norm(vector), scale = 1.0 / length;
      const Vector<d> t = vector * scale;
      p += d;
      const double extension = length * measure.share - 1.0;
      const double force = measure.stiffness * extension;
      energy += 0.5 * force * extension / measure.share;
      for (int k = 0; k < d; ++k) {
        out.gradient[at(measure.map.gradient[k])] -= force * t[k];
        out.gradient[at(measure.map.gradient[d + k])] += force * t[k];
      }
      add_edge_hessian(measure, t, factor * measure.stiffness * measure.share, factor * force * scale,
                       out.hessian.data());
    }
    out.energy += energy;
  }

  int edges_ = 0;
  FieldPlace position_, angle_;
  int length_ = -1, length_gradient_ = 0, length_hessian_ = 0;
  bool clamped_ = false, has_strain_ = false;
  lie::Rotation held_;
  std::vector<lie::Rotation> reference_;
  std::vector<Station> stations_;
  std::vector<StationLaw<m, sliding>> laws_;
  const LawUse* stretch_ = nullptr;
  std::vector<Measure> measures_;
};

}  // namespace bowstring::benchmarks
