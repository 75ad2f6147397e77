#include "core/assembly/euclidean.hpp"

#include <algorithm>
#include <cmath>

#include "core/lie/s2.hpp"
#include "core/model/manifold.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double quarter_turn = 1.57079632679489661923;

/// ∂δ/∂x of q = base·Exp(x) at x, row major.
void chart_jacobian(Manifold manifold, const double* x, double* out) {
  if (manifold == Manifold::rotation) {
    const Matrix3 j = lie::right_jacobian(Vector3{{x[0], x[1], x[2]}});
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) out[3 * a + b] = j(a, b);
    }
    return;
  }
  const Matrix2 j = lie::direction_chart(Vector2{{x[0], x[1]}});
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) out[2 * a + b] = j(a, b);
  }
}

/// Σ_a g_a ∂²δ_a/∂x², row major.
void chart_curvature(Manifold manifold, const double* x, const double* g, double* out) {
  if (manifold == Manifold::rotation) {
    const Matrix3 h = lie::exp_chart_curvature(Vector3{{x[0], x[1], x[2]}}, Vector3{{g[0], g[1], g[2]}});
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) out[3 * a + b] = h(a, b);
    }
    return;
  }
  const Matrix2 h = lie::direction_chart_curvature(Vector2{{x[0], x[1]}}, Vector2{{g[0], g[1]}});
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) out[2 * a + b] = h(a, b);
  }
}

}  // namespace

EuclideanChart::EuclideanChart(Assembly& assembly, Span<const double> base)
    : assembly_(assembly), base_(base.begin(), base.end()), q_(base_), x_(at(assembly.unknowns()), 0.0) {
  locate();
}

void EuclideanChart::locate() {
  const BlockLayout& blocks = assembly_.blocks();
  curved_of_block_.assign(at(blocks.blocks()), -1);
  for (const FieldEntry& entry : assembly_.entries()) {
    if (entry.block < 0 || !is_curved(entry.manifold)) continue;
    CurvedBlock curved;
    curved.manifold = entry.manifold;
    curved.block = entry.block;
    curved.first = blocks.begin[at(entry.block)];
    curved.size = blocks.size(entry.block);
    curved_of_block_[at(entry.block)] = static_cast<int>(curved_.size());
    curved_.push_back(curved);
  }
  const SparsityPattern rows = assembly_.jacobian_pattern();
  for (int k = 0; k < rows.entries();) {
    const int block = blocks.block_of_unknown[at(rows.inner[at(k)])];
    const int curved = curved_of_block_[at(block)];
    if (curved >= 0) runs_.push_back({k, curved});
    k += curved >= 0 ? curved_[at(curved)].size : 1;
  }
  for (const HessianPattern::Pair& pair : assembly_.hessian_blocks().pairs()) {
    if (curved_of_block_[at(pair.row)] >= 0 || curved_of_block_[at(pair.column)] >= 0) pairs_.push_back(pair);
  }
  gradient_.assign(at(assembly_.unknowns()), 0.0);
  jacobian_.assign(at(rows.entries()), 0.0);
}

void EuclideanChart::start(Span<double> x) const noexcept {
  for (const FieldEntry& entry : assembly_.entries()) {
    if (entry.block < 0) continue;
    const int tangents = tangent_count(entry.manifold, entry.dimension);
    for (int k = 0; k < tangents; ++k) {
      const int u = assembly_.free_of_unknown()[at(entry.unknown + k)];
      if (u >= 0) x[at(u)] = is_curved(entry.manifold) ? 0.0 : base_[at(entry.coordinate + k)];
    }
  }
}

void EuclideanChart::state(Span<const double> x, Span<double> q) const noexcept {
  std::copy(base_.begin(), base_.end(), q.begin());
  for (const FieldEntry& entry : assembly_.entries()) {
    if (entry.block < 0) continue;
    const int tangents = tangent_count(entry.manifold, entry.dimension);
    double local[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < tangents; ++k) {
      const int u = assembly_.free_of_unknown()[at(entry.unknown + k)];
      if (u < 0) continue;
      if (is_curved(entry.manifold)) {
        local[k] = x[at(u)];
      } else {
        q[at(entry.coordinate + k)] = x[at(u)];
      }
    }
    if (is_curved(entry.manifold)) {
      bowstring::retract(entry.manifold, entry.dimension, base_.data() + entry.coordinate, local,
                         q.data() + entry.coordinate);
    }
  }
}

void EuclideanChart::update(Span<const double> x) {
  if (has_x_ && std::equal(x.begin(), x.end(), x_.begin())) return;
  std::copy(x.begin(), x.end(), x_.begin());
  state(x, q_);
  for (CurvedBlock& curved : curved_) chart_jacobian(curved.manifold, x_.data() + curved.first, curved.jacobian);
  has_x_ = true;
}

