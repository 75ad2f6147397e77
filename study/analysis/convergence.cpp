#include "study/analysis/convergence.hpp"

#include <algorithm>
#include <cmath>

#include "core/composition/nearest.hpp"
#include "study/analysis/richardson.hpp"
#include "study/analysis/statistics.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = 1e-12, equal_values = 1e-9;  // of the largest value
constexpr double noise_of_difference = 1e-3, noise_of_value = 1e-5;
constexpr double least_order = 0.5, least_low = 0.25;
constexpr double above_offset = 10.0;  // times the distance of limit and reference: errors that tell an order

struct Order {
  double value = Fit::unknown, low = Fit::unknown, high = Fit::unknown;
};

/// p and ln |C p| of ln size = ln |C p| + difference_shape(a, b, p), by Gauss–Newton: nearly linear in p.
Order fit_order(const std::vector<Difference>& differences) {
  const std::size_t count = differences.size();
  const auto shape = [&](double p) {
    std::vector<double> out;
    for (const Difference& d : differences) out.push_back(difference_shape(d, p));
    return out;
  };
  Order out;
  double p = 1.0, slopes = 0.0, squares = 0.0;
  for (int step = 0; step < 50; ++step) {
    const std::vector<double> here = shape(p), before = shape(p - 1e-4), after = shape(p + 1e-4);
    std::vector<double> slope(count), miss(count);
    for (std::size_t i = 0; i < count; ++i) {
      slope[i] = (after[i] - before[i]) / 2e-4;
      miss[i] = std::log(differences[i].size) - here[i];
    }
    const double mean_slope = mean(slope), mean_miss = mean(miss);
    double product = 0.0;
    slopes = squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      slopes += (slope[i] - mean_slope) * (slope[i] - mean_slope);
      product += (slope[i] - mean_slope) * (miss[i] - mean_miss);
      squares += (miss[i] - mean_miss) * (miss[i] - mean_miss);
    }
    if (!(slopes > 0.0)) return out;
    const double change = std::clamp(product / slopes, -2.0, 2.0);
    p = std::clamp(p + change, -20.0, 40.0);
    if (std::fabs(change) < 1e-12 * (1.0 + std::fabs(p))) break;
  }
  out.value = p;
  const int freedom = static_cast<int>(count) - 2;
  if (freedom < 1) return out;
  const double half = student_factor(freedom) * std::sqrt(squares / freedom / slopes);
  out.low = p - half;
  out.high = p + half;
  return out;
}

/// Leaves out those before the largest per e-fold of refinement, as long as three remain.
void leave_out_coarse(std::vector<Difference>& differences) {
  const auto pace = [](const Difference& d) { return std::isfinite(d.b) ? d.size / std::log(d.b / d.a) : d.size; };
  const auto largest =
      std::max_element(differences.begin(), differences.end(),
                       [&](const Difference& one, const Difference& other) { return pace(one) < pace(other); });
  if (differences.end() - largest >= 3) differences.erase(differences.begin(), largest);
}

class Judge {
 public:
  Judge(const Sequence& sequence, double target_error)
      : x_(sequence.resolution), f_(sequence.value), reference_(sequence.reference), target_(target_error) {
    for (double value : f_) largest_ = std::max(largest_, std::fabs(value));
  }

  Fit judge() {
    if (f_.size() < 3) return fit_;
    const auto [low, high] = std::minmax_element(f_.begin(), f_.end());
    if (*high - *low <= equal_values * largest_) return judge_equal();
    end_ = above_rounding();
    std::vector<Difference> differences;
    for (std::size_t i = 0; i < end_; ++i) {
      const double size = std::fabs(difference(i));
      if (size > rounding * largest_) differences.push_back({x_[i], x_[i + 1], size});
    }
    leave_out_coarse(differences);
    if (differences.size() < 2) {
      settle_at(f_[end_]);
      fit_.text = "settles to rounding" + beside_text();
      return fit_;
    }
    const Order own = fit_order(differences);
    take(own);
    if (!settles(own, differences)) return judge_moving();
    judge_settling();
    return fit_;
  }

 private:
  double difference(std::size_t i) const { return f_[i + 1] - f_[i]; }

  /// How many differences are above the rounding level.
  std::size_t above_rounding() const {
    std::size_t end = f_.size() - 1;
    while (end > 0 && std::fabs(difference(end - 1)) <= rounding * largest_) --end;
    double most = 0.0;
    for (std::size_t i = 0; i < end; ++i) most = std::max(most, std::fabs(difference(i)));
    std::size_t first_small = end;
    const double level = std::min(noise_of_difference * most, noise_of_value * largest_);
    while (first_small > 0 && std::fabs(difference(first_small - 1)) <= level) --first_small;
    for (std::size_t i = std::max<std::size_t>(first_small, 1); i < end; ++i) {
      const double fall = difference(i - 1) / difference(i);
      if (fall < std::sqrt(x_[i] / x_[i - 1])) return std::max<std::size_t>(i - 1, 2);
    }
    return end;
  }

  static bool settles(const Order& own, const std::vector<Difference>& differences) {
    double slowest = infinity;
    for (std::size_t i = 1; i < differences.size(); ++i) {
      slowest = std::min(slowest, order_of_two(differences[i - 1], differences[i]));
    }
    const std::size_t last = differences.size() - 1;
    const double last_order = order_of_two(differences[last < 2 ? 0 : last - 2], differences[last]);
    return own.value > least_order && (own.low > least_low || slowest > least_order) && last_order > least_low;
  }

  void take(const Order& order) {
    fit_.order = order.value;
    fit_.order_low = order.low;
    fit_.order_high = order.high;
  }

