#include "core/check/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/check/unknowns.hpp"

namespace bowstring::checking {

namespace {

constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double far_apart = 1e6;     // of the stiffness of two fields
constexpr double far_from_one = 1e3;  // of a row's gradient
constexpr double vanishing = 1e-9;    // of a row's gradient at the start
constexpr double row_reach = 1e-6;    // mm: so near its bound a row is active

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

/// Number of a field's tangent numbers that are rotations.
bool turns(const FieldGroup& group) {
  return group.field->manifold != Manifold::real && group.field->manifold != Manifold::vector;
}

class ScalingCheck {
 public:
  ScalingCheck(Assembly& assembly, CheckReport& report)
      : assembly_(assembly), report_(report), groups_(field_groups(assembly)) {
    for (const FieldGroup& group : groups_) {
      report_.fields.push_back({assembly.scene().curves[at(group.curve)]->name, group.field->name, turns(group),
                                group.end - group.begin, 0.0, 0.0, 0.0});
    }
    for (const RowOrigin& origin : assembly.row_origins()) {
      RowScale scale;
      scale.name = origin_name(assembly.scene(), origin);
      scale.rows = origin.count;
      scale.smallest_gradient = origin.count > 0 ? infinity : 0.0;
      report_.row_groups.push_back(scale);
    }
  }

  void run(const std::vector<State>& states) {
    for (std::size_t s = 0; s < states.size(); ++s) {
      if (settle(assembly_, states[s].q).ok()) read(states[s].q, s == 0);
    }
    compare_fields();
    for (const RowScale& scale : report_.row_groups) judge_rows(scale);
  }

 private:
  void read(const std::vector<double>& q, bool start) {
    std::vector<double> gradient(at(assembly_.unknowns())), rows(at(assembly_.rows()));
    std::vector<double> jacobian(at(assembly_.jacobian_pattern().entries()));
    ProblemEvaluation wanted;
    wanted.gradient = gradient;
    wanted.rows = rows;
    wanted.jacobian = jacobian;
    if (!assembly_.evaluate(q, wanted).ok()) return;
    for (std::size_t f = 0; f < groups_.size(); ++f) {
      double& largest = report_.fields[f].gradient;
      for (int u = groups_[f].begin; u < groups_[f].end; ++u) largest = std::max(largest, std::fabs(gradient[at(u)]));
    }
    read_row_gradients(jacobian, start);
    if (!start) return;
    read_diagonal(q);
    read_activity(rows);
  }

  void read_diagonal(const std::vector<double>& q) {
    const SparsityPattern pattern = assembly_.hessian_pattern();
    std::vector<double> hessian(at(pattern.entries())), none(at(assembly_.rows()), 0.0);
    diagonal_.assign(at(assembly_.unknowns()), 0.0);
    if (!assembly_.lagrangian_hessian(q, 1.0, none, hessian).ok()) return;
    for (int j = 0; j < assembly_.unknowns(); ++j) {
      for (int k = pattern.begin[at(j)]; k < pattern.begin[at(j) + 1]; ++k) {
        if (pattern.inner[at(k)] == j) diagonal_[at(j)] = std::fabs(hessian[at(k)]);
      }
    }
    for (std::size_t f = 0; f < groups_.size(); ++f) {
      if (groups_[f].begin == groups_[f].end) continue;
      const auto [low, high] =
          std::minmax_element(diagonal_.begin() + groups_[f].begin, diagonal_.begin() + groups_[f].end);
      report_.fields[f].smallest_diagonal = *low;
      report_.fields[f].largest_diagonal = *high;
    }
  }

