#include "core/check/states.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/check/unknowns.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

constexpr int waves = 4;
constexpr int halvings = 6;
constexpr double pi = 3.14159265358979323846;

double size_limit(const Scene& scene, const Curve& curve) {
  double out = 0.01 * curve.arc.back();
  for (const auto& other : scene.curves) {
    if (other->view.kind != CurveKind::vessel) continue;
    for (const double radius : other->radius) out = std::min(out, 0.25 * radius);
  }
  return out;
}

double amplitude(const Assembly& assembly, const FieldGroup& group, const FieldEntry& entry, double value) {
  switch (entry.manifold) {
    case Manifold::vector:
      return size_limit(assembly.scene(), *assembly.scene().curves[at(group.curve)]);
    case Manifold::real:
      return 0.02 * (value != 0.0 ? std::fabs(value) : 1.0);
    default:
      return 0.1;
  }
}

}  // namespace

/// Sines along the curve with random coefficients, one set per tangent component of a field.
std::vector<double> smooth_displacement(const Assembly& assembly, const std::vector<double>& q, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> delta(at(assembly.unknowns()), 0.0);
  for (const FieldGroup& group : field_groups(assembly)) {
    double coefficient[3][waves];
    for (auto& component : coefficient) {
      for (int k = 0; k < waves; ++k) component[k] = uniform(random) / (k + 1);
    }
    for (int i = group.entry_begin; i < group.entry_end; ++i) {
      const FieldEntry& entry = assembly.entries()[at(i)];
      const double size = amplitude(assembly, group, entry, q[at(entry.coordinate)]);
      for (int c = 0; c < tangent_count(entry.manifold, entry.dimension); ++c) {
        const int u = assembly.free_of_unknown()[at(entry.unknown + c)];
        if (u < 0) continue;
        double sum = group.field->count == 1 ? 0.5 : 0.0;
        for (int k = 0; k < waves; ++k) sum += coefficient[c % 3][k] * std::sin((k + 1) * pi * entry.arc_fraction);
        delta[at(u)] = size * sum;
      }
    }
  }
  return delta;
}

std::vector<double> random_numbers(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> out(at(count));
  for (double& number : out) {
    const double x = uniform(random);
    number = (x < 0.0 ? -1.0 : 1.0) * (0.3 + 0.7 * std::fabs(x));
  }
  return out;
}

Status settle(Assembly& assembly, const std::vector<double>& q) {
  if (Status status = assembly.accept(q); !status.ok()) return status;
  if (assembly.epoch_due()) {
    if (Status status = assembly.new_epoch(); !status.ok()) return status;
  }
  double energy = 0.0;
  std::vector<double> gradient(at(assembly.unknowns())), rows(at(assembly.rows()));
  std::vector<double> jacobian(at(assembly.jacobian_pattern().entries()));
  ProblemEvaluation evaluation;
  evaluation.energy = &energy;
  evaluation.gradient = gradient;
  evaluation.rows = rows;
  evaluation.jacobian = jacobian;
  return assembly.evaluate(q, evaluation);
}

States make_states(Assembly& assembly, int perturbed, unsigned seed) {
  States out;
  const auto report = [&](CheckVerdict verdict, const std::string& name, const std::string& text) {
    out.lines.push_back({verdict, name, "evaluation", std::numeric_limits<double>::quiet_NaN(), "", text});
  };
  const std::vector<double> start = assembly.scene().start_coordinates();
  if (const Status status = settle(assembly, start); !status.ok()) {
    report(CheckVerdict::failed, "the start", status.text.empty() ? "a row has left its window" : status.text);
    return out;
  }
  out.list.push_back({"the start", start});
  for (int k = 1; k <= perturbed; ++k) {
    State state{"perturbed state " + std::to_string(k), start};
    std::vector<double> delta = smooth_displacement(assembly, start, seed + static_cast<unsigned>(k));
    Status status;
    int halved = 0;
    for (; halved <= halvings; ++halved) {
      assembly.retract(start, delta, state.q);
      status = settle(assembly, state.q);
      if (status.ok()) break;
      for (double& number : delta) number *= 0.5;
      (void)settle(assembly, start);
    }
    if (!status.ok()) {
      report(CheckVerdict::failed, state.name,
             "not even near the start: " + (status.text.empty() ? "a row has left its window" : status.text));
      continue;
    }
    if (halved > 0) {
      report(CheckVerdict::note, state.name,
             "only " + std::to_string(1 << halved) + " times nearer to the start could it be evaluated");
    }
    out.list.push_back(std::move(state));
  }
  return out;
}

}  // namespace bowstring::checking
