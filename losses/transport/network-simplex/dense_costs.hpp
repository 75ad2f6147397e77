#pragma once

#include <cstddef>
#include <vector>

#include "core/interfaces/transport.hpp"
#include "losses/transport/network-simplex/spanning_tree.hpp"

namespace bowstring::simplex {

/// The costs of a problem as one matrix, row major: the caller's where it stands in memory, else one of our own, which
/// is kept for the next problem.
class DenseCosts {
 public:
  /// All costs. Throws the StatusError of what fails.
  void load(PairCosts& source);
  /// Where costs are dear their lower bounds, which `evaluate` replaces.
  void load_bounds(PairCosts& source);
  const double* data() const noexcept { return data_; }
  /// Puts costs in the place of bounds on these arcs; how many of them were bounds.
  std::size_t evaluate(const std::vector<Arc>& arcs);

  std::size_t memory_bytes() const noexcept { return own_.capacity() * sizeof(double) + evaluated_.capacity() / 8; }

 private:
  void make_room(const PairCosts& source);

  PairCosts* source_ = nullptr;
  const double* data_ = nullptr;
  std::vector<double> own_;
  std::vector<bool> evaluated_;  // empty where all of them are
};

}  // namespace bowstring::simplex
