#include "core/check/derivatives.hpp"

#include <algorithm>
#include <cmath>

#include "core/check/sweep.hpp"
#include "core/check/unknowns.hpp"

namespace bowstring::checking {

namespace {

constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
constexpr double clearly = 0.01;  // of the error at the state itself: how small it has to be beside it
constexpr double beside = 0.1;    // of a perturbed state's displacement: how far a wrong derivative is looked at again

class DerivativeCheck {
 public:
  DerivativeCheck(Assembly& assembly, const std::vector<State>& states, const CheckOptions& options)
      : assembly_(assembly), states_(states) {
    sweep_.quantities = quantities(assembly);
    sweep_.directions = make_directions(assembly, options.seed);
    sweep_.multipliers = random_numbers(assembly.rows(), options.seed + 1000);
    sweep_.first_tolerance = options.first_tolerance;
    sweep_.second_tolerance = options.second_tolerance;
    findings_.resize(sweep_.quantities.size());
    seed_ = options.seed + 2000;
  }

  void run(CheckReport& report) {
    for (std::size_t s = 0; s < states_.size(); ++s) compare_at(s);
    report.directions = static_cast<int>(sweep_.directions.size());
    for (std::size_t k = 0; k < findings_.size(); ++k) report.derivatives.push_back(line(k));
  }

 private:
  void compare_at(std::size_t state) {
    const std::vector<double>& q = states_[state].q;
    if (!settle(assembly_, q).ok()) return;
    std::vector<Finding> found = compare(assembly_, q, state, sweep_, std::vector<char>(findings_.size(), 1));
    look_beside(state, found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (!found[k].failure.empty()) found[k].failure = states_[state].name + ": " + found[k].failure;
      findings_[k].add(found[k]);
    }
  }

  /// At a place where f is not smooth a claim may be the derivative of neither side: what holds a little beside such a
  /// state is not called wrong.
  void look_beside(std::size_t state, std::vector<Finding>& found) {
    std::vector<char> wanted;
    for (const Finding& finding : found) wanted.push_back(finding.wrong > 0 ? 1 : 0);
    if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return;
    // Smooth, so that no stiff term grows and hides the others' errors.
    std::vector<double> aside = smooth_displacement(assembly_, states_[state].q, seed_), q(states_[state].q.size());
    for (double& number : aside) number *= beside;
    assembly_.retract(states_[state].q, aside, q);
    if (!settle(assembly_, q).ok()) return;
    const std::vector<Finding> again = compare(assembly_, q, state, sweep_, wanted);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const bool holds = again[k].wrong == 0 && again[k].compared > 0 && again[k].error <= clearly * found[k].error;
      if (wanted[k] == 0 || !holds) continue;
      if (found[k].kinks == 0) found[k].kink = found[k].place;
      found[k].kinks += found[k].wrong;
      found[k].wrong = 0;
      found[k].error = again[k].error;
      found[k].place = again[k].place;
    }
  }

  /// "at row 3 (node 4 of 'wire'), along position of 'iliac', the start".
  std::string place_text(const Quantity& quantity, const Finding::Place& place) const {
    std::string out;
    if (quantity.kind == Quantity::Kind::rows) {
      out = "at " + row_name(assembly_, assembly_.row_origins()[at(quantity.index)].first + place.component) + ", ";
    } else if (quantity.second_order()) {
      out = "at " + unknown_name(assembly_, place.component) + ", ";
    }
    return out + "along " + sweep_.directions[place.direction].name + ", " + states_[place.state].name;
  }

