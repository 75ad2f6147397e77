#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include "core/interfaces/law.hpp"
#include "core/interfaces/span.hpp"
#include "plugins/sdk/guard.hpp"
#include "plugins/sdk/jet.hpp"

namespace bowstring {

/// What a templated law reads at one place. T is double where only the energy is wanted, otherwise a Jet.
template <class T>
struct LawPoint {
  Span<const T> x;               ///< strain, stretch ratio, position or length: 1, 2 or 3 numbers
  Span<const double> reference;  ///< x in State 1
  Span<const T> parameter;       ///< in the order of the description
};

/// A Law from its energy W(x, p) alone, as one templated function; every derivative follows by `Jet`. It works for
/// one, two and three numbers. A material that stiffens as it bends, W = ½ EI κ² (1 + β κ²):
///
///   struct Stiffening {
///     LawDescription describe() const {
///       LawDescription description;
///       description.parameters = {"bending-stiffness", "stiffening"};
///       return description;
///     }
///     template <class T>
///     T energy(const LawPoint<T>& place) const {
///       T squared = 0.0;
///       for (const T& kappa : place.x) squared += kappa * kappa;
///       return 0.5 * place.parameter[0] * squared * (1.0 + place.parameter[1] * squared);
///     }
///   };
///
///   TemplatedLaw<Stiffening> law_;   // in the Energy, whose `declare` gives out &law_ and law_.description()
///
/// Functions of numbers are called without a namespace after `using std::sqrt;`, so that both double and Jet find
/// theirs. The description is asked once, when the law is made.
template <class Author>
class TemplatedLaw final : public Law {
 public:
  static constexpr std::size_t most_parameters = 16;

  /// Throws a StatusError for a description with more than `most_parameters` parameters.
  explicit TemplatedLaw(Author author = Author()) : author_(std::move(author)), description_(author_.describe()) {
    if (description_.parameters.size() > most_parameters) {
      throw StatusError(Code::unsupported, "a templated law takes at most " + std::to_string(most_parameters) +
                                               " parameters, this one describes " +
                                               std::to_string(description_.parameters.size()));
    }
  }

  const LawDescription& description() const noexcept { return description_; }
  bool has_parameter_derivatives() const noexcept override { return true; }

  Status evaluate(const LawBatch& batch) const noexcept override {
    return guard([&]() -> Status {
      switch (batch.dimension) {
        case 1:
          evaluate_places<1>(batch);
          return {};
        case 2:
          evaluate_places<2>(batch);
          return {};
        case 3:
          evaluate_places<3>(batch);
          return {};
        default:
          return Status::failure(Code::unsupported, "a templated law reads 1 to 3 numbers, this place has " +
                                                        std::to_string(batch.dimension));
      }
    });
  }

 private:
  static constexpr int none = -1;

  template <int n>
  void evaluate_places(const LawBatch& batch) const {
    const bool derivatives = batch.stress != nullptr || batch.modulus != nullptr;
    const bool sensitivities =
        batch.parameter_energy != nullptr || batch.parameter_stress != nullptr || batch.parameter_modulus != nullptr;
    for (int i = 0; i < batch.count; ++i) {
      if (derivatives)
        differentiate<n>(batch, i);
      else if (batch.energy != nullptr)
        batch.energy[i] = energy_at<double, n>(batch, i, none, none);
      if (sensitivities) differentiate_parameters<n>(batch, i);
    }
  }

  /// W, W_x and W_xx from a jet in x.
  template <int n>
  void differentiate(const LawBatch& batch, int i) const {
    const Jet<n> w = energy_at<Jet<n>, n>(batch, i, none, none);
    if (batch.energy != nullptr) batch.energy[i] = w.value;
    if (batch.stress != nullptr) {
      for (int k = 0; k < n; ++k) batch.stress[i * n + k] = w.gradient[k];
    }
    if (batch.modulus != nullptr) {
      for (int k = 0; k < Jet<n>::pairs; ++k) batch.modulus[i * Jet<n>::pairs + k] = w.hessian[k];
    }
  }

  /// W_p, W_xp and the diagonal of W_pp from a jet in (x, p) for each parameter; the rest of W_pp pair by pair.
  template <int n>
  void differentiate_parameters(const LawBatch& batch, int i) const {
    const int count = parameter_count();
    double* modulus = batch.parameter_modulus != nullptr ? batch.parameter_modulus + i * packed_size(count) : nullptr;
    for (int p = 0; p < count; ++p) {
      const Jet<n + 1> w = energy_at<Jet<n + 1>, n>(batch, i, p, none);
      if (batch.parameter_energy != nullptr) batch.parameter_energy[i * count + p] = w.gradient[n];
      if (batch.parameter_stress != nullptr) {
        for (int k = 0; k < n; ++k) batch.parameter_stress[(i * n + k) * count + p] = w.hessian[packed_index(n, k)];
      }
      if (modulus == nullptr) continue;
      modulus[packed_index(p, p)] = w.hessian[packed_index(n, n)];
      for (int q = 0; q < p; ++q) {
        modulus[packed_index(p, q)] = energy_at<Jet<n + 2>, n>(batch, i, p, q).hessian[packed_index(n + 1, n)];
      }
    }
  }

  /// W at place i. A jet's variables are x, then the parameters `first` and `second` where they are named.
  template <class T, int n>
  T energy_at(const LawBatch& batch, int i, int first, int second) const {
    T x[n];
    for (int k = 0; k < n; ++k) x[k] = variable<T>(batch.x[i * n + k], k);
    std::array<T, most_parameters> parameter;
    const int count = parameter_count();
    for (int p = 0; p < count; ++p) {
      const int index = p == first ? n : p == second ? n + 1 : none;
      parameter[static_cast<std::size_t>(p)] = variable<T>(batch.parameter[p][i], index);
    }
    constexpr auto numbers = static_cast<std::size_t>(n);
    return author_.template energy<T>(
        {{x, numbers}, {batch.reference + i * n, numbers}, {parameter.data(), static_cast<std::size_t>(count)}});
  }

  /// A number of kind T; a jet whose variable `index` it is, where it has that one.
  template <class T>
  static T variable(double value, int index) {
    T out = value;
    if constexpr (!std::is_same_v<T, double>) {
      if (index >= 0 && index < T::variables) out.gradient[index] = 1.0;
    }
    return out;
  }

  int parameter_count() const noexcept { return static_cast<int>(description_.parameters.size()); }

  Author author_;
  LawDescription description_;
};

}  // namespace bowstring
