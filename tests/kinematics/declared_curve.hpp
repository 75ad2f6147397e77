#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/model/manifold.hpp"
#include "tests/kinematics/test_curve.hpp"

namespace bowstring::testing {

/// A curve with its kinematics and their declaration, as the kernel would hold them.
template <class SomeKinematics>
struct DeclaredCurve {
  TestCurve curve;
  SomeKinematics kinematics{ParameterSet{}};
  KinematicsDeclaration declaration;

  explicit DeclaredCurve(TestCurve test_curve, const Needs& needs = {}) : curve(std::move(test_curve)) {
    const Status status = kinematics.declare(curve.view(), needs, declaration);
    REQUIRE_MESSAGE(status.ok(), status.text);
  }

  bool has(Site which) const {
    return std::any_of(declaration.sites.begin(), declaration.sites.end(),
                       [&](const SiteDeclaration& site) { return site.site == which; });
  }
  const SiteDeclaration& site(Site which) const {
    for (const SiteDeclaration& site : declaration.sites) {
      if (site.site == which) return site;
    }
    FAIL("the site is not declared");
    return declaration.sites.front();
  }
  bool has_field(const std::string& name) const {
    return std::any_of(declaration.fields.begin(), declaration.fields.end(),
                       [&](const FieldDeclaration& field) { return field.name == name; });
  }
  const FieldDeclaration& field(const std::string& name) const {
    for (const FieldDeclaration& field : declaration.fields) {
      if (field.name == name) return field;
    }
    FAIL("the field is not declared");
    return declaration.fields.front();
  }

  int unknowns() const {
    int sum = 0;
    for (const FieldDeclaration& f : declaration.fields) sum += f.count * tangent_count(f.manifold, f.dimension);
    return sum;
  }
  std::vector<double> start() const {
    std::vector<double> q;
    for (const FieldDeclaration& f : declaration.fields) q.insert(q.end(), f.start.begin(), f.start.end());
    return q;
  }
  std::vector<double> reference() const {
    std::vector<double> q;
    for (const FieldDeclaration& f : declaration.fields) q.insert(q.end(), f.reference.begin(), f.reference.end());
    return q;
  }
  int coordinate_begin(const std::string& name) const {
    int begin = 0;
    for (const FieldDeclaration& f : declaration.fields) {
      if (f.name == name) return begin;
      begin += f.count * coordinate_count(f.manifold, f.dimension);
    }
    FAIL("the field is not declared");
    return -1;
  }
  std::vector<char> fixed() const {
    std::vector<char> flags;
    for (const FieldDeclaration& f : declaration.fields) {
      const std::size_t numbers = at(f.count * tangent_count(f.manifold, f.dimension));
      REQUIRE((f.fixed.empty() || f.fixed.size() == numbers));
      std::vector<char> own = f.fixed;
      own.resize(numbers, 0);
      flags.insert(flags.end(), own.begin(), own.end());
    }
    return flags;
  }

  std::vector<double> retract(std::vector<double> q, const std::vector<double>& delta) const {
    double* coordinates = q.data();
    const double* tangent = delta.data();
    for (const FieldDeclaration& f : declaration.fields) {
      for (int i = 0; i < f.count; ++i) {
        bowstring::retract(f.manifold, f.dimension, coordinates, tangent, coordinates);
        coordinates += coordinate_count(f.manifold, f.dimension);
        tangent += tangent_count(f.manifold, f.dimension);
      }
    }
    return q;
  }
  std::vector<double> moved(const std::vector<double>& q, int unknown, double step) const {
    std::vector<double> delta(at(unknowns()), 0.0);
    delta[at(unknown)] = step;
    return retract(q, delta);
  }

  std::vector<double> values(Site which, const std::vector<double>& q) const {
    const SiteDeclaration& s = site(which);
    std::vector<double> out(at(s.count * s.values), 1e300);
    SiteEvaluation evaluation{which, q, out, {}, {}, {}};
    require(kinematics.evaluate(evaluation));
    return out;
  }
  /// (count · values) × unknowns.
  std::vector<double> jacobian(Site which, const std::vector<double>& q) const {
    const SiteDeclaration& s = site(which);
    std::vector<double> local(at(s.count * s.values * s.width), 1e300);
    SiteEvaluation evaluation{which, q, {}, local, {}, {}};
    require(kinematics.evaluate(evaluation));
    std::vector<double> out(at(s.count * s.values * unknowns()), 0.0);
    for (int r = 0; r < s.count * s.values; ++r) {
      for (int j = 0; j < s.width; ++j) {
        const int unknown = s.stencil[at(r / s.values * s.width + j)];
        if (unknown >= 0) out[at(r * unknowns() + unknown)] += local[at(r * s.width + j)];
      }
    }
    return out;
  }
  /// unknowns × unknowns: Σ stress ∂²y/∂δ² over all places.
  std::vector<double> curvature(Site which, const std::vector<double>& q, const std::vector<double>& stress) const {
    const SiteDeclaration& s = site(which);
    const int packed = packed_size(s.bent());
    std::vector<double> local(at(s.count * packed), 1e300);
    SiteEvaluation evaluation{which, q, {}, {}, stress, local};
    require(kinematics.evaluate(evaluation));
    const int n = unknowns();
    std::vector<double> out(at(n * n), 0.0);
    for (int place = 0; place < s.count; ++place) {
      const int* stencil = s.stencil.data() + place * s.width + s.bent_first;
      for (int i = 0; i < s.bent(); ++i) {
        for (int j = 0; j <= i; ++j) {
          if (stencil[i] < 0 || stencil[j] < 0) continue;
          const double entry = local[at(place * packed + packed_index(i, j))];
          out[at(stencil[i] * n + stencil[j])] += entry;
          if (i != j) out[at(stencil[j] * n + stencil[i])] += entry;
        }
      }
    }
    return out;
  }

 private:
  static void require(const Status& status) { REQUIRE_MESSAGE(status.ok(), status.text); }
};

}  // namespace bowstring::testing