  /// The unknown whose own difference misses the claimed gradient of a term most.
  std::string worst_unknown(int term, const Finding::Place& place) {
    const Direction& direction = sweep_.directions[place.direction];
    const std::vector<double>& q = states_[place.state].q;
    std::vector<double> all, before, after;
    if (!assembly_.term_gradient(q, term, all).ok()) return direction.name;
    const std::vector<double> claimed = free_part(assembly_, all), size = natural_steps(assembly_);
    std::vector<double> delta(at(assembly_.unknowns()), 0.0);
    int worst = direction.begin;
    double largest = -1.0;
    for (int u = direction.begin; u < direction.end; ++u) {
      const double h = middle_step * size[at(u)];
      delta[at(u)] = -h;
      const bool has_before = probe_energies(assembly_, q, delta, before).ok();
      delta[at(u)] = h;
      const bool has_after = probe_energies(assembly_, q, delta, after).ok();
      delta[at(u)] = 0.0;
      if (!has_before || !has_after) continue;
      const double miss = std::fabs((after[at(term)] - before[at(term)]) / (2.0 * h) - claimed[at(u)]) * size[at(u)];
      if (miss > largest) largest = miss, worst = u;
    }
    return unknown_name(assembly_, worst);
  }

  bool first_is_wrong(std::size_t k) const { return sweep_.quantities[k].second_order() && findings_[k - 1].wrong > 0; }

  CheckLine line(std::size_t k) {
    const Quantity& quantity = sweep_.quantities[k];
    const Finding& finding = findings_[k];
    CheckLine out{CheckVerdict::ok, quantity.subject, quantity.what, unjudged, "", ""};
    if (!finding.failure.empty()) {
      out.verdict = CheckVerdict::failed;
      out.text = finding.failure;
    } else if (first_is_wrong(k)) {
      out.verdict = CheckVerdict::note;
      out.text = "not judged: the " + sweep_.quantities[k - 1].what + " that it would be compared with is wrong";
    } else if (finding.wrong > 0) {
      out.verdict = CheckVerdict::failed;
      out.error = finding.error;
      out.where = place_text(quantity, finding.place);
      if (quantity.kind == Quantity::Kind::term_gradient) {
        out.where = "at " + worst_unknown(quantity.index, finding.place) + ", " + states_[finding.place.state].name;
      }
      out.text = "is not the derivative";
    } else {
      judge_good(quantity, finding, out);
    }
    return out;
  }

  bool is_rigid(int term) const {
    const Scene& scene = assembly_.scene();
    return scene.curves[at(scene.energies[at(term)].curve)]->view.rigid;
  }

  void judge_good(const Quantity& quantity, const Finding& finding, CheckLine& out) const {
    const auto remark = [&](CheckVerdict verdict, const std::string& text) {
      out.verdict = std::max(out.verdict, verdict);
      out.text += (out.text.empty() ? "" : "; ") + text;
    };
    if (finding.compared > 0) out.error = finding.error;
    if (finding.error > 0.0) out.where = place_text(quantity, finding.place);
    if (finding.kinks > 0) {
      out.where = place_text(quantity, finding.kink);
      const std::string more = finding.kinks > 1 ? ", in " + std::to_string(finding.kinks) + " comparisons" : "";
      remark(CheckVerdict::note, "not smooth" + more + ", elsewhere it holds");
    }
    if (finding.unreached > 0) {
      remark(CheckVerdict::note, "could not be evaluated along " + std::to_string(finding.unreached) + " of " +
                                     std::to_string(finding.unreached + finding.compared) +
                                     " directions at any step, where a row leaves its window or a plugin refuses");
    }
    if (finding.compared == 0 || !finding.vanishes) return;
    const bool first = !quantity.second_order();
    if (!quantity.reads_rows() && is_rigid(quantity.index)) return remark(CheckVerdict::ok, "its curve is rigid");
    remark(first ? CheckVerdict::note : CheckVerdict::ok,
           first ? "vanishes at every state: nothing was judged" : "vanishes");
  }

  Assembly& assembly_;
  const std::vector<State>& states_;
  Sweep sweep_;
  std::vector<Finding> findings_;
  unsigned seed_ = 0;
};

}  // namespace

void check_derivatives(Assembly& assembly, const std::vector<State>& states, const CheckOptions& options,
                       CheckReport& report) {
  if (!states.empty()) DerivativeCheck(assembly, states, options).run(report);
}

}  // namespace bowstring::checking
