#pragma once

namespace bowstring {

/// What terms may read, named by curve, site and index. y is the place's vector of numbers.
///
/// | site    | y                                    | what it is |
/// |---------|--------------------------------------|------------|
/// | node    | p (dimension)                        | position of a node, an unknown in every kinematics: ∂y/∂δ = I |
/// | station | ζ (1, 2 or 3) [, ds, s]              | rotation across a node between its two edges, or across half an
/// edge at a held tangent | | edge    | ℓ (1) [, ds, s]                      | length of an edge; ds is its rest length
/// | | frame   | its coordinates (angle, quaternion)  | orientation of an edge; derivatives in its body tangent | |
/// length  | L (1)                                | length of the curve in the body, held edges included | | field   |
/// the unknown itself                   | an extra unknown that a term declared | | closure | residual of the
/// kinematics' own rows | not for terms: |p_{i+1} − p_i| − ℓ_i, or p_{i+1} − p_i − ℓ_i R_i e₁ |
///
/// ζ has one component in the plane (signed turning angle), two in space without material frames (in a
/// transported basis that is the kinematics' own, so that only isotropic laws may read it), three with frames
/// (twist first). ds is the length of material that the place stands for, s its arc coordinate; they belong to
/// y only where they depend on unknowns (a sliding wire), otherwise they are constants of the site.
enum class Site : int { node, station, edge, frame, length, field, closure };
inline constexpr int site_count = 7;
/// "node", "station", …, for messages.
const char* site_name(Site site) noexcept;

struct Place {
  int curve = 0;
  Site site = Site::node;
  int index = 0;
};

/// Entries of a packed lower triangle of order n, row by row: (0,0), (1,0), (1,1), (2,0), …
constexpr int packed_size(int n) noexcept { return n * (n + 1) / 2; }
constexpr int packed_index(int row, int column) noexcept { return row * (row + 1) / 2 + column; }

}  // namespace bowstring
