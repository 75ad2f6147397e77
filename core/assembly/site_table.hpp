#pragma once

#include <vector>

#include "core/model/scene.hpp"

namespace bowstring {

/// All places of one site of one curve at the current state: y, B = ∂y/∂δ, and the stress and modulus that laws and
/// terms have summed there.
struct SiteTable {
  int curve = 0;
  const Kinematics* kinematics = nullptr;
  const SiteDeclaration* declaration = nullptr;
  bool read = false;                 ///< by laws or rows, or at any rate: node positions and closure
  bool pulls = false;                ///< read by laws
  std::vector<double> y;             ///< count × values
  std::vector<double> accepted;      ///< y at the last accepted point, of stations and edges
  std::vector<double> jacobian;      ///< count × values × width; empty where B = I
  std::vector<double> stress;        ///< count × values: of the energies alone
  std::vector<double> total_stress;  ///< count × values: of the Lagrangian
  std::vector<double> modulus;       ///< count × packed_size(values); empty where nothing has one
  std::vector<double> curvature;     ///< count × packed_size(bent()); empty where the site is linear
  std::vector<int> unknown;          ///< count × width: scene-wide tangent number, −1 pads
  std::vector<int> free_unknown;     ///< count × width: free unknown, −1 where it is fixed or pads
  /// count: the block whose consecutive unknowns are the place's, all of them free; or one of the two below.
  std::vector<int> block;
  static constexpr int held = -1, mixed = -2;  ///< none free; or neither
  std::vector<int> lasting_position;  ///< as `hessian_position`, in the pattern of what lasts from epoch to epoch
  std::vector<int> hessian_position;  ///< count × packed_size(hessian_width()), −1 where an unknown is fixed
  std::vector<char> all_free;         ///< count: none of those positions is −1

  int count() const noexcept { return declaration->count; }
  int values() const noexcept { return declaration->values; }
  int width() const noexcept { return declaration->width; }
  bool bends() const noexcept { return !declaration->identity && !declaration->linear; }
  /// The unknowns of a stencil, from `hessian_first` on, that the place contributes second derivatives for.
  int hessian_first() const noexcept { return modulus.empty() ? declaration->bent_first : 0; }
  int hessian_width() const noexcept { return modulus.empty() ? declaration->bent() : declaration->width; }

  /// `block`, once `free_unknown` is known.
  void find_blocks(const std::vector<int>& block_of_unknown);

  // `state`: of SiteEvaluation. A number that is not finite is `failed`, and names the place.
  Status update_values(Span<const double> curve_q, std::uint64_t state);
  Status update_jacobian(Span<const double> curve_q, std::uint64_t state);
  Status update_values_and_jacobian(Span<const double> curve_q, std::uint64_t state);
  /// Σ total_stress ∂²y/∂δ² at every place.
  Status update_curvature(Span<const double> curve_q, std::uint64_t state);

  /// out[where] += Σ_places Bᵀ stress. `where`: `unknown` or `free_unknown`.
  void add_gradient(const std::vector<double>& place_stress, const std::vector<int>& where, double* out) const noexcept;
  /// hessian += factor · BᵀCB + curvature, through `hessian_position`.
  void add_hessian(double factor, double* hessian) const noexcept;

 private:
  bool needs_jacobian() const noexcept;
  Status ask(SiteEvaluation evaluation, Span<const double> curve_q, std::uint64_t state);

  bool has_jacobian_ = false;  // of a linear site, which has the same one at every state
};

SiteTable make_site_table(const Curve& curve, const SiteDeclaration& declaration);

}  // namespace bowstring
