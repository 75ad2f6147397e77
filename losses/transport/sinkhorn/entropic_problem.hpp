#pragma once

#include <cstddef>

#include <Eigen/Dense>

namespace bowstring::sinkhorn {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Limits {
  double tolerance = 1e-9;  ///< of the marginals: the sum of their absolute errors, of a mass of 1
  long most_iterations = 10000;
};

/// min over plans P of ⟨C, P⟩ + ε KL(P | a bᵀ) between weights that sum to 1, by scaling (M. Cuturi, NIPS (2013)) in
/// the form that small ε do not break: the plan is a_i b_j exp((f_i + g_j − c_ij)/ε), the exponentials are kept as a
/// kernel around potentials f, g, and what scaling adds to them is absorbed before it overflows (B. Schmitzer, SIAM J.
/// Sci. Comput. 41 (2019) A1443). Places without weight have potentials too.
class EntropicProblem {
 public:
  /// Throws StatusError with `unsupported` where a pair is forbidden.
  EntropicProblem(Matrix cost, Vector a, Vector b);

  /// From potentials 0, through a falling ladder of ε; a `warm` one starts from `f` and `g` at the last ε.
  void solve(double epsilon, const Limits& limits, bool warm);
  /// The same of a measure to itself, whose potentials are one: f ← (f + T f)/2 needs few iterations (J. Feydy et al.,
  /// AISTATS (2019)).
  void solve_symmetric(double epsilon, const Limits& limits);

  Vector f, g;
  double marginal_error = 0.0;  ///< Σ |row sums of P − a|, with exact sums of columns
  long iterations = 0;

  Matrix plan() const;
  /// Σ f a + Σ g b − ε (Σ P − 1): never above the minimum, and equal to it at the best potentials.
  double dual_value(const Matrix& plan) const;
  /// The objective at the plan of `rounded`.
  double primal_value(const Matrix& plan) const;
  double transport_cost(const Matrix& plan) const;
  std::size_t memory_bytes() const noexcept;

 private:
  void scale(double tolerance, long last);
  void descend(double epsilon, double tolerance, long most_iterations);
  void update_in_logarithms();
  void make_kernel();
  bool newton_step();

  Matrix cost_, kernel_;
  Vector a_, b_;
  double epsilon_ = 0.0;
};

/// A plan with the right sums near one that almost has them: rows and columns that are too heavy are scaled down, what
/// is missing is spread as a product (J. Altschuler, J. Weed, P. Rigollet, NIPS (2017), algorithm 2).
Matrix rounded(Matrix plan, const Vector& a, const Vector& b);

}  // namespace bowstring::sinkhorn
