#pragma once

#include <string>
#include <vector>

#include "tests/recheck/curve_model.hpp"
#include "tests/recheck/wall.hpp"

namespace recheck {

/// The largest of what was found, and where. What is not a number is larger than any number.
struct Worst {
  double value = 0.0;
  std::string place;

  void see(double candidate, const std::string& where) {
    if (candidate <= value || value != value) return;
    value = candidate;
    place = where;
  }
};

/// What the rows of a document show, summed up over all of them.
struct RowFindings {
  Worst violation;        ///< mm
  Worst chord;            ///< mm: the largest gap along a chord of segment-wise contact, wherever its row stands
  Worst complementarity;  ///< N mm
  Worst negative;         ///< N: −multiplier of an inequality row
  double smallest_multiplier = std::numeric_limits<double>::infinity();
  Worst contact_entry;  ///< what `contacts` says against what was found: N or mm
};

/// Everything that rows are computed from; the gradient gets multiplier · ∇row.
struct RowWork {
  const Result* result = nullptr;
  const std::vector<CurveModel>* models = nullptr;
  Tape tape;
  std::vector<double> gradient;
  RowFindings findings;
};

/// p_{i+1} − p_i = l_i R_i e₁ of edge frames, |e_i| = l_i of wires by node positions. Throws std::runtime_error where
/// the multipliers are not as many as the rows.
void add_closure_rows(const CurveModel& model, RowWork& work);

/// axis·p = where the composition holds it, for ends held along some of their own axes.
void add_end_rows(const CurveModel& model, RowWork& work);

/// The wire of a contact, followed along the vessel.
struct Following {
  std::vector<WallPoint> samples;   ///< samples_per_segment of every chord, and the last node
  double crossing_allowance = 0.0;  ///< κh²/4, at most c, + c/20, mm
  Worst depth;                      ///< mm; −∞ or the largest

  bool crossed() const { return !(depth.value <= crossing_allowance); }
};

inline constexpr int samples_per_segment = 20;

/// The closest point on the SPLINE wall, from the wire's first end and continuously along its straight chords.
Following follow(const CurveModel& wire, const CurveModel& vessel);

/// Rows of one constraint; `entry` is the number of its first one in `contacts`.
void add_contact_rows(const Json& constraint, const Following& following, std::size_t entry, RowWork& work);

}  // namespace recheck
