#pragma once

#include <string>
#include <vector>

namespace bowstring {

/// A number of a result document and its counterpart in another.
struct NumberDifference {
  std::string path;         ///< in the document: "quantities.peak_displacement_mm"
  double a = 0.0, b = 0.0;  ///< NaN: null

  double absolute() const noexcept { return b - a; }
  double relative() const noexcept;  ///< (b − a)/|a|; NaN where a is 0
};

/// Whether two documents hold the same bits.
struct BitComparison {
  long numbers = 0;                         ///< compared
  std::vector<NumberDifference> different;  ///< in the order of the document
  std::vector<std::string> otherwise;  ///< what is no number, or has no counterpart: "'contacts' has 80 entries, 78"

  bool same() const noexcept { return different.empty() && otherwise.empty(); }
};

/// Compares all that two result documents (JSON texts) say of what came out, states and equilibria and paths included,
/// bit by bit; not the seconds, the composition, the provenance, nor sentences for people.
BitComparison compare_bits(const std::string& a, const std::string& b);

/// The differences that are largest beside the largest number of their kind (of their own place in the document, list
/// positions left out), each kind once, largest first, residuals and the solver last; at most `most`.
std::vector<NumberDifference> largest_differences(const BitComparison& bits, std::size_t most);

}  // namespace bowstring
