#pragma once

#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"

namespace bowstring::checking {

inline std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

/// One field of one curve: its entries among `Assembly::entries` and its free unknowns, both contiguous.
struct FieldGroup {
  int curve = 0;
  const FieldDeclaration* field = nullptr;
  int entry_begin = 0, entry_end = 0;
  int begin = 0, end = 0;  ///< free unknowns
};

/// Every field of every curve, in the order of the unknowns, those without a free unknown included.
std::vector<FieldGroup> field_groups(const Assembly& assembly);

/// "position of 'iliac'".
std::string group_name(const Assembly& assembly, const FieldGroup& group);
/// "position 17 of 'iliac', y".
std::string unknown_name(const Assembly& assembly, int free_unknown);
/// Within its group, with the first place that it reads: "row 4 (node 5 of 'lunderquist')".
std::string row_name(const Assembly& assembly, int row);
/// "energy 'anchoring' on 'iliac'".
std::string term_name(const Scene& scene, int term);
/// "constraint 'lumen'", "edge closure of 'iliac'".
std::string origin_name(const Scene& scene, const RowOrigin& origin);

/// A change of each free unknown that is small but felt: the local edge length of positions and lengths, no more than
/// the smallest radius of the scene; 1 rad; the whole length L of a curve. n entries.
std::vector<double> natural_steps(const Assembly& assembly);

/// n numbers over the free unknowns out of numbers over all tangent numbers.
std::vector<double> free_part(const Assembly& assembly, const std::vector<double>& all);

/// Products with the lower triangle of a symmetric matrix: Σ_j H_ij d_j and (Σ_j (H_ij d_j)²)^½.
struct SymmetricProduct {
  std::vector<double> value, size;
};
SymmetricProduct symmetric_product(const SparsityPattern& pattern, const std::vector<double>& values,
                                   const std::vector<double>& direction);
/// The same by rows.
SymmetricProduct row_product(const SparsityPattern& pattern, const std::vector<double>& values,
                             const std::vector<double>& direction);
/// Jᵀλ over the rows of `origin`.
std::vector<double> transposed_product(const SparsityPattern& pattern, const std::vector<double>& values,
                                       const RowOrigin& origin, const std::vector<double>& multipliers, int unknowns);

}  // namespace bowstring::checking
