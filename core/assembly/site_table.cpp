#include "core/assembly/site_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int max_values = 8;
constexpr int max_width = 32;

/// Lower triangle of BᵀCB for one place, C packed.
void congruence(const double* modulus, const double* b, int values, int width, double* out) noexcept {
  double cb[max_values * max_width];
  for (int a = 0; a < values; ++a) {
    for (int j = 0; j < width; ++j) {
      double sum = 0.0;
      for (int c = 0; c < values; ++c) {
        sum += modulus[a >= c ? packed_index(a, c) : packed_index(c, a)] * b[c * width + j];
      }
      cb[a * width + j] = sum;
    }
  }
  for (int i = 0; i < width; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int a = 0; a < values; ++a) sum += b[a * width + i] * cb[a * width + j];
      out[packed_index(i, j)] = sum;
    }
  }
}

/// What a kinematics wrote, place after place.
Status screened(Status status, const std::vector<double>& numbers, const SiteDeclaration& site, const char* what) {
  if (!status.ok()) return status;
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
  const auto places = at(declaration.count);
  const auto numbers = places * at(declaration.values);
  table.y.assign(numbers, 0.0);
  table.stress.assign(numbers, 0.0);
  table.total_stress.assign(numbers, 0.0);
  if (!declaration.identity) table.jacobian.assign(numbers * at(declaration.width), 0.0);
  if (table.bends()) table.curvature.assign(places * at(packed_size(declaration.width)), 0.0);
  table.unknown.reserve(declaration.stencil.size());
  for (const int local : declaration.stencil) table.unknown.push_back(local < 0 ? -1 : curve.unknown_begin + local);
  return table;
}

Status SiteTable::update_values(const double* curve_q, int coordinates) {
  SiteEvaluation evaluation;
  evaluation.site = declaration->site;
  evaluation.q = {curve_q, at(coordinates)};
  evaluation.values = y;
  return screened(kinematics->evaluate(evaluation), y, *declaration, "a value");
}

Status SiteTable::update_jacobian(const double* curve_q, int coordinates) {
  if (declaration->identity) return {};
  SiteEvaluation evaluation;
  evaluation.site = declaration->site;
  evaluation.q = {curve_q, at(coordinates)};
  evaluation.jacobian = jacobian;
  return screened(kinematics->evaluate(evaluation), jacobian, *declaration, "a derivative");
}

Status SiteTable::update_curvature(const double* curve_q, int coordinates) {
  if (!bends()) return {};
  SiteEvaluation evaluation;
  evaluation.site = declaration->site;
  evaluation.q = {curve_q, at(coordinates)};
  evaluation.stress = total_stress;
  evaluation.curvature = curvature;
  return screened(kinematics->evaluate(evaluation), curvature, *declaration, "a second derivative");
}

void SiteTable::add_gradient(const std::vector<double>& place_stress, double* out) const noexcept {
  const int ny = values();
  const int w = width();
  for (int i = 0; i < count(); ++i) {
    const double* s = place_stress.data() + at(i) * at(ny);
    const int* u = unknown.data() + at(i) * at(w);
    if (declaration->identity) {
      for (int j = 0; j < w; ++j) out[u[j]] += s[j];
      continue;
    }
    const double* b = jacobian.data() + at(i) * at(ny) * at(w);
    for (int j = 0; j < w; ++j) {
      if (u[j] < 0) continue;
      double sum = 0.0;
      for (int a = 0; a < ny; ++a) sum += s[a] * b[a * w + j];
      out[u[j]] += sum;
    }
  }
}

void SiteTable::add_hessian(double factor, double* hessian) const noexcept {
  if (hessian_position.empty()) return;
  const int ny = values();
  const int w = width();
  const int packed = packed_size(w);
  double local[packed_size(max_width)];
  for (int i = 0; i < count(); ++i) {
    const int* position = hessian_position.data() + at(i) * at(packed);
    if (modulus.empty()) {
      std::fill(local, local + packed, 0.0);
    } else {
      const double* c = modulus.data() + at(i) * at(packed_size(ny));
      if (declaration->identity) {
        for (int k = 0; k < packed; ++k) local[k] = factor * c[k];
      } else {
        congruence(c, jacobian.data() + at(i) * at(ny) * at(w), ny, w, local);
        for (int k = 0; k < packed; ++k) local[k] *= factor;
      }
    }
    if (!curvature.empty()) {
      const double* bend = curvature.data() + at(i) * at(packed);
      for (int k = 0; k < packed; ++k) local[k] += bend[k];
    }
    for (int k = 0; k < packed; ++k) {
      if (position[k] >= 0) hessian[position[k]] += local[k];
    }
  }
}

}  // namespace bowstring
