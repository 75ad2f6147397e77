#include "study/results/references.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "study/analysis/richardson.hpp"
#include "study/plan/references.hpp"

namespace bowstring::study {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

class ReferenceFinder {
 public:
  ReferenceFinder(const Plan& plan, StudyData& data)
      : study_(plan.study), reference_(plan.study.reference), data_(data) {
    if (reference_.axis < 0) return;
    for (std::size_t r = 0; r < data_.runs.size(); ++r) {
      families_[without_walk(study_, data_.runs[r].choice, reference_.axis)].push_back(r);
    }
  }

  void add() {
    for (std::size_t k = 0; k < data_.quantities.size(); ++k) {
      QuantityData& quantity = data_.quantities[k];
      quantity.reference.assign(data_.runs.size(), unknown);
      std::map<std::vector<int>, double> found;
      for (std::size_t r = 0; r < data_.runs.size(); ++r) quantity.reference[r] = value(k, r, found);
      const bool any = std::any_of(quantity.reference.begin(), quantity.reference.end(),
                                   [](double number) { return number == number; });
      if (any) quantity.reference_text = reference_.text;
    }
  }

 private:
  /// The choices of a run's reference: the run's own, but for the axes that are held; -1 along the reference's axis.
  std::vector<int> place_of(std::vector<int> choice) const {
    for (const auto& [axis, alternative] : reference_.at) choice[at(axis)] = alternative;
    return without_walk(study_, std::move(choice), reference_.axis);
  }

  double value(std::size_t quantity, std::size_t run, std::map<std::vector<int>, double>& found) const {
    switch (reference_.form) {
      case Reference::Form::none:
        return unknown;
      case Reference::Form::stored:
        return stored(quantity, data_.runs[run].choice);
      case Reference::Form::closed_form:
        return closed_form(quantity, run);
      case Reference::Form::finest:
      case Reference::Form::richardson:
        break;
    }
    const std::vector<int> place = place_of(data_.runs[run].choice);
    const auto [known, fresh] = found.emplace(place, unknown);
    if (fresh) known->second = of_family(quantity, place);
    return known->second;
  }

  double stored(std::size_t quantity, const std::vector<int>& choice) const {
    for (const StoredValues& values : reference_.stored) {
      const bool fits = std::all_of(values.at.begin(), values.at.end(),
                                    [&](const auto& place) { return choice[at(place.first)] == place.second; });
      if (fits && values.value[quantity]) return *values.value[quantity];
    }
    return unknown;
  }

  double closed_form(std::size_t quantity, std::size_t run) const {
    const std::string& expression = reference_.expression[quantity];
    if (expression.empty()) return unknown;
    std::vector<double> numbers;
    for (std::size_t a = 0; a < data_.axes.size(); ++a) {
      const AxisData& axis = data_.axes[a];
      numbers.push_back(axis.numeric() ? axis.number[at(data_.runs[run].choice[a])] : unknown);
    }
    std::string why;
    return evaluate(expression, study_, numbers, why);
  }

  double of_family(std::size_t quantity, const std::vector<int>& place) const {
    const auto family = families_.find(place);
    if (family == families_.end()) return unknown;
    const AxisData& axis = data_.axes[at(reference_.axis)];
    std::vector<std::pair<double, double>> points;  // mesh, value
    for (const std::size_t r : family->second) {
      const double number = data_.quantities[quantity].value[r];
      if (data_.runs[r].converged() && number == number) {
        points.emplace_back(axis.number[at(data_.runs[r].choice[at(reference_.axis)])], number);
      }
    }
    std::sort(points.begin(), points.end());
    if (points.empty()) return unknown;
    if (reference_.form == Reference::Form::finest) {
      return points.back().first == axis.number[at(axis.largest())] ? points.back().second : unknown;
    }
    std::vector<double> meshes, values;
    for (const auto& [mesh, number] : points) {
      meshes.push_back(mesh);
      values.push_back(number);
    }
    const Extrapolation limit = extrapolate(meshes, values);
    return limit.ok() ? limit.limit : unknown;
  }

  const StudyFile& study_;
  const Reference& reference_;
  StudyData& data_;
  std::map<std::vector<int>, std::vector<std::size_t>> families_;  // runs that differ along the reference's axis alone
};

}  // namespace

void add_references(const Plan& plan, StudyData& data) { ReferenceFinder(plan, data).add(); }

}  // namespace bowstring::study
