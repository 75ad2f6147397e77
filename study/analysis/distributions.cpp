#include "study/analysis/distributions.hpp"

#include <algorithm>
#include <cmath>

#include "study/analysis/statistics.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr std::size_t runs_per_unknown = 10;

using Columns = std::vector<std::vector<double>>;

struct Shares {
  std::vector<double> share;
  double r_squared = 0.0;
};

double ratio_of_variances(const std::vector<double>& part, const std::vector<double>& whole) {
  const double ratio = deviation(part) / deviation(whole);
  return ratio * ratio;
}

Shares linear_shares(const Columns& parameters, const std::vector<double>& value) {
  const Regression fit = regress(parameters, value);
  Shares out{{}, fit.r_squared};
  for (std::size_t k = 0; k < fit.coefficient.size(); ++k) {
    out.share.push_back(fit.coefficient[k] * fit.coefficient[k] * ratio_of_variances(parameters[k], value));
  }
  return out;
}

Shares quadratic_shares(const Columns& parameters, const std::vector<double>& value) {
  Columns columns = parameters;
  for (const std::vector<double>& parameter : parameters) {
    const double centre = mean(parameter);
    std::vector<double> square;
    for (double p : parameter) square.push_back((p - centre) * (p - centre));
    columns.push_back(square);
  }
  const Regression fit = regress(columns, value);
  Shares out{{}, fit.r_squared};
  const std::size_t count = parameters.size();
  for (std::size_t k = 0; k < count && !fit.coefficient.empty(); ++k) {
    std::vector<double> part;
    for (std::size_t i = 0; i < value.size(); ++i) {
      part.push_back(fit.coefficient[k] * columns[k][i] + fit.coefficient[count + k] * columns[count + k][i]);
    }
    out.share.push_back(ratio_of_variances(part, value));
  }
  return out;
}

void take_shares(Distribution& out, const SampleValues& values) {
  Shares best;
  if (values.value.size() >= runs_per_unknown * (2 * values.parameters.size() + 1)) {
    best = quadratic_shares(values.parameters, values.value);
  }
  if (best.share.empty()) best = linear_shares(values.parameters, values.value);
  if (best.share.empty()) return;
  if (best.r_squared < enough_explained) {
    Columns columns;
    for (const std::vector<double>& parameter : values.parameters) columns.push_back(ranks(parameter));
    const Shares ranked = linear_shares(columns, ranks(values.value));
    if (!ranked.share.empty() && ranked.r_squared >= enough_explained) {
      best = ranked;
      out.note = "shares of the variance of the ranks: of the values a sum over the parameters explains too little";
    } else {
      out.note = "a sum over the parameters explains " + percent(best.r_squared) +
                 " of the variance: the shares do not add up, parameters act together or unevenly";
    }
  }
  out.shares = best.share;
  out.r_squared = best.r_squared;
}

Distribution distribution_of(const StudyData& data, const Sample& sample, int quantity) {
  const SampleValues values = sample_values(data, sample, quantity);
  Distribution out;
  out.quantity = quantity;
  out.count = static_cast<int>(values.value.size());
  out.left_out = static_cast<int>(sample.runs.size()) - out.count;
  out.axes = sample.axes;
  if (out.count == 0) return out;
  out.mean = mean(values.value);
  out.deviation = deviation(values.value);
  std::vector<double> sorted = values.value;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 0; k < Distribution::at.size(); ++k) out.quantiles[k] = quantile(sorted, Distribution::at[k]);
  take_shares(out, values);
  return out;
}

}  // namespace

std::vector<Distribution> find_distributions(const StudyData& data) {
  const std::vector<Sample> samples = find_samples(data);
  std::vector<Distribution> out;
  for (int q = 0; q < static_cast<int>(data.quantities.size()); ++q) {
    for (const Sample& sample : samples) {
      Distribution own = distribution_of(data, sample, q);
      if (samples.size() > 1) own.label = sample.label;
      if (own.count > 0) out.push_back(own);
    }
  }
  return out;
}

}  // namespace bowstring::study
