#include "tests/study/analysis/fabricated.hpp"

#include <cmath>
#include <cstdio>
#include <limits>

namespace bowstring::testing {

using study::AxisData;
using study::RunData;
using study::Spacing;
using study::StudyData;

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::string shortest(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

}  // namespace

AxisData words_axis(const std::string& name, const std::vector<std::string>& labels) {
  AxisData out;
  out.name = out.column = name;
  out.label = labels;
  return out;
}

AxisData number_axis(const std::string& name, const std::vector<double>& numbers, const std::string& unit,
                     Spacing spacing) {
  AxisData out;
  out.name = out.column = name;
  out.unit = unit;
  out.number = numbers;
  out.spacing = spacing;
  for (double n : numbers) out.label.push_back(shortest(n) + (unit.empty() ? "" : " " + unit));
  return out;
}

StudyData study_of(const std::vector<AxisData>& axes, const std::vector<std::string>& quantities) {
  StudyData out;
  out.name = "fabricated";
  out.axes = axes;
  for (const std::string& name : quantities) out.quantities.push_back({name, "mm", "quantities." + name, {}, {}, ""});
  return out;
}

int add_run(StudyData& data, const std::vector<int>& choice) {
  RunData run;
  run.choice = choice;
  run.status = "converged";
  run.solve_seconds = 1.0;
  data.runs.push_back(run);
  for (study::QuantityData& quantity : data.quantities) {
    quantity.value.push_back(unknown);
    quantity.reference.push_back(unknown);
  }
  return static_cast<int>(data.runs.size()) - 1;
}

void add_product(StudyData& data) {
  std::vector<int> choice(data.axes.size(), 0);
  for (bool more = true; more;) {
    add_run(data, choice);
    more = false;
    bool sample_counted = false;
    for (std::size_t a = data.axes.size(); a-- > 0 && !more;) {
      const bool sampled = data.axes[a].spacing == Spacing::sampled;
      if (sampled && sample_counted) continue;
      sample_counted = sample_counted || sampled;
      const int next = choice[a] + 1;
      more = next < static_cast<int>(data.axes[a].label.size());
      for (std::size_t b = 0; b < data.axes.size(); ++b) {
        const bool together = sampled && data.axes[b].spacing == Spacing::sampled;
        if (b == a || together) choice[b] = more ? next : 0;
      }
    }
  }
}

void fill(StudyData& data, int quantity, const ValueOf& value) {
  for (std::size_t run = 0; run < data.runs.size(); ++run) {
    data.quantities[at(quantity)].value[run] = value(data, data.runs[run]);
  }
}

double number(const StudyData& data, const RunData& run, int axis) {
  return data.axes[at(axis)].number[at(run.choice[at(axis)])];
}

void fail(StudyData& data, int run, const std::string& status, const std::string& reason) {
  data.runs[at(run)].status = status;
  data.runs[at(run)].reason = reason;
  data.runs[at(run)].solve_seconds = unknown;
  for (study::QuantityData& quantity : data.quantities) quantity.value[at(run)] = unknown;
}

void refer(StudyData& data, int quantity, double reference) {
  data.quantities[at(quantity)].reference.assign(data.runs.size(), reference);
  data.quantities[at(quantity)].reference_text = "the known answer";
}

double halton(int k, int base) {
  double out = 0.0, weight = 1.0 / base;
  for (; k > 0; k /= base, weight /= base) out += weight * (k % base);
  return out;
}

StudyData sample_of_two(int count, const std::vector<std::string>& quantities) {
  std::vector<double> a, b;
  for (int k = 1; k <= count; ++k) {
    a.push_back(1.0 + 2.0 * halton(k, 2));
    b.push_back(2.0 + 2.0 * halton(k, 3));
  }
  StudyData data =
      study_of({number_axis("a", a, "", Spacing::sampled), number_axis("b", b, "", Spacing::sampled)}, quantities);
  add_product(data);
  return data;
}

StudyData anchoring_study() {
  StudyData data = study_of({words_axis("anchoring", {"per-length", "per-node"}),
                             words_axis("contact", {"same-index", "node-wise", "segment-wise"}),
                             number_axis("N", {20, 40, 80, 160, 320, 640})},
                            {"peak_displacement_mm"});
  data.along = 2;
  add_product(data);
  fill(data, 0, [](const StudyData& d, const RunData& run) {
    const double n = number(d, run, 2), amount = 100.0 * (1 + run.choice[1]);
    return run.choice[0] == 0 ? 9.75 - amount / (n * n) : 13.1 * std::pow(n / 40.0, -0.46) + 0.01 * run.choice[1];
  });
  refer(data, 0, 9.75);
  for (RunData& run : data.runs) {
    run.unknowns = static_cast<int>(number(data, run, 2)) * 4;
    run.solve_seconds = 1e-3 * number(data, run, 2) * (run.choice[1] == 2 ? 2.0 : 1.0);
  }
  return data;
}

}  // namespace bowstring::testing
