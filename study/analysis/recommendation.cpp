#include "study/analysis/recommendation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/composition/nearest.hpp"
#include "study/analysis/lines.hpp"
#include "study/analysis/statistics.hpp"
#include "study/analysis/words.hpp"

namespace bowstring::study {

namespace {

constexpr double noise_of_time = 1.2;  // a ratio below it says nothing
constexpr std::size_t few_numbers = 6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::vector<int> formulation_axes(const StudyData& data) {
  std::vector<int> words, numbers;
  for (int a = 0; a < static_cast<int>(data.axes.size()); ++a) {
    const AxisData& axis = data.axes[at(a)];
    if (a == data.along || axis.has_cases() || sampled(axis) || !varies(data, a)) continue;
    if (!axis.numeric()) words.push_back(a);
    if (axis.numeric() && axis.label.size() <= few_numbers) numbers.push_back(a);
  }
  return words.empty() ? numbers : words;
}

/// All cases of one formulation at one mesh.
struct Point {
  int mesh = -1;
  std::vector<int> runs;
  bool counts = true;
  double error = 0.0, seconds = 0.0;
};

class Finder {
 public:
  explicit Finder(const StudyData& data) : data_(data) {
    out_.axes = formulation_axes(data);
    if (data.along >= 0) resolution_ = resolutions(data);
  }

  Recommendation find() {
    if (data_.quantities.empty() || !data_.quantities[0].has_reference()) return out_;
    collect();
    for (auto& [choice, points] : formulations_) out_.candidates.push_back(candidate(choice, points));
    std::stable_sort(out_.candidates.begin(), out_.candidates.end(), better);
    if (out_.candidates.empty() || out_.candidates[0].points == 0) {
      out_.candidates.clear();
      return out_;
    }
    out_.text = out_.candidates[0].reaches ? choice_words() : nothing_words();
    out_.detail = detail();
    return out_;
  }

 private:
  static bool better(const Candidate& one, const Candidate& other) {
    if (one.reaches != other.reaches) return one.reaches;
    if (one.reaches) return one.seconds < other.seconds;
    if ((one.points > 0) != (other.points > 0)) return one.points > 0;
    return one.points > 0 && one.least_error < other.least_error;
  }

  void collect() {
    for (int run = 0; run < static_cast<int>(data_.runs.size()); ++run) {
      const RunData& record = data_.runs[at(run)];
      const int mesh = data_.along < 0 ? -1 : record.choice[at(data_.along)];
      if (data_.along >= 0 && mesh < 0) continue;
      if (!std::isfinite(reference_of(data_, 0, run))) continue;
      std::vector<int> choice;
      for (int axis : out_.axes) choice.push_back(record.choice[at(axis)]);
      std::vector<Point>& points = formulations_[choice];
      auto point = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p.mesh == mesh; });
      if (point == points.end()) point = points.insert(points.end(), Point{mesh, {}, true, 0.0, 0.0});
      point->runs.push_back(run);
    }
  }

  void measure(Point& point) const {
    std::vector<double> seconds;
    for (int run : point.runs) {
      const bool counts = std::isfinite(counted_value(data_, 0, run)) && data_.runs[at(run)].solve_seconds > 0.0;
      point.counts = point.counts && counts;
      if (!counts) continue;
      point.error = std::max(point.error, relative_error(data_, 0, run));
      seconds.push_back(data_.runs[at(run)].solve_seconds);
    }
    point.seconds = mean(seconds);
  }

