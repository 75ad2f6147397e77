#include "core/assembly/site_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/assembly/finite.hpp"
#include "core/assembly/sizes.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int max_values = 8;
constexpr int max_width = 32;

// What the kinematics of this project have: loops over them know their lengths.
constexpr int common_values = 4;
constexpr int common_width = 11;

/// Lower triangle of factor·BᵀCB for one place, C packed.
template <int fixed_values, int fixed_width>
inline void congruence(double factor, const double* modulus, const double* b, int values, int width,
                       double* out) noexcept {
  if constexpr (fixed_values != 0) values = fixed_values;
  if constexpr (fixed_width != 0) width = fixed_width;
  if (values < 1 || width < 1) return;
  double cb[max_values * max_width];
  for (int a = 0; a < values; ++a) {
    double* row = cb + a * width;
    const double first = factor * modulus[packed_index(a, 0)];
    for (int j = 0; j < width; ++j) row[j] = first * b[j];
    for (int c = 1; c < values; ++c) {
      const double entry = factor * modulus[a >= c ? packed_index(a, c) : packed_index(c, a)];
      for (int j = 0; j < width; ++j) row[j] += entry * b[c * width + j];
    }
  }
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j <= i; ++j) out[j] = b[i] * cb[j];
    for (int a = 1; a < values; ++a) {
      const double entry = b[a * width + i];
      for (int j = 0; j <= i; ++j) out[j] += entry * cb[a * width + j];
    }
    out += i + 1;
  }
}

/// Adds the packed lower triangle of n unknowns to that of `width` ones, of which they are those from `first` on.
inline void add_block(const double* block, int n, int first, double* out) noexcept {
  for (int i = 0; i < n; ++i) {
    double* row = out + packed_index(first + i, first);
    for (int j = 0; j <= i; ++j) row[j] += *block++;
  }
}

[[gnu::always_inline]] inline void scatter(const double* numbers, const int* position, int count, bool free,
                                           double* out) noexcept {
  if (free) {
    for (int k = 0; k < count; ++k) out[position[k]] += numbers[k];
    return;
  }
  for (int k = 0; k < count; ++k) {
    if (position[k] >= 0) out[position[k]] += numbers[k];
  }
}

/// What a kinematics wrote, place after place.
Status screened(const std::vector<double>& numbers, const SiteDeclaration& site, const char* what) {
  if (all_finite(numbers.data(), numbers.size())) return {};
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (std::isfinite(numbers[k])) continue;
    const std::size_t place = k / (numbers.size() / at(site.count));
    return Status::failure(Code::failed, std::string("its kinematics gives ") + what +
                                             " that is not a finite number at " + site_name(site.site) + " " +
                                             std::to_string(place));
  }
  return {};
}

}  // namespace

SiteTable make_site_table(const Curve& curve, const SiteDeclaration& declaration) {
  SiteTable table;
  table.curve = curve.view.index;
  table.kinematics = curve.kinematics.get();
  table.declaration = &declaration;
  table.read = declaration.site == Site::node || declaration.site == Site::closure;
  const auto places = at(declaration.count);
  const auto numbers = places * at(declaration.values);
  table.y.assign(numbers, 0.0);
  table.stress.assign(numbers, 0.0);
  table.total_stress.assign(numbers, 0.0);
  if (!declaration.identity) table.jacobian.assign(numbers * at(declaration.width), 0.0);
  if (table.bends()) table.curvature.assign(places * at(packed_size(declaration.bent())), 0.0);
  table.unknown.reserve(declaration.stencil.size());
  for (const int local : declaration.stencil) table.unknown.push_back(local < 0 ? -1 : curve.unknown_begin + local);
  return table;
}

void SiteTable::find_blocks(const std::vector<int>& block_of_unknown) {
  for (int i = 0; i < count(); ++i) {
    const int* u = free_unknown.data() + at(i) * at(width());
    const auto none = std::count_if(u, u + width(), [](int free) { return free < 0; });
    int found = none == width() ? held : none > 0 ? mixed : block_of_unknown[at(u[0])];
    for (int k = 0; found >= 0 && k < width(); ++k) {
      if (u[k] != u[0] + k || block_of_unknown[at(u[k])] != found) found = mixed;
    }
    block.push_back(found);
  }
}

bool SiteTable::needs_jacobian() const noexcept {
  return !declaration->identity && !(declaration->linear && has_jacobian_);
}

