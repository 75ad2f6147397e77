#pragma once

#include <stdexcept>

#include "core/curve_kinematics/orientation.hpp"
#include "tests/benchmarks/hand_output.hpp"

namespace bowstring::benchmarks {

/// The law of that energy at that site; null where the scene has none.
inline const LawUse* find_law(const Scene& scene, const std::string& plugin, Site site) {
  for (const EnergyUse& energy : scene.energies) {
    for (const LawUse& law : energy.laws) {
      if (energy.plugin == plugin && law.description.site == site) return &law;
    }
  }
  return nullptr;
}

/// Of a station: ½ Σ_a stiffness_a (ζ_a/ds − rest_a)² ds. On a wire, which slides, ds = share·L and rest = 0.
template <int m, bool sliding>
struct StationLaw {
  double length = 0.0;  ///< ds, or ds/L
  double stiffness[m] = {};
  double rest[m] = {};
};

template <int m>
struct StationTerms {
  double energy = 0.0;
  Vector<m> force;                                ///< ∂E/∂ζ
  Vector<m> modulus;                              ///< ∂²E/∂ζ²
  double by_length = 0.0, by_length_twice = 0.0;  ///< ∂E/∂L, ∂²E/∂L²
  Vector<m> mixed;                                ///< ∂²E/∂ζ∂L
};

template <int m, bool sliding>
StationTerms<m> station_terms(const StationLaw<m, sliding>& law, const Vector<m>& strain, double length) {
  StationTerms<m> out;
  const double ds = sliding ? law.length * length : law.length;
  const double scale = 1.0 / ds;
  double twice = 0.0;
  for (int a = 0; a < m; ++a) {
    const double omega = sliding ? strain[a] * scale : strain[a] * scale - law.rest[a];
    out.force[a] = law.stiffness[a] * omega;
    out.modulus[a] = law.stiffness[a] * scale;
    if (sliding) out.mixed[a] = -law.length * out.force[a] * scale;
    twice += out.force[a] * omega;
  }
  out.energy = 0.5 * ds * twice;
  if (sliding) {
    out.by_length = -0.5 * law.length * twice;
    out.by_length_twice = law.length * law.length * twice * scale;
  }
  return out;
}

/// Sets what the law of the stations says, station by station. Answers whether there is one.
template <int m, bool sliding>
bool read_station_laws(const BenchScene& bench, const Curve& curve, const std::vector<double>& reference_strain,
                       std::vector<StationLaw<m, sliding>>& out) {
  const LawUse* law = find_law(*bench.scene, sliding ? "wire-bending" : "vessel-strain", Site::station);
  if (law == nullptr) return false;
  const SiteDeclaration& site = *curve.site(Site::station);
  for (int k = 0; k < site.count; ++k) {
    StationLaw<m, sliding> station;
    station.length = sliding ? site.ds[at(k)] / curve.view.start_length : site.ds[at(k)];
    for (int a = 0; a < m; ++a) {
      station.stiffness[a] = law->parameters[m == 3 && a == 0 ? 1 : 0][at(k)];
      station.rest[a] = sliding ? 0.0 : reference_strain[at(k * m + a)] / site.ds[at(k)];
    }
    out.push_back(station);
  }
  return true;
}

/// Sums over a sliding wire that belong to its length, written once at the end.
struct LengthSums {
  double gradient = 0.0, hessian = 0.0;
};

/// Springs from every node of the vessel to State 1, ½ k |p − p⁰|² ds.
template <int d>
class HandAnchoring {
 public:
  HandAnchoring(const BenchScene& bench, const Positions& positions) {
    const LawUse* law = find_law(*bench.scene, "anchoring", Site::node);
    if (law == nullptr) return;
    const Curve& curve = bench.vessel();
    const SiteDeclaration& site = *curve.site(Site::node);
    const FieldPlace place = field_place(curve, "position");
    first_ = place.coordinate;
    for (int i = 0; i < site.count; ++i) {
      Spring spring;
      spring.stiffness = law->parameters[0][at(i)] * site.ds[at(i)];
      for (int k = 0; k < d; ++k) {
        const int unknown = place.unknown + i * d + k;
        spring.rest[k] = curve.reference[at(i * d + k)];
        spring.gradient[k] = positions.gradient(unknown);
        spring.hessian[k] = positions.hessian(unknown, unknown);
      }
      springs_.push_back(spring);
    }
  }

  void add(const double* q, double factor, HandOutput& out) const {
    const double* p = q + first_;
    double* gradient = out.gradient.data();
    double* hessian = out.hessian.data();
    double twice = 0.0;
    for (const Spring& spring : springs_) {
      for (int k = 0; k < d; ++k) {
        const double u = p[k] - spring.rest[k];
        twice += spring.stiffness * u * u;
        gradient[spring.gradient[k]] += spring.stiffness * u;
        hessian[spring.hessian[k]] += factor * spring.stiffness;
      }
      p += d;
    }
    out.energy += 0.5 * twice;
  }

 private:
  struct Spring {
    double stiffness = 0.0, rest[d] = {};
    int gradient[d] = {}, hessian[d] = {};
  };
  int first_ = 0;
  std::vector<Spring> springs_;
};

/// T (L − chord).
class HandTension {
 public:
  HandTension(const BenchScene& bench, const Positions& positions) {
    const LawUse* law = find_law(*bench.scene, "axial-tension", Site::length);
    if (law == nullptr) return;
    const FieldPlace place = field_place(bench.wire(), "length");
    coordinate_ = place.coordinate;
    gradient_ = positions.gradient(place.unknown);
    tension_ = law->parameters[0][0];
    chord_ = bench.wire().view.end_distance;
  }

  void add(const double* q, HandOutput& out) const {
    if (coordinate_ < 0) return;
    out.energy += tension_ * (q[coordinate_] - chord_);
    out.gradient[at(gradient_)] += tension_;
  }

 private:
  int coordinate_ = -1, gradient_ = 0;
  double tension_ = 0.0, chord_ = 0.0;
};

}  // namespace bowstring::benchmarks
