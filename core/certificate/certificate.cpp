#include "core/certificate/certificate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/certificate/activity.hpp"
#include "core/contact/crossing.hpp"
#include "core/curve/arc_length.hpp"

namespace bowstring {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr double bound_reach = 1e-6;  // a real unknown so near its bound (relative) lies on it

std::string number(double value, int digits = 4) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// The larger of two; what is not a number counts as largest of all.
double worst(double current, double value) { return std::isnan(current) || value <= current ? current : value; }

/// Largest entry of the Lagrangian gradient that no active bound holds, in N.
void judge_stationarity(const Assembly& assembly, Span<const double> q, const std::vector<double>& full_gradient,
                        Certificate& out) {
  std::vector<double> value(at(assembly.unknowns()));
  assembly.values(q, value);
  const Scene& scene = assembly.scene();
  for (std::size_t u = 0; u < full_gradient.size(); ++u) {
    const int free = assembly.free_of_unknown()[u];
    if (free < 0) continue;
    const double lower = assembly.lower()[at(free)];
    const double upper = assembly.upper()[at(free)];
    double gradient = full_gradient[u];
    const bool at_lower = std::isfinite(lower) && value[at(free)] - lower <= bound_reach * (1.0 + std::fabs(lower));
    const bool at_upper = std::isfinite(upper) && upper - value[at(free)] <= bound_reach * (1.0 + std::fabs(upper));
    if (at_lower || at_upper) {
      for (const auto& curve : scene.curves) {
        const int local = static_cast<int>(u) - curve->unknown_begin;
        if (local < 0 || local >= curve->unknowns) continue;
        out.folds.push_back("a length of '" + curve->name + "' lies on its bound (" + number(value[at(free)]) +
                            " mm), which is no equilibrium of a curve");
      }
    }
    if (at_lower) gradient = std::min(gradient, 0.0);
    if (at_upper) gradient = std::max(gradient, 0.0);
    out.stationarity = worst(out.stationarity, std::fabs(gradient) / assembly.stationarity_scale()[at(free)]);
  }
}

void judge_rows(const Assembly& assembly, const std::vector<double>& residual, Span<const double> multipliers,
                Certificate& out) {
  bool any = false;
  for (int r = 0; r < assembly.rows(); ++r) {
    const double lower = assembly.row_lower()[at(r)];
    const double upper = assembly.row_upper()[at(r)];
    const double before = out.penetration;
    out.penetration = worst(worst(out.penetration, residual[at(r)] - upper), lower - residual[at(r)]);
    if (out.penetration != before) out.worst_row = r;
    if (lower == upper) continue;
    const RowSide side = row_side(lower, upper, residual[at(r)], multipliers[at(r)]);
    out.minimum_multiplier = any ? std::min(out.minimum_multiplier, side.multiplier) : side.multiplier;
    any = true;
    out.complementarity = worst(out.complementarity, std::fabs(side.multiplier) * side.distance);
    if (activity(side) == Activity::weak) out.weakly_active.push_back(r);
  }
}

void judge_folds(const Assembly& assembly, double minimum_stretch, Certificate& out) {
  bool any = false;
  for (const auto& curve : assembly.scene().curves) {
    const bool vessel = curve->view.kind == CurveKind::vessel;
    if (vessel && curve->view.rigid) continue;
    const double* p = assembly.table(curve->view.index, Site::node);
    const int d = curve->view.dimension;
    double previous[3] = {};
    double arc = 0.0;
    for (int i = 0; i + 1 < curve->view.nodes; ++i) {
      double edge[3] = {};
      double squared = 0.0;
      double turn = 0.0;
      for (int k = 0; k < d; ++k) {
        edge[k] = p[(i + 1) * d + k] - p[i * d + k];
        squared += edge[k] * edge[k];
        turn += edge[k] * previous[k];
      }
      std::copy_n(edge, 3, previous);
      const double length = std::sqrt(squared);
      const std::string turns_back = " turns by more than 90 degrees against the one before it";
      if (!vessel) {
        if (i > 0 && turn < 0.0) {
          out.wire_folds.push_back("edge " + std::to_string(i) + " of wire '" + curve->name +
                                   "' at s = " + number(arc) + " mm" + turns_back + ", which is no shape of a curve");
        }
        arc += length;
        continue;
      }
      const double stretch = length / curve->view.edge_length[i];
      out.minimum_stretch = any ? std::min(out.minimum_stretch, stretch) : stretch;
      out.maximum_stretch = any ? std::max(out.maximum_stretch, stretch) : stretch;
      any = true;
      const std::string place = " of vessel '" + curve->name + "' at s = " + number(curve->arc[at(i)]) + " mm";
      if (stretch <= minimum_stretch) {
        out.folds.push_back("edge " + std::to_string(i) + place + " has folded: stretch ratio " + number(stretch));
      } else if (i > 0 && turn < 0.0) {
        out.folds.push_back("edge " + std::to_string(i) + place + turns_back);
      }
    }
  }
}

std::vector<double> node_numbers(const Curve& curve) {
  std::vector<double> out;
  for (int i = 0; i < curve.view.nodes; ++i) out.push_back(i);
  return out;
}

void judge_crossings(const Assembly& assembly, Certificate& out) {
  const Scene& scene = assembly.scene();
  std::vector<std::pair<int, int>> seen;
  for (const ConstraintUse& use : scene.constraints) {
    if (use.scene.on.size() != 2 || use.scene.radius[1] == nullptr || !use.rows.inside_lumen) continue;
    const std::pair<int, int> pair{use.scene.on[0].index, use.scene.on[1].index};
    if (std::find(seen.begin(), seen.end(), pair) != seen.end()) continue;
    seen.push_back(pair);
    const Curve& wire = *scene.curves[at(pair.first)];
    const Curve& vessel = *scene.curves[at(pair.second)];
    if (wire.view.kind != CurveKind::wire || vessel.view.kind != CurveKind::vessel) continue;
    contact::Centerline wall;
    wall.dimension = scene.dimension;
    wall.nodes = vessel.view.nodes;
    wall.points = assembly.table(pair.second, Site::node);
    wall.radius = vessel.radius.data();
    contact::WirePolyline polyline;
    polyline.nodes = wire.view.nodes;
    polyline.points = assembly.table(pair.first, Site::node);
    polyline.radius = wire.radius.empty() ? nullptr : wire.radius.data();
    std::optional<double> start;
    if (use.scene.starts_along) start = interpolate_linearly(vessel.arc, node_numbers(vessel), wire.along_begin);
    PairPenetration found;
    found.wire = pair.first;
    found.vessel = pair.second;
    const contact::WallCheck checked = contact::check_wall(wall, polyline, start);
    found.dense = checked.dense;
    found.crossing = checked.crossing;
    if (found.crossing.crossed()) {
      const contact::Penetration& exit = found.crossing.exit;
      const auto segment = at(std::clamp(static_cast<int>(exit.vessel_coordinate), 0, vessel.view.nodes - 1));
      out.crossings.push_back("wire '" + wire.name + "' passes through the wall of '" + vessel.name +
                              "' between its rows, from wire s = " + number(exit.wire_arc) +
                              " mm, vessel s = " + number(vessel.arc[segment]) + " mm: " + number(exit.depth) +
                              " mm there, where a sound mesh allows " + number(found.crossing.allowance) + " mm");
    }
    out.pairs.push_back(found);
  }
}

/// Arc length (mm) of the curve as it lies, at a coordinate in edges.
double arc_at(const Assembly& assembly, const Curve& curve, double coordinate) {
  const double* p = assembly.table(curve.view.index, Site::node);
  const int d = curve.view.dimension;
  double arc = 0.0;
  for (int i = 0; i + 1 < curve.view.nodes && coordinate > i; ++i) {
    double squared = 0.0;
    for (int k = 0; k < d; ++k) squared += (p[(i + 1) * d + k] - p[i * d + k]) * (p[(i + 1) * d + k] - p[i * d + k]);
    arc += std::min(1.0, coordinate - i) * std::sqrt(squared);
  }
  return arc;
}

/// " in row 3 of 'lumen' (wire 'w' at s = 12 mm, vessel 'v' at s = 11 mm)"; empty where nothing is known of the row.
std::string place_of_row(Assembly& assembly, Span<const double> q, int row) {
  const Scene& scene = assembly.scene();
  for (const RowOrigin& origin : assembly.row_origins()) {
    const int within = row - origin.first;
    if (within < 0 || within >= origin.count) continue;
    std::string text = " in row " + std::to_string(within) + " of '" + origin.name + "'";
    if (origin.constraint >= 0) {
      std::vector<RowReport> reports;
      if (!assembly.report(q, origin.constraint, reports).ok() || at(within) >= reports.size()) return text;
      const RowReport& report = reports[at(within)];
      if (report.wire_curve < 0) return text;
      const Curve& wire = *scene.curves[at(report.wire_curve)];
      text += " (wire '" + wire.name + "' at s = " + number(arc_at(assembly, wire, report.wire_coordinate)) + " mm";
      if (report.vessel_curve >= 0) {
        const Curve& vessel = *scene.curves[at(report.vessel_curve)];
        const int last = vessel.view.nodes - 1;
        const int edge = std::clamp(static_cast<int>(report.vessel_coordinate), 0, last - 1);
        const double share = std::clamp(report.vessel_coordinate - edge, 0.0, 1.0);
        const double arc = (1.0 - share) * vessel.arc[at(edge)] + share * vessel.arc[at(edge + 1)];
        text += ", vessel '" + vessel.name + "' at s = " + number(arc) + " mm";
      }
      return text + ")";
    }
    if (origin.curve < 0) return text;
    const Curve& curve = *scene.curves[at(origin.curve)];
    int edge = -1, place = 0;
    for (const LocalRows& local : assembly.local_rows()) {
      if (local.first_row < origin.first || local.first_row >= origin.first + origin.count) continue;
      if (row >= local.first_row && row < local.first_row + local.rows) edge = place;
      ++place;
    }
    if (edge < 0 && origin.count == curve.view.nodes - 1) edge = within;
    if (edge < 0) return text;
    return text + " (edge " + std::to_string(edge) + " of '" + curve.name +
           "' at s = " + number(arc_at(assembly, curve, edge)) + " mm)";
  }
  return "";
}

std::string misses(const Certificate& c, const CertificateTable& t, const std::string& place) {
  std::string text;
  const auto add = [&](bool missed, const char* what, double value, double threshold, const char* unit,
                       const std::string& where = "") {
    if (!missed) return;
    text += (text.empty() ? "" : ", ") + std::string(what) + " " + number(value) + " " + unit + " (threshold " +
            number(threshold) + ")" + where;
  };
  add(!(c.stationarity <= t.stationarity), "stationarity", c.stationarity, t.stationarity, "N");
  add(!(c.penetration <= t.penetration), "row penetration", c.penetration, t.penetration, "mm", place);
  add(!(c.complementarity <= t.complementarity), "complementarity", c.complementarity, t.complementarity, "N mm");
  add(!(c.minimum_multiplier >= t.multiplier), "smallest multiplier", c.minimum_multiplier, t.multiplier, "N");
  return text;
}

/// What `require` asks for and the point does not have; empty: nothing.
std::string unmet(const CertificateTable& thresholds, const SecondOrder& second) {
  if (thresholds.require != "minimum" || second.curvature == Curvature::minimum) return "";
  const char* name = curvature_name(second.curvature);
  return "[certificate] require = \"minimum\": it is an equilibrium, but " +
         (name == nullptr ? "no second-order verdict exists" : "second order says " + std::string(name)) + " (" +
         second.reason + ")";
}

void conclude(const CertificateTable& thresholds, Claim claim, const std::string& claim_reason,
              const std::string& missed, Certificate& out) {
  const auto first = [](const std::vector<std::string>& texts) {
    return texts.empty() ? std::string() : texts.front();
  };
  std::string flaw, mend;
  if (!out.crossings.empty()) {
    flaw = first(out.crossings);
    mend = "; use a finer wire mesh, a constraint with rows between the nodes, or walk the load up";
  } else if (!out.folds.empty()) {
    flaw = first(out.folds);
    mend = "; give the vessel a stretch-stiffness, or a coarser mesh";
  } else if (!out.wire_folds.empty()) {
    flaw = first(out.wire_folds);
    mend = "; use a finer wire mesh, or push the wire less";
  }
  const std::string wanting = unmet(thresholds, out.second_order);
  if (out.first_order && flaw.empty() && !wanting.empty()) {
    out.verdict = Verdict::stalled;
    out.reason = wanting;
  } else if (out.first_order && flaw.empty()) {
    out.verdict = Verdict::converged;
    out.reason = "all thresholds of the certificate hold";
  } else if (out.first_order) {
    out.verdict = Verdict::invalid;
    out.reason = flaw + mend;
  } else {
    switch (claim) {
      case Claim::optimal:
      case Claim::stalled:
        out.verdict = Verdict::stalled;
        break;
      case Claim::infeasible:
        // The rows hold: the solver was stuck elsewhere, and the figures say so.
        out.verdict = out.penetration <= thresholds.penetration ? Verdict::stalled : Verdict::infeasible;
        break;
      case Claim::diverged:
        out.verdict = Verdict::diverged;
        break;
      case Claim::failed:
        out.verdict = Verdict::failed;
        break;
    }
    out.reason = claim_reason + "; " + missed + (flaw.empty() ? "" : "; " + flaw + mend);
  }
}

}  // namespace

