#include "core/assembly/law_batch.hpp"

#include <cmath>
#include <numeric>

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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
  weighs_ = description.measure == Measure::per_length && (divides_ || description.site == Site::node);
  x_.assign(at(count_ * dimension_), 0.0);
  reference_ = x_;
  stress_ = x_;
  energy_.assign(at(count_), 0.0);
  modulus_.assign(at(count_ * packed_size(dimension_)), 0.0);
  ds_.assign(at(count_), 1.0);
  for (int i = 0; i < count_; ++i) {
    if (!declaration.ds.empty()) ds_[at(i)] = declaration.ds[at(place_[at(i)])];
    const double* y = reference.data() + place_[at(i)] * declaration.values;
    const double ds = varies_ ? y[dimension_] : ds_[at(i)];
    for (int k = 0; k < dimension_; ++k) reference_[at(i * dimension_ + k)] = divides_ ? y[k] / ds : y[k];
  }
  for (const std::vector<double>& parameter : use.parameters) parameter_.push_back(parameter.data());
}

void LawAssembly::read(const SiteTable& site) {
  for (int i = 0; i < count_; ++i) {
    const double* y = site.y.data() + place_[at(i)] * site.values();
    if (varies_) ds_[at(i)] = y[dimension_];
    const double scale = divides_ ? 1.0 / ds_[at(i)] : 1.0;
    for (int k = 0; k < dimension_; ++k) x_[at(i * dimension_ + k)] = y[k] * scale;
  }
}

LawBatch LawAssembly::batch() const {
  LawBatch batch;
  batch.count = count_;
  batch.dimension = dimension_;
  batch.x = x_.data();
  batch.reference = reference_.data();
  batch.parameter = parameter_.data();
  return batch;
}

Status LawAssembly::check(const std::vector<double>& numbers, const char* what) const {
  double sum = 0.0;
  for (const double number : numbers) sum += number;
  if (std::isfinite(sum)) return {};
  const std::size_t per_place = numbers.size() / at(count_);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (std::isfinite(numbers[k])) continue;
    return Status::failure(Code::failed, std::string("its ") + what + " is not a finite number at " +
                                             site_name(use_->description.site) + " " +
                                             std::to_string(place_[k / per_place]));
  }
  return {};  // finite numbers whose sum overflows are large, not wrong
}

Status LawAssembly::evaluate(SiteTable& site, double* energy) {
  if (count_ == 0) return {};
  read(site);
  LawBatch batch = this->batch();
  batch.energy = energy_.data();
  batch.stress = stress_.data();
  if (Status status = use_->law->evaluate(batch); !status.ok()) return status;
  if (Status status = check(energy_, "energy"); !status.ok()) return status;
  if (Status status = check(stress_, "stress"); !status.ok()) return status;
  for (int i = 0; i < count_; ++i) {
    // E = weight · m(ds) · W(y/d(ds)), with m = ds or 1 and d = ds or 1.
    const double ds = ds_[at(i)];
    const double measure = weight_[at(i)] * (weighs_ ? ds : 1.0);
    const double scale = divides_ ? 1.0 / ds : 1.0;
    *energy += measure * energy_[at(i)];
    const double* w = stress_.data() + i * dimension_;
    double* out = site.stress.data() + place_[at(i)] * site.values();
    for (int k = 0; k < dimension_; ++k) out[k] += measure * scale * w[k];
    if (!varies_) continue;
    double work = 0.0;
    for (int k = 0; k < dimension_; ++k) work += x_[at(i * dimension_ + k)] * w[k];
    out[dimension_] += (weighs_ ? weight_[at(i)] * energy_[at(i)] : 0.0) - (divides_ ? measure / ds * work : 0.0);
  }
  return {};
}

Status LawAssembly::add_modulus(SiteTable& site) {
  if (count_ == 0 || (use_->description.linear && !varies_)) return {};
  read(site);
  LawBatch batch = this->batch();
  batch.stress = stress_.data();
  batch.modulus = modulus_.data();
  if (Status status = use_->law->evaluate(batch); !status.ok()) return status;
  if (Status status = check(modulus_, "modulus"); !status.ok()) return status;
  const int n = dimension_;
  for (int i = 0; i < count_; ++i) {
    const double ds = ds_[at(i)];
    const double measure = weight_[at(i)] * (weighs_ ? ds : 1.0);
    const double scale = divides_ ? 1.0 / ds : 1.0;
    const double* c = modulus_.data() + i * packed_size(n);
    double* out = site.modulus.data() + place_[at(i)] * packed_size(site.values());
    for (int k = 0; k < packed_size(n); ++k) out[k] += measure * scale * scale * c[k];
    if (!varies_) continue;

    // The rules that Law states, for m and d each ds or 1.
    const double* w = stress_.data() + i * n;
    const double* x = x_.data() + i * n;
    const double slope = weighs_ ? weight_[at(i)] : 0.0;
    const double rate = divides_ ? measure / ds : 0.0;
    double work = 0.0;
    double quadratic = 0.0;
    for (int k = 0; k < n; ++k) {
      double cx = 0.0;
      for (int l = 0; l < n; ++l) cx += c[k >= l ? packed_index(k, l) : packed_index(l, k)] * x[l];
      out[packed_index(n, k)] += slope * scale * w[k] - rate * scale * (w[k] + cx);
      work += x[k] * w[k];
      quadratic += x[k] * cx;
    }
    if (divides_) out[packed_index(n, n)] += -2.0 * slope / ds * work + rate / ds * (2.0 * work + quadratic);
  }
  return {};
}

}  // namespace bowstring