  void settle_at(double limit) {
    fit_.verdict = Settling::converges;
    fit_.limit = limit;
    const double left = std::fabs(limit - f_[end_]) / reference_scale();
    if (offset() > std::max(2.0 * left, 0.1 * target_)) fit_.beside = offset();
  }

  double reference_scale() const { return std::fabs(reference_) > 0.0 ? std::fabs(reference_) : 1.0; }
  double offset() const { return std::fabs(fit_.limit - reference_) / reference_scale(); }

  Fit judge_equal() {
    end_ = f_.size() - 1;
    settle_at(f_.back());
    const bool compared = std::isfinite(reference_), equal = offset() <= equal_values;
    if (compared && !equal) fit_.beside = offset();
    if (!compared || equal) fit_.verdict = Settling::exact;
    fit_.text = compared && equal ? "exact on every mesh" : "the same on every mesh" + beside_text();
    return fit_;
  }

  void judge_settling() {
    const std::vector<double> x(x_.begin(), x_.begin() + static_cast<std::ptrdiff_t>(end_) + 1);
    const std::vector<double> f(f_.begin(), f_.begin() + static_cast<std::ptrdiff_t>(end_) + 1);
    const Extrapolation extrapolation = extrapolate(x, f);
    settle_at(extrapolation.ok() ? extrapolation.limit : f.back());
    if (std::isfinite(reference_) && std::isnan(fit_.beside)) {
      const double uncertain = extrapolation.ok() ? extrapolation.error : std::fabs(difference(end_ - 1));
      const Order order = order_of_errors(uncertain);
      const double own_width = fit_.order_high - fit_.order_low;
      if (std::isfinite(order.low) && !(order.high - order.low >= own_width)) take(order);
    }
    fit_.text = (std::isnan(fit_.beside) ? "" : "settles, ") + order_words() + beside_text();
  }

  Order order_of_errors(double uncertain) const {
    const bool own_reference = f_.back() == reference_;
    const double apart = std::max(std::fabs(fit_.limit - reference_) - uncertain, 0.0);
    const double level = own_reference ? 0.0 : above_offset * apart;
    std::vector<Difference> errors;
    for (std::size_t i = 0; i <= end_ && !(own_reference && i + 1 == f_.size()); ++i) {
      const double size = std::fabs(f_[i] - reference_);
      if (size <= std::max(level, rounding * largest_) || (!errors.empty() && size >= errors.back().size)) break;
      errors.push_back({x_[i], own_reference ? x_.back() : infinity, size});
    }
    return errors.size() < 3 ? Order{} : fit_order(errors);
  }

  std::string order_words() const {
    const double half = 0.5 * (fit_.order_high - fit_.order_low);
    if (!std::isfinite(half)) return "order " + order_text(fit_.order);
    const int decimals = half < 0.05 ? 2 : 1;
    return "order " + order_text(fit_.order, decimals) + " ± " + order_text(half, decimals);
  }

  std::string beside_text() const {
    if (std::isnan(fit_.beside)) return "";
    const bool relative = std::fabs(reference_) > 0.0;
    return ", " + (relative ? percent(fit_.beside) : figure(fit_.beside, 2)) + " beside the reference";
  }

  Fit judge_moving() {
    fit_.verdict = Settling::does_not_settle;
    const std::size_t first = finer_half();
    const double way = difference(first), side = f_[first];
    bool steady = true;
    for (std::size_t i = first; i < f_.size(); ++i) {
      steady = steady && f_[i] * side > 0.0 && (i + 1 == f_.size() || difference(i) * way > 0.0);
    }
    fit_.text =
        steady ? "moves by " + percent(per_doubling()) + " with every doubling" : "scatters by " + percent(scatter());
    return fit_;
  }

  /// Where it begins; of at least three values.
  std::size_t finer_half() const { return std::min(f_.size() / 2, f_.size() - 3); }

  /// Of |f|, from the slope of ln |f| over ln x.
  double per_doubling() const {
    std::vector<double> log_x, log_f;
    for (std::size_t i = finer_half(); i < f_.size(); ++i) {
      log_x.push_back(std::log(x_[i]));
      log_f.push_back(std::log(std::fabs(f_[i])));
    }
    const Regression line = regress({log_x}, log_f);
    return line.coefficient.empty() ? 0.0 : std::fabs(std::expm1(line.coefficient[0] * std::log(2.0)));
  }

  double scatter() const {
    const auto [low, high] = std::minmax_element(f_.begin() + static_cast<std::ptrdiff_t>(finer_half()), f_.end());
    return (*high - *low) / std::max(std::fabs(*low), std::fabs(*high));
  }

  const std::vector<double>&x_, &f_;
  double reference_, target_, largest_ = 0.0;
  std::size_t end_ = 0;  // the last value that counts, and the number of differences that do
  Fit fit_;
};

}  // namespace

const char* settling_name(Settling settling) noexcept {
  switch (settling) {
    case Settling::converges:
      return "converges";
    case Settling::does_not_settle:
      return "does not settle";
    case Settling::exact:
      return "exact";
    case Settling::too_few:
      return "too few";
  }
  return "";
}

Fit fit_convergence(const Sequence& sequence, double target_error) {
  Fit fit = Judge(sequence, target_error).judge();
  const int values = static_cast<int>(sequence.value.size()), runs = values + sequence.failures;
  if (fit.verdict == Settling::too_few) {
    fit.text = "too few: " + std::to_string(values) + " of " + counted(runs, "run") + " converged, 3 are needed";
  } else if (sequence.failures > 0) {
    fit.text += "; " + std::to_string(sequence.failures) + " of " + counted(runs, "run") + " failed";
  }
  return fit;
}

}  // namespace bowstring::study
