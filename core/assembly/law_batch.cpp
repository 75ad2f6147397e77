#include "core/assembly/law_batch.hpp"

#include <cmath>
#include <numeric>

#include "core/assembly/finite.hpp"
#include "core/assembly/sizes.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int common_dimension = 3;

/// Σ a_i b_i, in sums that do not wait for each other.
double dot(const std::vector<double>& a, const std::vector<double>& b) noexcept {
  double sum[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4) {
    sum[0] += a[i] * b[i];
    sum[1] += a[i + 1] * b[i + 1];
    sum[2] += a[i + 2] * b[i + 2];
    sum[3] += a[i + 3] * b[i + 3];
  }
  for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
  return sum[0] + sum[1] + (sum[2] + sum[3]);
}

}  // namespace

LawAssembly::LawAssembly(const LawUse& use, const SiteTable& site, const std::vector<double>& reference)
    : use_(&use), place_(use.description.places), weight_(use.description.weight) {
  const LawDescription& description = use.description;
  const SiteDeclaration& declaration = *site.declaration;
  if (place_.empty()) {
    place_.resize(at(site.count()));
    std::iota(place_.begin(), place_.end(), 0);
  }
  count_ = static_cast<int>(place_.size());
  weight_.resize(at(count_), 1.0);
  varies_ = declaration.lengths_vary;
  dimension_ = declaration.values - (varies_ ? 2 : 0);
  divides_ = description.site == Site::station || description.site == Site::edge;
  weighs_ = description.weighing == Weighing::per_length && (divides_ || description.site == Site::node);
  bool all = count_ == site.count();
  for (int i = 0; all && i < count_; ++i) all = place_[at(i)] == i;
  as_it_stands_ = all && !divides_ && !varies_;
  x_.assign(at(count_ * dimension_), 0.0);
  reference_ = x_;
  stress_ = x_;
  energy_.assign(at(count_), 0.0);
  modulus_.assign(at(count_ * packed_size(dimension_)), 0.0);
  measure_.assign(at(count_), 1.0);
  by_ds_.assign(at(count_), 1.0);
  for (int i = 0; i < count_; ++i) {
    const double* y = reference.data() + place_[at(i)] * declaration.values;
    const double fixed = declaration.ds.empty() ? 1.0 : declaration.ds[at(place_[at(i)])];
    const double ds = varies_ ? y[dimension_] : fixed;
    measure_[at(i)] = weight_[at(i)] * (weighs_ ? fixed : 1.0);
    if (divides_) by_ds_[at(i)] = 1.0 / fixed;
    for (int k = 0; k < dimension_; ++k) reference_[at(i * dimension_ + k)] = divides_ ? y[k] / ds : y[k];
  }
  for (const std::vector<double>& parameter : use.parameters) parameter_.push_back(parameter.data());
}

void LawAssembly::read(const SiteTable& site) {
  if (as_it_stands_) return;
  for (int i = 0; varies_ && i < count_; ++i) {
    const double ds = site.y[at(place_[at(i)] * site.values() + dimension_)];
    if (weighs_) measure_[at(i)] = weight_[at(i)] * ds;
    if (divides_) by_ds_[at(i)] = 1.0 / ds;
  }
  with_size<common_dimension>(dimension_, [&](auto fixed) {
    const int n = fixed == 0 ? dimension_ : fixed;
    for (int i = 0; i < count_; ++i) {
      const double* y = site.y.data() + place_[at(i)] * site.values();
      for (int k = 0; k < n; ++k) x_[at(i * n + k)] = y[k] * by_ds_[at(i)];
    }
  });
}

LawBatch LawAssembly::batch(const SiteTable& site) const {
  LawBatch batch;
  batch.count = count_;
  batch.dimension = dimension_;
  batch.x = as_it_stands_ ? site.y.data() : x_.data();
  batch.reference = reference_.data();
  batch.parameter = parameter_.data();
  return batch;
}

Status LawAssembly::check(const std::vector<double>& numbers, const char* what) const {
  if (all_finite(numbers.data(), numbers.size())) return {};
  const std::size_t per_place = numbers.size() / at(count_);
  std::size_t k = 0;
  while (std::isfinite(numbers[k])) ++k;
  return Status::failure(Code::failed, std::string("its ") + what + " is not a finite number at " +
                                           site_name(use_->description.site) + " " +
                                           std::to_string(place_[k / per_place]));
}