Status SiteTable::ask(SiteEvaluation evaluation, Span<const double> curve_q, std::uint64_t state) {
  evaluation.site = declaration->site;
  evaluation.q = curve_q;
  evaluation.state = state;
  if (Status status = kinematics->evaluate(evaluation); !status.ok()) return status;
  if (!evaluation.values.empty()) {
    if (Status status = screened(y, *declaration, "a value"); !status.ok()) return status;
  }
  if (!evaluation.jacobian.empty()) {
    if (Status status = screened(jacobian, *declaration, "a derivative"); !status.ok()) return status;
    has_jacobian_ = true;
  }
  return evaluation.curvature.empty() ? Status{} : screened(curvature, *declaration, "a second derivative");
}

Status SiteTable::update_values(Span<const double> curve_q, std::uint64_t state) {
  SiteEvaluation evaluation;
  evaluation.values = y;
  return ask(evaluation, curve_q, state);
}

Status SiteTable::update_jacobian(Span<const double> curve_q, std::uint64_t state) {
  if (!needs_jacobian()) return {};
  SiteEvaluation evaluation;
  evaluation.jacobian = jacobian;
  return ask(evaluation, curve_q, state);
}

Status SiteTable::update_values_and_jacobian(Span<const double> curve_q, std::uint64_t state) {
  SiteEvaluation evaluation;
  evaluation.values = y;
  if (needs_jacobian()) evaluation.jacobian = jacobian;
  return ask(evaluation, curve_q, state);
}

Status SiteTable::update_curvature(Span<const double> curve_q, std::uint64_t state) {
  if (!bends()) return {};
  SiteEvaluation evaluation;
  evaluation.stress = total_stress;
  evaluation.curvature = curvature;
  return ask(evaluation, curve_q, state);
}

void SiteTable::add_gradient(const std::vector<double>& place_stress, const std::vector<int>& where,
                             double* out) const noexcept {
  if (declaration->identity) {
    for (std::size_t k = 0; k < where.size(); ++k) {
      if (where[k] >= 0) out[where[k]] += place_stress[k];
    }
    return;
  }
  const int ny = values();
  with_size<common_width>(width(), [&](auto fixed_width) {
    const int w = fixed_width == 0 ? width() : fixed_width;
    for (int i = 0; i < count(); ++i) {
      const double* s = place_stress.data() + at(i) * at(ny);
      const int* u = where.data() + at(i) * at(w);
      const double* b = jacobian.data() + at(i) * at(ny) * at(w);
      double sum[max_width];
      for (int j = 0; j < w; ++j) sum[j] = s[0] * b[j];
      for (int a = 1; a < ny; ++a) {
        for (int j = 0; j < w; ++j) sum[j] += s[a] * b[a * w + j];
      }
      for (int j = 0; j < w; ++j) {
        if (u[j] >= 0) out[u[j]] += sum[j];
      }
    }
  });
}

void SiteTable::add_hessian(double factor, double* hessian) const noexcept {
  if (hessian_position.empty()) return;
  const int packed = packed_size(hessian_width());
  if (modulus.empty() || declaration->identity) {
    for (int i = 0; i < count(); ++i) {
      const double* second = modulus.empty() ? curvature.data() : modulus.data();
      double local[packed_size(max_width)];
      for (int k = 0; k < packed; ++k) local[k] = (modulus.empty() ? 1.0 : factor) * second[at(i) * at(packed) + at(k)];
      scatter(local, hessian_position.data() + at(i) * at(packed), packed, all_free[at(i)] != 0, hessian);
    }
    return;
  }
  // Laws do not read s, the last number of y where lengths vary.
  const int stiff = values() - (declaration->lengths_vary ? 1 : 0);
  const int bent = curvature.empty() ? 0 : declaration->bent();
  with_size<common_values>(stiff, [&](auto fixed_values) {
    with_size<common_width>(width(), [&](auto fixed_width) {
      const int w = fixed_width == 0 ? width() : fixed_width;
      double local[packed_size(max_width)];
      for (int i = 0; i < count(); ++i) {
        congruence<fixed_values, fixed_width>(factor, modulus.data() + at(i) * at(packed_size(values())),
                                              jacobian.data() + at(i) * at(values()) * at(w), stiff, w, local);
        add_block(curvature.data() + at(i) * at(packed_size(bent)), bent, declaration->bent_first, local);
        scatter(local, hessian_position.data() + at(i) * at(packed_size(w)), packed_size(w), all_free[at(i)] != 0,
                hessian);
      }
    });
  });
}

}  // namespace bowstring