  void read_row_gradients(const std::vector<double>& jacobian, bool start) {
    std::vector<double> per_mm(at(assembly_.unknowns()));
    for (std::size_t u = 0; u < per_mm.size(); ++u) per_mm[u] = 1.0 / assembly_.stationarity_scale()[u];
    const SymmetricProduct product = row_product(assembly_.jacobian_pattern(), jacobian, per_mm);
    for (std::size_t g = 0; g < report_.row_groups.size(); ++g) {
      const RowOrigin& origin = assembly_.row_origins()[g];
      RowScale& scale = report_.row_groups[g];
      for (int r = origin.first; r < origin.first + origin.count; ++r) {
        const double size = product.size[at(r)];
        scale.smallest_gradient = std::min(scale.smallest_gradient, size);
        scale.largest_gradient = std::max(scale.largest_gradient, size);
        if (start && size < vanishing) ++scale.vanishing;
      }
    }
  }

  void read_activity(const std::vector<double>& rows) {
    for (std::size_t g = 0; g < report_.row_groups.size(); ++g) {
      const RowOrigin& origin = assembly_.row_origins()[g];
      RowScale& scale = report_.row_groups[g];
      for (int r = origin.first; r < origin.first + origin.count; ++r) {
        const double below = assembly_.row_lower()[at(r)] - rows[at(r)],
                     above = rows[at(r)] - assembly_.row_upper()[at(r)];
        const double outside = std::max(below, above);
        scale.violation = std::max(scale.violation, outside);
        scale.active += std::fabs(outside) <= row_reach;
      }
    }
  }

  void line(CheckVerdict verdict, const std::string& subject, const std::string& what, const std::string& text) {
    report_.scaling.push_back({verdict, subject, what, unjudged, "", text});
  }

  /// The stiffest entry of a field in N/mm: angles divided by the edge length twice, a whole length taken as the same
  /// change of each of its edges.
  double stiffest_entry(const FieldGroup& group) const {
    const int edges = assembly_.scene().curves[at(group.curve)]->view.nodes - 1;
    const bool whole = group.field->manifold == Manifold::real && group.field->count == 1;
    double out = 0.0;
    for (int u = group.begin; u < group.end && !diagonal_.empty(); ++u) {
      const double mm = whole ? 1.0 / edges : assembly_.stationarity_scale()[at(u)];
      out = std::max(out, diagonal_[at(u)] / (mm * mm));
    }
    return out;
  }

  void compare_fields() {
    double softest = infinity, stiffest = 0.0;
    std::string soft_name, stiff_name;
    for (const FieldGroup& group : groups_) {
      const double own = stiffest_entry(group);
      if (own == 0.0) continue;  // rows or other fields hold it
      if (own < softest) softest = own, soft_name = group_name(assembly_, group);
      if (own > stiffest) stiffest = own, stiff_name = group_name(assembly_, group);
    }
    if (stiffest == 0.0) {
      return line(CheckVerdict::note, "unknowns", "stiffness", "no energy has a second derivative at the start");
    }
    std::string text = "largest entries from " + number(softest) + " N/mm (" + soft_name + ") to " + number(stiffest) +
                       " N/mm (" + stiff_name + ")";
    const bool apart = stiffest > far_apart * softest;
    if (apart) text += ": further apart than 1e6, so that rounding of the stiff ones hides the soft ones";
    line(apart ? CheckVerdict::note : CheckVerdict::ok, "unknowns", "stiffness", text);
  }

  void judge_rows(const RowScale& scale) {
    if (scale.rows == 0) return;
    std::string text = "|gradient| from " + number(scale.smallest_gradient) + " to " + number(scale.largest_gradient);
    const bool far = scale.largest_gradient > far_from_one || scale.largest_gradient < 1.0 / far_from_one;
    if (far) text += ": far from 1, so that its residual is no distance and its multiplier no force";
    if (scale.vanishing > 0)
      text += "; " + std::to_string(scale.vanishing) + " vanish at the start, as a squared gap does on a centerline";
    line(far ? CheckVerdict::note : CheckVerdict::ok, scale.name, "rows", text);
  }

  Assembly& assembly_;
  CheckReport& report_;
  std::vector<FieldGroup> groups_;
  std::vector<double> diagonal_;
};

}  // namespace

void check_scaling(Assembly& assembly, const std::vector<State>& states, CheckReport& report) {
  ScalingCheck(assembly, report).run(states);
}

}  // namespace bowstring::checking