const char* verdict_name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::converged:
      return "converged";
    case Verdict::invalid:
      return "invalid";
    case Verdict::stalled:
      return "stalled";
    case Verdict::infeasible:
      return "infeasible";
    case Verdict::diverged:
      return "diverged";
    case Verdict::failed:
      break;
  }
  return "failed";
}

std::optional<double> Certificate::dense_penetration() const {
  std::optional<double> deepest;
  for (const PairPenetration& pair : pairs) deepest = std::max(deepest.value_or(pair.dense.depth), pair.dense.depth);
  return deepest;
}

Status certify(Assembly& assembly, Span<const double> q, Span<const double> multipliers,
               const CertificateTable& thresholds, Claim claim, const std::string& claim_reason, Certificate& out) {
  out = {};
  std::vector<double> residual(at(assembly.rows()));
  ProblemEvaluation evaluation;
  evaluation.rows = residual;
  if (Status status = assembly.evaluate(q, evaluation); !status.ok()) return status;
  std::vector<double> gradient;
  if (Status status = assembly.full_gradient(q, multipliers, gradient); !status.ok()) return status;
  judge_stationarity(assembly, q, gradient, out);
  judge_rows(assembly, residual, multipliers, out);
  judge_folds(assembly, thresholds.minimum_stretch, out);
  judge_crossings(assembly, out);
  out.rounding_floor = assembly.rounding_floor();
  const bool rows_fail = !(out.penetration <= thresholds.penetration) && out.worst_row >= 0;
  const std::string missed = misses(out, thresholds, rows_fail ? place_of_row(assembly, q, out.worst_row) : "");
  out.first_order = missed.empty();
  if (out.first_order) {
    judge_second_order(assembly, q, multipliers, out.stationarity, out.second_order);
  } else {
    out.second_order.reason = "the first-order conditions are not met";
  }
  conclude(thresholds, claim, claim_reason, missed, out);
  return {};
}

}  // namespace bowstring