Status LawAssembly::evaluate(SiteTable& site, double* energy) {
  if (count_ == 0) return {};
  read(site);
  LawBatch batch = this->batch(site);
  batch.energy = energy_.data();
  batch.stress = stress_.data();
  if (Status status = use_->law->evaluate(batch); !status.ok()) return status;
  if (Status status = check(energy_, "energy"); !status.ok()) return status;
  if (Status status = check(stress_, "stress"); !status.ok()) return status;
  *energy += dot(measure_, energy_);
  add_stress(site);
  if (varies_) add_length_stress(site);
  return {};
}

void LawAssembly::add_stress(SiteTable& site) const {
  with_size<common_dimension>(dimension_, [&](auto fixed) {
    const int n = fixed == 0 ? dimension_ : fixed;
    for (int i = 0; i < count_; ++i) {
      const double factor = measure_[at(i)] * by_ds_[at(i)];
      double* out = site.stress.data() + place_[at(i)] * site.values();
      for (int k = 0; k < n; ++k) out[k] += factor * stress_[at(i * n + k)];
    }
  });
}

void LawAssembly::add_length_stress(SiteTable& site) const {
  for (int i = 0; i < count_; ++i) {
    double work = 0.0;
    for (int k = 0; k < dimension_; ++k) work += x_[at(i * dimension_ + k)] * stress_[at(i * dimension_ + k)];
    double& out = site.stress[at(place_[at(i)] * site.values() + dimension_)];
    out +=
        (weighs_ ? weight_[at(i)] * energy_[at(i)] : 0.0) - (divides_ ? measure_[at(i)] * by_ds_[at(i)] * work : 0.0);
  }
}

Status LawAssembly::add_modulus(SiteTable& site) {
  if (count_ == 0 || (use_->description.linear && !varies_)) return {};
  LawBatch batch = this->batch(site);
  batch.modulus = modulus_.data();
  if (Status status = use_->law->evaluate(batch); !status.ok()) return status;
  if (Status status = check(modulus_, "modulus"); !status.ok()) return status;
  with_size<common_dimension>(dimension_, [&](auto fixed) {
    const int numbers = packed_size(fixed == 0 ? dimension_ : fixed);
    for (int i = 0; i < count_; ++i) {
      const double factor = measure_[at(i)] * by_ds_[at(i)] * by_ds_[at(i)];
      double* out = site.modulus.data() + place_[at(i)] * packed_size(site.values());
      for (int k = 0; k < numbers; ++k) out[k] += factor * modulus_[at(i * numbers + k)];
    }
  });
  if (varies_) add_length_modulus(site);
  return {};
}

/// The rules that Law states, for m and d each ds or 1.
void LawAssembly::add_length_modulus(SiteTable& site) const {
  with_size<common_dimension>(dimension_, [&](auto fixed) {
    const int n = fixed == 0 ? dimension_ : fixed;
    for (int i = 0; i < count_; ++i) {
      const double* c = modulus_.data() + i * packed_size(n);
      const double* w = stress_.data() + i * n;
      const double* x = x_.data() + i * n;
      double* out = site.modulus.data() + place_[at(i)] * packed_size(site.values());
      const double scale = by_ds_[at(i)];
      const double slope = weighs_ ? weight_[at(i)] : 0.0;
      const double rate = divides_ ? measure_[at(i)] * scale : 0.0;
      double work = 0.0;
      double quadratic = 0.0;
      for (int k = 0; k < n; ++k) {
        double cx = 0.0;
        for (int l = 0; l < n; ++l) cx += c[k >= l ? packed_index(k, l) : packed_index(l, k)] * x[l];
        out[packed_index(n, k)] += slope * scale * w[k] - rate * scale * (w[k] + cx);
        work += x[k] * w[k];
        quadratic += x[k] * cx;
      }
      if (divides_) out[packed_index(n, n)] += scale * (rate * (2.0 * work + quadratic) - 2.0 * slope * work);
    }
  });
}

}  // namespace bowstring
