#include "study/analysis/sensitivities.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "study/analysis/lines.hpp"
#include "study/analysis/sample.hpp"
#include "study/analysis/statistics.hpp"

namespace bowstring::study {

namespace {

constexpr double alike = 0.98;        // cosine
constexpr double vanishing = 1e-6;    // of the largest column
constexpr double not_varying = 1e-9;  // of a quantity's mean
std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool positive(const std::vector<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double n) { return n > 0.0; });
}

/// Slope at x[1] of the parabola through three points.
double slope_of_parabola(const double x[3], const double f[3]) {
  const double before = x[1] - x[0], after = x[2] - x[1];
  return ((f[2] - f[1]) * before / after + (f[1] - f[0]) * after / before) / (before + after);
}

/// Places on the study's grids.
class Grid {
 public:
  explicit Grid(const StudyData& data) : data_(data), mesh_(finest_mesh(data)), varying_(varying_axes(data)) {
    for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) run_at_.emplace(data.runs[at(run)].choice, run);
    for (int a = 0; a < static_cast<int>(data.axes.size()); ++a) {
      const AxisData& axis = data.axes[at(a)];
      if (a == data.along || sampled(axis) || axis.number.size() < 3) continue;
      axes_.push_back(a);
      std::vector<int> order(axis.number.size());
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(),
                       [&](int one, int other) { return axis.number[at(one)] < axis.number[at(other)]; });
      order_.push_back(order);
    }
  }

  void add_places(std::vector<Sensitivity>& out) const {
    for (int q = 0; q < static_cast<int>(data_.quantities.size()); ++q) {
      for (int run = 0; run < static_cast<int>(data_.runs.size()); ++run) {
        if (!at_mesh(data_, run, mesh_)) continue;
        Sensitivity place{q, "", {}};
        for (std::size_t k = 0; k < axes_.size(); ++k) add_entry(place, q, run, k);
        if (place.entries.empty()) continue;
        place.at = run_label(data_, varying_, run);
        out.push_back(place);
      }
    }
  }

 private:
  void add_entry(Sensitivity& place, int quantity, int run, std::size_t k) const {
    std::vector<int> choice = data_.runs[at(run)].choice;
    const int axis = axes_[k];
    const AxisData& own = data_.axes[at(axis)];
    const std::vector<int>& order = order_[k];
    const auto here = std::find(order.begin(), order.end(), choice[at(axis)]);
    if (here == order.end() || here == order.begin() || here + 1 == order.end()) return;
    const bool logarithmic = own.spacing == Spacing::logarithmic && positive(own.number);
    double x[3], f[3];
    for (int side = 0; side < 3; ++side) {
      choice[at(axis)] = *(here + side - 1);
      const auto found = run_at_.find(choice);
      if (found == run_at_.end()) return;
      f[side] = counted_value(data_, quantity, found->second);
      if (!std::isfinite(f[side])) return;
      const double number = own.number[at(choice[at(axis)])];
      x[side] = logarithmic ? std::log(number) : number;
    }
    const double number = own.number[at(*here)];
    const double derivative = slope_of_parabola(x, f) / (logarithmic ? number : 1.0);
    if (!std::isfinite(derivative)) return;  // two equal numbers
    place.entries.push_back({axis, number, derivative, f[1] != 0.0 ? number / f[1] * derivative : std::nan("")});
  }

  const StudyData& data_;
  int mesh_;
  std::vector<int> varying_;
  std::vector<int> axes_;
  std::vector<std::vector<int>> order_;  // of their alternatives, by number
  std::map<std::vector<int>, int> run_at_;
};

