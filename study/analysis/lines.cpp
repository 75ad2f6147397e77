#include "study/analysis/lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/composition/nearest.hpp"

namespace bowstring::study {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

int axis_of_lines(const StudyData& data) {
  if (data.along >= 0) return data.along;
  for (std::size_t a = 0; a < data.axes.size(); ++a) {
    if (data.axes[a].numeric() && !sampled(data.axes[a])) return static_cast<int>(a);
  }
  return -1;
}

/// Where a run stands along its line; runs in which that axis has no part come last.
std::vector<double> places(const StudyData& data, int over) {
  if (over < 0) return {};
  if (over == data.along) return resolutions(data);
  return data.axes[at(over)].number;
}

bool has_resolution(const AxisData& axis) {
  return axis.numeric() && std::all_of(axis.number.begin(), axis.number.end(), [](double n) { return n > 0.0; });
}

Sequence sequence_of(const StudyData& data, const Line& line, int quantity, const std::vector<double>& resolution) {
  Sequence out;
  for (int run : line.runs) {
    const int choice = data.runs[at(run)].choice[at(data.along)];
    if (choice < 0) continue;
    const bool refines = out.resolution.empty() || resolution[at(choice)] > out.resolution.back();
    if (!refines) continue;  // two alternatives of one size
    const double value = counted_value(data, quantity, run);
    if (!std::isfinite(value)) {
      ++out.failures;
      continue;
    }
    out.resolution.push_back(resolution[at(choice)]);
    out.value.push_back(value);
    out.reference = reference_of(data, quantity, run);
  }
  return out;
}

}  // namespace

bool sampled(const AxisData& axis) { return axis.spacing == Spacing::sampled; }

bool varies(const StudyData& data, int axis) {
  return std::any_of(data.runs.begin(), data.runs.end(),
                     [&](const RunData& run) { return run.choice[at(axis)] != data.runs[0].choice[at(axis)]; });
}

std::string choice_text(const AxisData& axis, int alternative) {
  return alternative < 0 ? "without " + axis.name : axis.name + " = " + axis.label[at(alternative)];
}

std::string short_choice_text(const AxisData& axis, int alternative) {
  return alternative < 0 || axis.numeric() ? choice_text(axis, alternative) : axis.label[at(alternative)];
}

std::vector<int> varying_axes(const StudyData& data) {
  std::vector<int> out;
  for (int a = 0; a < static_cast<int>(data.axes.size()); ++a) {
    if (varies(data, a)) out.push_back(a);
  }
  return out;
}

std::string run_label(const StudyData& data, const std::vector<int>& axes, int run) {
  std::vector<std::string> parts;
  for (int axis : axes) {
    const int choice = data.runs[at(run)].choice[at(axis)];
    if (choice >= 0) parts.push_back(short_choice_text(data.axes[at(axis)], choice));
  }
  return parts.empty() ? "baseline" : comma_separated(parts);
}

std::vector<double> resolutions(const StudyData& data) {
  const AxisData& axis = data.axes[at(data.along)];
  std::vector<double> out = axis.number;
  if (!has_resolution(axis)) {
    out.clear();
    for (std::size_t k = 0; k < axis.label.size(); ++k) out.push_back(static_cast<double>(k));
    return out;
  }
  const auto [low, high] = std::minmax_element(out.begin(), out.end());
  const int least = static_cast<int>(low - out.begin()), most = static_cast<int>(high - out.begin());
  long unknowns_least = 0, unknowns_most = 0;
  for (const RunData& run : data.runs) {
    if (run.choice[at(data.along)] == least) unknowns_least = std::max<long>(unknowns_least, run.unknowns);
    if (run.choice[at(data.along)] == most) unknowns_most = std::max<long>(unknowns_most, run.unknowns);
  }
  const bool a_width = unknowns_most > 0 && unknowns_least > unknowns_most;
  if (a_width) std::transform(out.begin(), out.end(), out.begin(), [](double n) { return 1.0 / n; });
  return out;
}

int finest_mesh(const StudyData& data) {
  if (data.along < 0) return -1;
  const std::vector<double> resolution = resolutions(data);
  std::vector<int> converged(resolution.size(), 0);
  for (const RunData& run : data.runs) {
    const int mesh = run.choice[at(data.along)];
    if (mesh >= 0) converged[at(mesh)] += run.converged();
  }
  const int most = converged.empty() ? 0 : *std::max_element(converged.begin(), converged.end());
  int finest = -1;
  for (int mesh = 0; mesh < static_cast<int>(converged.size()); ++mesh) {
    if (converged[at(mesh)] == 0 || 2 * converged[at(mesh)] < most) continue;
    if (finest < 0 || resolution[at(mesh)] > resolution[at(finest)]) finest = mesh;
  }
  return finest;
}

bool at_mesh(const StudyData& data, int run, int mesh) {
  return mesh < 0 || data.runs[at(run)].choice[at(data.along)] == mesh;
}

double counted_value(const StudyData& data, int quantity, int run) {
  if (!data.runs[at(run)].converged()) return std::numeric_limits<double>::quiet_NaN();
  return data.quantities[at(quantity)].value[at(run)];
}

double reference_of(const StudyData& data, int quantity, int run) {
  const QuantityData& own = data.quantities[at(quantity)];
  return own.has_reference() ? own.reference[at(run)] : std::numeric_limits<double>::quiet_NaN();
}

double relative_error(const StudyData& data, int quantity, int run) {
  const double reference = reference_of(data, quantity, run), size = std::fabs(reference);
  const double miss = std::fabs(data.quantities[at(quantity)].value[at(run)] - reference);
  return size > 0.0 ? miss / size : miss;
}

Lines find_lines(const StudyData& data) {
  Lines out;
  out.over = axis_of_lines(data);
  bool has_sample = false;
  for (std::size_t a = 0; a < data.axes.size(); ++a) {
    has_sample = has_sample || sampled(data.axes[a]);
    const bool chosen = static_cast<int>(a) != out.over && !sampled(data.axes[a]);
    if (chosen && varies(data, static_cast<int>(a))) out.axes.push_back(static_cast<int>(a));
  }
  std::map<std::vector<int>, std::size_t> known;
  for (std::size_t run = 0; run < data.runs.size(); ++run) {
    std::vector<int> choice;
    for (int axis : out.axes) choice.push_back(data.runs[run].choice[at(axis)]);
    const auto [entry, first] = known.emplace(choice, out.lines.size());
    if (first)
      out.lines.push_back(
          {out.axes.empty() ? "all runs" : run_label(data, out.axes, static_cast<int>(run)), choice, {}, {}});
    out.lines[entry->second].runs.push_back(static_cast<int>(run));
  }
  const std::vector<double> place = places(data, out.over);
  const auto place_of = [&](int run) {
    const int choice = out.over < 0 ? -1 : data.runs[at(run)].choice[at(out.over)];
    return choice < 0 ? std::numeric_limits<double>::infinity() : place[at(choice)];
  };
  const bool fitted = data.along >= 0 && has_resolution(data.axes[at(data.along)]) && !has_sample;
  for (Line& line : out.lines) {
    std::stable_sort(line.runs.begin(), line.runs.end(), [&](int a, int b) { return place_of(a) < place_of(b); });
    line.fits.resize(data.quantities.size());
    for (std::size_t q = 0; q < data.quantities.size() && fitted; ++q) {
      line.fits[q] = fit_convergence(sequence_of(data, line, static_cast<int>(q), place), data.target_error);
    }
  }
  return out;
}

}  // namespace bowstring::study
