#include "study/analysis/sample.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "study/analysis/lines.hpp"

namespace bowstring::study {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<Sample> find_samples(const StudyData& data) {
  std::vector<int> axes, others;
  for (int a = 0; a < static_cast<int>(data.axes.size()); ++a) {
    if (sampled(data.axes[at(a)])) {
      axes.push_back(a);
    } else if (a != data.along && varies(data, a)) {
      others.push_back(a);
    }
  }
  std::vector<Sample> out;
  if (axes.empty()) return out;
  const int mesh = finest_mesh(data);
  std::map<std::vector<int>, std::size_t> known;
  for (int run = 0; run < static_cast<int>(data.runs.size()); ++run) {
    const std::vector<int>& choice = data.runs[at(run)].choice;
    const bool has_part = std::all_of(axes.begin(), axes.end(), [&](int axis) { return choice[at(axis)] >= 0; });
    if (!has_part || !at_mesh(data, run, mesh)) continue;
    std::vector<int> key;
    for (int axis : others) key.push_back(choice[at(axis)]);
    const auto [entry, first] = known.emplace(key, out.size());
    if (first) out.push_back({run_label(data, others, run), axes, {}});
    out[entry->second].runs.push_back(run);
  }
  return out;
}

SampleValues sample_values(const StudyData& data, const Sample& sample, int quantity) {
  SampleValues out;
  out.parameters.resize(sample.axes.size());
  for (int run : sample.runs) {
    const double value = counted_value(data, quantity, run);
    if (!std::isfinite(value)) continue;
    out.value.push_back(value);
    for (std::size_t k = 0; k < sample.axes.size(); ++k) {
      const int axis = sample.axes[k];
      out.parameters[k].push_back(data.axes[at(axis)].number[at(data.runs[at(run)].choice[at(axis)])]);
    }
  }
  return out;
}

}  // namespace bowstring::study
