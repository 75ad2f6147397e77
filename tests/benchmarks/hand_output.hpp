#pragma once

#include <algorithm>
#include <vector>

#include "core/interfaces/place.hpp"
#include "core/lie/small_matrix.hpp"
#include "tests/benchmarks/bench_scene.hpp"

namespace bowstring::benchmarks {

/// What one assembly gives. Arrays have one number more than the patterns: what belongs to fixed unknowns goes there,
/// so that no loop asks.
struct HandOutput {
  explicit HandOutput(const Assembly& assembly)
      : gradient(at(assembly.unknowns()) + 1),
        rows(at(assembly.rows())),
        jacobian(at(assembly.jacobian_pattern().entries()) + 1),
        hessian(at(assembly.hessian_pattern().entries()) + 1) {}

  void clear() {
    energy = 0.0;
    std::fill(gradient.begin(), gradient.end(), 0.0);
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    std::fill(hessian.begin(), hessian.end(), 0.0);
  }

  double energy = 0.0;
  std::vector<double> gradient, rows, jacobian, hessian;
};

/// Where scene-wide tangent numbers stand in the gradient and pairs of them in the compressed arrays.
class Positions {
 public:
  explicit Positions(const Assembly& assembly) : assembly_(assembly) {}

  int gradient(int unknown) const {
    const int free = unknown < 0 ? -1 : assembly_.free_of_unknown()[at(unknown)];
    return free < 0 ? assembly_.unknowns() : free;
  }
  int jacobian(int row, int unknown) const { return find(assembly_.jacobian_pattern(), row, gradient(unknown)); }
  int hessian(int a, int b) const {
    const int first = gradient(a), second = gradient(b);
    if (first == assembly_.unknowns() || second == assembly_.unknowns()) return assembly_.hessian_pattern().entries();
    return find(assembly_.hessian_pattern(), std::min(first, second), std::max(first, second));
  }

 private:
  int find(const SparsityPattern& pattern, int outer, int inner) const {
    if (inner == assembly_.unknowns()) return pattern.entries();
    const int* begin = pattern.inner.data() + pattern.begin[at(outer)];
    const int* end = pattern.inner.data() + pattern.begin[at(outer) + 1];
    return static_cast<int>(std::lower_bound(begin, end, inner) - pattern.inner.data());
  }

  const Assembly& assembly_;
};

/// Positions of one element with n unknowns: of its gradient and of its packed lower triangle.
template <int n>
struct ElementMap {
  int gradient[n];
  int hessian[packed_size(n)];

  ElementMap() = default;
  ElementMap(const Positions& positions, const int (&unknown)[n]) {
    for (int i = 0, k = 0; i < n; ++i) {
      gradient[i] = positions.gradient(unknown[i]);
      for (int j = 0; j <= i; ++j, ++k) hessian[k] = positions.hessian(unknown[i], unknown[j]);
    }
  }

  void add_gradient(const Vector<n>& g, double* out) const {
    for (int i = 0; i < n; ++i) out[gradient[i]] += g[i];
  }
  /// The lower triangle of h.
  void add_hessian(const Matrix<n, n>& h, double* out) const {
    for (int i = 0, k = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j, ++k) out[hessian[k]] += h(i, j);
    }
  }
};

/// n unknowns of the entry `index` of a field.
template <int n>
void set_unknowns(int first, int index, int* out) {
  for (int k = 0; k < n; ++k) out[k] = first + index * n + k;
}

}  // namespace bowstring::benchmarks