void add_samples(const StudyData& data, std::vector<Sensitivity>& out) {
  const std::vector<Sample> samples = find_samples(data);
  for (const Sample& sample : samples) {
    for (int q = 0; q < static_cast<int>(data.quantities.size()); ++q) {
      const SampleValues values = sample_values(data, sample, q);
      const Regression fit = regress(values.parameters, values.value);
      if (fit.coefficient.empty() || fit.r_squared < enough_explained) continue;
      Sensitivity place{
          q, samples.size() > 1 ? "the middle of the sample with " + sample.label : "the middle of the sample", {}};
      const double centre = mean(values.value);
      for (std::size_t k = 0; k < sample.axes.size(); ++k) {
        const double number = mean(values.parameters[k]), slope = fit.coefficient[k];
        place.entries.push_back(
            {sample.axes[k], number, slope, centre != 0.0 ? number / centre * slope : std::nan("")});
      }
      out.push_back(place);
    }
  }
}

class Collinearity {
 public:
  Collinearity(const StudyData& data, const std::vector<Sensitivity>& sensitivities) : data_(data) {
    for (int q = 0; q < static_cast<int>(data.quantities.size()); ++q) spread_.push_back(spread(q));
    for (const Sensitivity& place : sensitivities) add_row(place);
  }

  std::vector<Inseparable> find() const {
    std::vector<Inseparable> out;
    for (auto one = columns_.begin(); one != columns_.end(); ++one) {
      for (auto other = std::next(one); other != columns_.end(); ++other) compare(*one, *other, out);
    }
    return out;
  }

 private:
  using Column = std::map<int, double>;  // row → entry

  double spread(int quantity) const {
    std::vector<double> values;
    for (int run = 0; run < static_cast<int>(data_.runs.size()); ++run) {
      const double value = counted_value(data_, quantity, run);
      if (std::isfinite(value)) values.push_back(value);
    }
    const double out = deviation(values);
    return out > not_varying * std::fabs(mean(values)) ? out : 0.0;
  }

  void add_row(const Sensitivity& place) {
    const double spread = spread_[at(place.quantity)];
    if (!(spread > 0.0)) return;
    for (const SensitivityEntry& entry : place.entries) {
      const std::vector<double>& numbers = data_.axes[at(entry.axis)].number;
      const bool one_sign =
          positive(numbers) || std::all_of(numbers.begin(), numbers.end(), [](double n) { return n < 0.0; });
      const double size = one_sign ? entry.at : deviation(numbers);
      columns_[entry.axis][rows_] = size * entry.derivative / spread;
    }
    ++rows_;
  }

  void compare(const std::pair<const int, Column>& one, const std::pair<const int, Column>& other,
               std::vector<Inseparable>& out) const {
    double product = 0.0, left = 0.0, right = 0.0;
    int rows = 0;
    for (const auto& [row, a] : one.second) {
      const auto found = other.second.find(row);
      if (found == other.second.end()) continue;
      const double b = found->second;
      product += a * b, left += a * a, right += b * b, ++rows;
    }
    const double least = vanishing * std::sqrt(std::max(left, right));
    if (rows < 2 || !(std::sqrt(std::min(left, right)) > least)) return;
    const double cosine = product / std::sqrt(left * right);
    if (std::fabs(cosine) <= alike) return;
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", cosine);
    out.push_back({{one.first, other.first},
                   cosine,
                   data_.axes[at(one.first)].name + " and " + data_.axes[at(other.first)].name +
                       (cosine > 0.0 ? " act alike" : " act against each other in one proportion") + " (cosine " +
                       text + "): these quantities cannot tell them apart"});
  }

  const StudyData& data_;
  std::vector<double> spread_;  // per quantity; 0: it does not vary
  std::map<int, Column> columns_;
  int rows_ = 0;
};

}  // namespace

std::vector<Sensitivity> find_sensitivities(const StudyData& data) {
  std::vector<Sensitivity> out;
  Grid(data).add_places(out);
  add_samples(data, out);
  return out;
}

std::vector<Inseparable> find_inseparable(const StudyData& data, const std::vector<Sensitivity>& sensitivities) {
  std::vector<Inseparable> out = Collinearity(data, sensitivities).find();
  std::stable_sort(out.begin(), out.end(), [](const Inseparable& one, const Inseparable& other) {
    return std::fabs(one.cosine) > std::fabs(other.cosine);
  });
  return out;
}

}  // namespace bowstring::study