Status EuclideanChart::evaluate(Span<const double> x, const ProblemEvaluation& evaluation) noexcept {
  update(x);
  if (Status status = assembly_.evaluate(q_, evaluation); !status.ok()) return status;
  if (!evaluation.gradient.empty()) {
    for (const CurvedBlock& curved : curved_) {
      double* g = evaluation.gradient.data() + curved.first;
      double pulled[3] = {0.0, 0.0, 0.0};
      for (int b = 0; b < curved.size; ++b) {
        for (int a = 0; a < curved.size; ++a) pulled[b] += g[a] * curved.jacobian[a * curved.size + b];
      }
      std::copy_n(pulled, curved.size, g);
    }
  }
  if (!evaluation.jacobian.empty()) {
    for (const Run& run : runs_) {
      const CurvedBlock& curved = curved_[at(run.curved)];
      double* g = evaluation.jacobian.data() + run.position;
      double pulled[3] = {0.0, 0.0, 0.0};
      for (int b = 0; b < curved.size; ++b) {
        for (int a = 0; a < curved.size; ++a) pulled[b] += g[a] * curved.jacobian[a * curved.size + b];
      }
      std::copy_n(pulled, curved.size, g);
    }
  }
  return {};
}

void EuclideanChart::pull_back_pair(const HessianPattern::Pair& pair, Span<double> values) const noexcept {
  const BlockLayout& blocks = assembly_.blocks();
  const HessianPattern& pattern = assembly_.hessian_blocks();
  const int rows = blocks.size(pair.row);
  const int columns = blocks.size(pair.column);
  const bool diagonal = pair.row == pair.column;
  int position[9];
  double h[9];
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      const int where = pattern.position(blocks, blocks.begin[at(pair.row)] + i, blocks.begin[at(pair.column)] + j);
      position[i * columns + j] = where;
      h[i * columns + j] = values[at(where)];
    }
  }
  const auto apply = [&](int curved_index, bool left) {
    if (curved_index < 0) return;
    const CurvedBlock& curved = curved_[at(curved_index)];
    const int n = curved.size;
    double out[9] = {};
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        double sum = 0.0;
        for (int a = 0; a < n; ++a) {
          sum +=
              left ? curved.jacobian[a * n + i] * h[a * columns + j] : h[i * columns + a] * curved.jacobian[a * n + j];
        }
        out[i * columns + j] = sum;
      }
    }
    std::copy_n(out, rows * columns, h);
  };
  apply(curved_of_block_[at(pair.row)], true);
  apply(curved_of_block_[at(pair.column)], false);
  if (diagonal) {
    const CurvedBlock& curved = curved_[at(curved_of_block_[at(pair.row)])];
    double bend[9];
    chart_curvature(curved.manifold, x_.data() + curved.first, gradient_.data() + curved.first, bend);
    for (int k = 0; k < rows * columns; ++k) h[k] += bend[k];
  }
  for (int j = 0; j < columns; ++j) {
    for (int i = diagonal ? j : 0; i < rows; ++i) values[at(position[i * columns + j])] = h[i * columns + j];
  }
}

Status EuclideanChart::lagrangian_hessian(Span<const double> x, double energy_factor, Span<const double> multipliers,
                                          Span<double> values) noexcept {
  update(x);
  ProblemEvaluation first_order;
  first_order.gradient = gradient_;
  first_order.jacobian = jacobian_;
  if (Status status = assembly_.evaluate(q_, first_order); !status.ok()) return status;
  for (double& g : gradient_) g *= energy_factor;
  const SparsityPattern rows = assembly_.jacobian_pattern();
  for (int r = 0; r < assembly_.rows(); ++r) {
    const double multiplier = multipliers[at(r)];
    for (int k = rows.begin[at(r)]; k < rows.begin[at(r) + 1]; ++k) {
      gradient_[at(rows.inner[at(k)])] += multiplier * jacobian_[at(k)];
    }
  }
  Status status = assembly_.lagrangian_hessian(q_, energy_factor, multipliers, values);
  if (!status.ok()) return status;
  for (const HessianPattern::Pair& pair : pairs_) pull_back_pair(pair, values);
  return {};
}

bool EuclideanChart::recentre_due(Span<const double> x) const noexcept {
  return std::any_of(curved_.begin(), curved_.end(), [&](const CurvedBlock& curved) {
    double squared = 0.0;
    for (int k = 0; k < curved.size; ++k) squared += x[at(curved.first + k)] * x[at(curved.first + k)];
    return squared > quarter_turn * quarter_turn;
  });
}

}  // namespace bowstring
