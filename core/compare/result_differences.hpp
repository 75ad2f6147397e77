#pragma once

#include <string>
#include <vector>

#include "core/compare/composition_differences.hpp"
#include "core/compare/number_differences.hpp"
#include "core/result/recorded_result.hpp"

namespace bowstring {

/// A word of one result beside that of another: "minimum", "saddle"; "" where there is none.
struct WordDifference {
  std::string name, a, b;
};

/// How far a curve lies in one result from where it lies in the other, at equal shares of its material.
struct CurveDifference {
  std::string name;
  double largest = 0.0;        ///< mm
  double largest_share = 0.0;  ///< of the material, where that is
  double mean = 0.0;           ///< mm, over the arc length of the first
  int nodes_a = 0, nodes_b = 0;
  std::string unknown;  ///< why there are no figures: "only in B"; ""
};

/// Two results beside each other. Numbers stand in the order of the documents, equal ones too; `path` is without the
/// table that it is in: "peak_displacement_mm".
struct ResultDifferences {
  WordDifference status, reason, second_order;
  std::vector<NumberDifference> quantities, energies, certificate;
  std::vector<NumberDifference> losses;  ///< values, by name
  std::vector<CurveDifference> curves;
  std::vector<NumberDifference> forces;   ///< N: sums and largest of contacts, magnitudes of supports
  std::vector<NumberDifference> effort;   ///< unknowns, iterations, factorizations, evaluations, epochs
  std::vector<NumberDifference> seconds;  ///< `setup` and `solve`
  BitComparison bits;
};

ResultDifferences result_differences(const RecordedResult& a, const RecordedResult& b);

/// All that a comparison says of what two results, or compositions, come from.
struct Comparison {
  std::vector<CompositionDifference> composition;
  std::vector<std::string> provenance;  ///< sentences: programs, and where the solves started

  /// Differences that can be behind others: places of the composition, those that another one brings along left out,
  /// and the provenance as one.
  int things() const;
  bool none() const noexcept { return composition.empty() && provenance.empty(); }
};

/// In what the compositions of two results differ, and their programs, and the states that they started from. The
/// sides are called "in A" and "in B". `registry` as in `composition_differences`.
Comparison compare_questions(const RecordedResult& a, const RecordedResult& b, Registry* registry);

}  // namespace bowstring
