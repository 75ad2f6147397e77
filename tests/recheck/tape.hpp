#pragma once

#include <cmath>
#include <vector>

namespace recheck {

class Tape;

/// A number that remembers how it was computed from the unknowns; a plain double is a constant.
struct Variable {
  double value = 0.0;
  int record = -1;  ///< −1: a constant
  Tape* tape = nullptr;

  Variable() = default;
  Variable(double constant) : value(constant) {}  // NOLINT: numbers are constants wherever one stands in a formula
  Variable(double v, int r, Tape* t) : value(v), record(r), tape(t) {}
};

/// Reverse accumulation of one local term (A. Griewank and A. Walther, Evaluating Derivatives, 2008, chapter 3). It is
/// cleared for the next term, so that memory does not grow with the mesh.
class Tape {
 public:
  /// An unknown; `slot` is its place in the gradient, negative for a constant.
  Variable input(double value, int slot) {
    if (slot < 0) return value;
    inputs_.push_back({static_cast<int>(records_.size()), slot});
    return push(value, {});
  }

  Variable unary(double value, const Variable& a, double slope) {
    if (a.record < 0) return value;
    return push(value, {{a.record, -1}, {slope, 0.0}});
  }

  static Variable binary(double value, const Variable& a, double slope_a, const Variable& b, double slope_b) {
    Tape* tape = a.record >= 0 ? a.tape : b.tape;
    if (a.record < 0 && b.record < 0) return value;
    return tape->push(value, {{a.record, b.record}, {slope_a, slope_b}});
  }

  /// Adds weight · ∂result/∂slot to the gradient at the slot of every input.
  void add_gradient(const Variable& result, double weight, std::vector<double>& gradient) {
    if (result.record < 0) return;
    adjoint_.assign(records_.size(), 0.0);
    adjoint_[static_cast<std::size_t>(result.record)] = weight;
    for (std::size_t r = static_cast<std::size_t>(result.record) + 1; r-- > 0;) {
      for (int k = 0; k < 2; ++k) {
        const int parent = records_[r].parent[k];
        if (parent >= 0) adjoint_[static_cast<std::size_t>(parent)] += records_[r].slope[k] * adjoint_[r];
      }
    }
    for (const Input& in : inputs_) {
      gradient[static_cast<std::size_t>(in.slot)] += adjoint_[static_cast<std::size_t>(in.record)];
    }
  }

  void clear() {
    records_.clear();
    inputs_.clear();
  }

 private:
  struct Record {
    int parent[2] = {-1, -1};
    double slope[2] = {0.0, 0.0};
  };
  struct Input {
    int record, slot;
  };

  Variable push(double value, const Record& record) {
    records_.push_back(record);
    return {value, static_cast<int>(records_.size()) - 1, this};
  }

  std::vector<Record> records_;
  std::vector<Input> inputs_;
  std::vector<double> adjoint_;
};

inline Variable operator+(const Variable& a, const Variable& b) {
  return Tape::binary(a.value + b.value, a, 1.0, b, 1.0);
}
inline Variable operator-(const Variable& a, const Variable& b) {
  return Tape::binary(a.value - b.value, a, 1.0, b, -1.0);
}
inline Variable operator*(const Variable& a, const Variable& b) {
  return Tape::binary(a.value * b.value, a, b.value, b, a.value);
}
inline Variable operator/(const Variable& a, const Variable& b) {
  const double quotient = a.value / b.value;
  return Tape::binary(quotient, a, 1.0 / b.value, b, -quotient / b.value);
}
inline Variable operator-(const Variable& a) { return 0.0 - a; }
inline Variable sqrt(const Variable& a) {
  const double root = std::sqrt(a.value);
  return a.record < 0 ? Variable(root) : a.tape->unary(root, a, 0.5 / root);
}
inline Variable sin(const Variable& a) {
  return a.record < 0 ? Variable(std::sin(a.value)) : a.tape->unary(std::sin(a.value), a, std::cos(a.value));
}
inline Variable cos(const Variable& a) {
  return a.record < 0 ? Variable(std::cos(a.value)) : a.tape->unary(std::cos(a.value), a, -std::sin(a.value));
}
inline Variable atan2(const Variable& y, const Variable& x) {
  const double squared = x.value * x.value + y.value * y.value;
  return Tape::binary(std::atan2(y.value, x.value), y, x.value / squared, x, -y.value / squared);
}

inline double value_of(double a) { return a; }
inline double value_of(const Variable& a) { return a.value; }

}  // namespace recheck