  Candidate candidate(const std::vector<int>& choice, std::vector<Point>& points) const {
    Candidate out;
    out.choice = choice;
    if (!choice.empty()) out.label = run_label(data_, out_.axes, points[0].runs[0]);
    for (Point& point : points) {
      measure(point);
      for (int run : point.runs) out.failures += !data_.runs[at(run)].converged();
      out.of += static_cast<int>(point.runs.size());
    }
    points.erase(std::remove_if(points.begin(), points.end(), [](const Point& p) { return !p.counts; }), points.end());
    std::stable_sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return finer(a, b); });
    out.points = static_cast<int>(points.size());
    const Point* best = nullptr;
    const Point* fastest = nullptr;
    bool stays = true;
    for (const Point& point : points) {  // the finest first
      stays = stays && point.error <= data_.target_error;
      if (stays && (fastest == nullptr || point.seconds <= fastest->seconds)) fastest = &point;
      if (best == nullptr || point.error < best->error) best = &point;
    }
    if (best == nullptr) return out;
    const Point& chosen = fastest != nullptr ? *fastest : *best;
    out.reaches = fastest != nullptr;
    out.mesh = chosen.mesh;
    out.runs = chosen.runs;
    out.error = chosen.error;
    out.seconds = chosen.seconds;
    out.least_error = best->error;
    return out;
  }

  bool finer(const Point& one, const Point& other) const {
    return data_.along >= 0 && resolution_[at(one.mesh)] > resolution_[at(other.mesh)];
  }

  std::string mesh_text(const Candidate& c) const {
    return c.mesh < 0 ? "" : choice_text(data_.axes[at(data_.along)], c.mesh);
  }

  /// "per-length, node-wise at N = 40"
  std::string place(const Candidate& c) const {
    const std::string mesh = mesh_text(c);
    if (c.label.empty()) return mesh.empty() ? "this formulation" : mesh;
    return mesh.empty() ? c.label : c.label + " at " + mesh;
  }

  static std::string cost(const Candidate& c) {
    return (c.error == 0.0 ? "no error" : percent(c.error)) + " in " + seconds_text(c.seconds);
  }

  std::string target() const { return percent(data_.target_error); }

  std::string choice_words() {
    const std::vector<Candidate>& all = out_.candidates;
    const auto slower = std::find_if(all.begin(), all.end(), [&](const Candidate& c) {
      return !c.reaches || c.seconds > noise_of_time * all[0].seconds;
    });
    const auto even = slower - all.begin();
    std::string out = "Use " + place(all[0]);
    if (even == 2) {
      out += " or " + place(all[1]) + ": " + cost(all[0]) + " and " + cost(all[1]) + ", as fast as each other";
    } else {
      out += ": " + cost(all[0]);
    }
    const std::string as_fast = even > 2 ? "; " + std::to_string(even - 1) + " others are as fast" : "";
    if (slower != all.end() && slower->reaches) {
      add_clause(out, ", " + times(slower->seconds / all[0].seconds) + " faster than " + compared(*slower),
                 headline_length - characters(as_fast));
    }
    out += as_fast;
    const std::string others = losers_words();
    if (!others.empty() && !add_clause(out, "; " + others, headline_length)) left_out_ = others + ". ";
    return out;
  }

  static std::string times(double ratio) { return figure(ratio, 2) + " times"; }

  std::string nothing_words() const {
    const Candidate& best = out_.candidates[0];
    const std::string who = out_.axes.empty() ? "No run" : "No formulation";
    const std::string stays = best.least_error <= data_.target_error ? " and keeps it there" : "";
    return who + " brings " + data_.quantities[0].column + " within " + target() + stays + ": the most accurate is " +
           place(best) + ", with " + cost(best);
  }

  /// Those with a point, or else all.
  std::vector<const Candidate*> losers() const {
    std::vector<const Candidate*> all, measured;
    for (const Candidate& c : out_.candidates) {
      if (c.reaches) continue;
      all.push_back(&c);
      if (c.points > 0) measured.push_back(&c);
    }
    return measured.empty() ? all : measured;
  }

  /// What tells a candidate from the first: "with segment-wise", or its label where they differ in more than one axis.
  std::string compared(const Candidate& other) const {
    int differing = 0;
    std::size_t axis = 0;
    for (std::size_t k = 0; k < out_.axes.size(); ++k) {
      if (other.choice[k] != out_.candidates[0].choice[k]) ++differing, axis = k;
    }
    if (differing != 1 || out_.axes.size() == 1 || other.choice[axis] < 0) return other.label;
    return "with " + short_choice_text(data_.axes[at(out_.axes[axis])], other.choice[axis]);
  }

  bool always_loses(std::size_t axis, int alternative) const {
    return std::none_of(out_.candidates.begin(), out_.candidates.end(),
                        [&](const Candidate& c) { return c.reaches && c.choice[axis] == alternative; });
  }

  /// One or two alternatives that all losers and nobody else have, or how many losers there are.
  std::string losers_name(std::vector<const Candidate*> left, bool& several) const {
    const std::size_t count = left.size();
    std::vector<std::string> names;
    for (std::size_t k = 0; k < out_.axes.size(); ++k) {
      std::set<int> own;
      for (const Candidate* c : left) {
        if (always_loses(k, c->choice[k])) own.insert(c->choice[k]);
      }
      for (int alternative : own) names.push_back(short_choice_text(data_.axes[at(out_.axes[k])], alternative));
      left.erase(
          std::remove_if(left.begin(), left.end(), [&](const Candidate* c) { return own.count(c->choice[k]) > 0; }),
          left.end());
    }
    const bool named = left.empty() && names.size() <= 2;
    several = named ? names.size() > 1 : count > 1;
    if (named) return joined(names, " and ");
    return count == 1 ? losers().front()->label : std::to_string(count) + " others";
  }

  std::string nowhere() const {
    return data_.along < 0 ? " not converge in every case" : " no mesh on which all runs converge";
  }

  std::string losers_words() const {
    const std::vector<const Candidate*> all = losers();
    if (all.empty()) return "";
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate* c : all) {
      if (c->points > 0) least = std::min(least, c->least_error);
    }
    bool several = false;
    const std::string name = losers_name(all, several);
    if (!std::isfinite(least)) return name + (data_.along < 0 ? " did" : several ? " have" : " has") + nowhere();
    if (least <= data_.target_error) return name + (several ? " do" : " does") + " not stay within " + target();
    return name + " never " + (several ? "get" : "gets") + " below " + percent(least);
  }

  std::string candidate_words(const Candidate& c) const {
    std::string out = c.label.empty() ? "" : c.label + ": ";
    if (c.points == 0) {
      out += (data_.along < 0 ? "did" : "has") + nowhere();
    } else if (c.reaches) {
      out += (c.mesh < 0 ? "" : mesh_text(c) + ", ") + cost(c);
    } else {
      const bool crosses = c.least_error <= data_.target_error;
      out += (crosses ? "does not stay within " + target() : "never below " + percent(c.least_error));
      if (c.mesh >= 0) out += ", nearest at " + mesh_text(c);
    }
    if (c.failures > 0) out += " (" + std::to_string(c.failures) + " of " + counted(c.of, "run") + " failed)";
    return out;
  }

  std::string detail() const {
    std::vector<std::string> parts;
    for (const Candidate& c : out_.candidates) parts.push_back(candidate_words(c));
    std::string out = left_out_ + "To bring " + data_.quantities[0].column + " within " + target() + " of " +
                      data_.quantities[0].reference_text +
                      (data_.along < 0 ? ": " : ", and keep it there on finer meshes: ") + listed(parts);
    const std::size_t cases = out_.candidates[0].runs.size();
    if (cases > 1) out += " Errors are the largest, times the mean of " + std::to_string(cases) + " cases.";
    return out;
  }

  const StudyData& data_;
  std::vector<double> resolution_;
  std::map<std::vector<int>, std::vector<Point>> formulations_;
  Recommendation out_;
  std::string left_out_;  // of the text: too long
};

}  // namespace

Recommendation recommend(const StudyData& data) { return Finder(data).find(); }

}  // namespace bowstring::study
