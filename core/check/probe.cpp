#include "core/check/probe.hpp"

#include "core/check/unknowns.hpp"
#include "core/lie/s2.hpp"
#include "core/model/manifold.hpp"

namespace bowstring::checking {

namespace {

/// From body tangents at q·Exp δ to partial derivatives in δ: Jᵀg of each curved block.
void pull_back(const Assembly& assembly, const std::vector<double>& delta, std::vector<double>& gradient) {
  for (const FieldEntry& entry : assembly.entries()) {
    if (entry.block < 0 || !is_curved(entry.manifold)) continue;
    const int first = assembly.blocks().begin[at(entry.block)];
    double* g = gradient.data() + first;
    const double* x = delta.data() + first;
    if (entry.manifold == Manifold::rotation && assembly.blocks().size(entry.block) == 3) {
      (lie::right_jacobian(Vector3::load(x)).transpose() * Vector3::load(g)).store(g);
    } else if (entry.manifold == Manifold::direction && assembly.blocks().size(entry.block) == 2) {
      (lie::direction_chart(Vector2::load(x)).transpose() * Vector2::load(g)).store(g);
    }
  }
}

Status probe_terms(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta, Probe& out) {
  std::vector<double> energies, all;
  if (Status status = assembly.term_energies(q, energies); !status.ok()) return status;
  for (const double energy : energies) out.energy.push_back({energy});
  for (int e = 0; e < static_cast<int>(assembly.scene().energies.size()); ++e) {
    if (Status status = assembly.term_gradient(q, e, all); !status.ok()) return status;
    out.gradient.push_back(free_part(assembly, all));
    pull_back(assembly, delta, out.gradient.back());
  }
  return {};
}

Status probe_rows(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta,
                  const std::vector<double>& multipliers, Probe& out) {
  std::vector<double> rows(at(assembly.rows()));
  std::vector<double> jacobian(at(assembly.jacobian_pattern().entries()));
  ProblemEvaluation wanted;
  wanted.rows = rows;
  wanted.jacobian = jacobian;
  if (Status status = assembly.evaluate(q, wanted); !status.ok()) return status;
  for (const RowOrigin& origin : assembly.row_origins()) {
    out.rows.emplace_back(rows.begin() + origin.first, rows.begin() + origin.first + origin.count);
    out.pull.push_back(
        transposed_product(assembly.jacobian_pattern(), jacobian, origin, multipliers, assembly.unknowns()));
    pull_back(assembly, delta, out.pull.back());
  }
  return {};
}

void add(double factor, const std::vector<double>& numbers, std::vector<double>& out) {
  for (std::size_t k = 0; k < numbers.size(); ++k) out[k] += factor * numbers[k];
}

void sum(const Assembly& assembly, const std::vector<double>& multipliers, Probe& out) {
  out.lagrangian.assign(1, 0.0);
  out.lagrangian_gradient.assign(at(assembly.unknowns()), 0.0);
  for (const auto& energy : out.energy) add(energy_factor, energy, out.lagrangian);
  for (const auto& gradient : out.gradient) add(energy_factor, gradient, out.lagrangian_gradient);
  for (const auto& pull : out.pull) add(1.0, pull, out.lagrangian_gradient);
  for (std::size_t g = 0; g < out.rows.size(); ++g) {
    const RowOrigin& origin = assembly.row_origins()[g];
    for (std::size_t r = 0; r < out.rows[g].size(); ++r) {
      out.lagrangian[0] += multipliers[at(origin.first) + r] * out.rows[g][r];
    }
  }
}

}  // namespace

Probe probe(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta,
            const std::vector<double>& multipliers) {
  Probe out;
  std::vector<double> moved(q.size());
  assembly.retract(q, delta, moved);
  out.energy_status = probe_terms(assembly, moved, delta, out);
  out.row_status = probe_rows(assembly, moved, delta, multipliers, out);
  if (out.ok()) sum(assembly, multipliers, out);
  return out;
}

Status probe_energies(Assembly& assembly, const std::vector<double>& q, const std::vector<double>& delta,
                      std::vector<double>& out) {
  std::vector<double> moved(q.size());
  assembly.retract(q, delta, moved);
  return assembly.term_energies(moved, out);
}

}  // namespace bowstring::checking
