#include "core/check/invariances.hpp"

#include <algorithm>
#include <cmath>

#include "core/check/motion.hpp"
#include "core/check/unknowns.hpp"
#include "core/lie/so3.hpp"

namespace bowstring::checking {

namespace {

constexpr double unjudged = std::numeric_limits<double>::quiet_NaN();
constexpr double tolerance = 1e-8;  // of an energy, relative to itself
constexpr double turn = 0.7;        // rad: no edge comes near the half turn where a transported frame ends
constexpr double nothing = 1e-12;   // of the largest energy: so little is rounding
constexpr double felt = 1e-6;       // of an energy or a row: what changes by less does not change

constexpr int row_steps = 4;  // in which rows are turned along, …
constexpr int epochs = 3;     // … each with so many epochs, until axes that follow a curve have settled

struct Reading {
  Status status;
  std::vector<double> energy;
};

struct RowReading {
  Status status;
  std::vector<double> rows;
};

class InvarianceCheck {
 public:
  InvarianceCheck(Assembly& assembly, const State& state, CheckReport& report)
      : assembly_(assembly), scene_(assembly.scene()), state_(state), mover_(assembly), report_(report) {
    for (const auto& curve : scene_.curves) {
      const Vector3 middle = mover_.centre(state.q, curve->view.index);
      centre_ += middle / static_cast<double>(scene_.curves.size());
      size_ = std::max(size_, mover_.radius(state.q, curve->view.index));
    }
    shift_ = scene_.dimension == 2 ? Vector3{{0.6, -0.8, 0.0}} : Vector3{{0.6, -0.64, 0.48}};
    axis_ = scene_.dimension == 2 ? Vector3{{0.0, 0.0, 1.0}} : Vector3{{0.48, 0.64, -0.6}};
  }

  void run() {
    if (!settle(assembly_, state_.q).ok()) return;
    const RigidMotion shift{{}, 0.5 * size_ * shift_, centre_}, rotation{turn * axis_, {}, centre_};
    here_ = read(state_.q);
    if (!here_.status.ok()) return;  // the derivatives' lines have said so
    translated_[0] = read_moved(shift, -1.0);
    translated_[1] = read_moved(shift, 1.0);
    rotated_[0] = read_moved(rotation, -1.0);
    rotated_[1] = read_moved(rotation, 1.0);
    for (int e = 0; e < static_cast<int>(scene_.energies.size()); ++e) judge_term(e);
    if (assembly_.rows() > 0) {
      rows_here_ = read_rows({}, 0.0);
      rows_translated_ = read_rows(shift, 1.0);
      rows_here_ = read_rows({}, 0.0);
      for (int k = 1; k <= row_steps; ++k) rows_rotated_ = read_rows(rotation, static_cast<double>(k) / row_steps);
    }
    for (const RowOrigin& origin : assembly_.row_origins()) judge_rows(origin);
    name_supports();
  }

 private:
  Reading read(const std::vector<double>& q) {
    Reading out;
    out.status = assembly_.term_energies(q, out.energy);
    return out;
  }

  /// The whole scene, moved by a multiple of a motion.
  Status moved(const RigidMotion& motion, double multiple, std::vector<double>& out) const {
    const RigidMotion part{multiple * motion.turn, multiple * motion.shift, motion.centre};
    std::vector<double> next;
    out = state_.q;
    for (const auto& curve : scene_.curves) {
      if (Status status = mover_.move(out, curve->view.index, part, next); !status.ok()) return status;
      out = next;
    }
    return {};
  }

  Reading read_moved(const RigidMotion& motion, double multiple) {
    std::vector<double> q;
    const Status status = moved(motion, multiple, q);
    return status.ok() ? read(q) : Reading{status, {}};
  }

  /// Rows may be written in axes that follow their curves from epoch to epoch.
  RowReading read_rows(const RigidMotion& motion, double multiple) {
    RowReading out;
    std::vector<double> q;
    out.status = moved(motion, multiple, q);
    for (int k = 0; k < epochs; ++k) {
      if (out.status.ok()) out.status = assembly_.accept(q);
      if (out.status.ok()) out.status = assembly_.new_epoch();
    }
    if (!out.status.ok()) return out;
    out.rows.resize(at(assembly_.rows()));
    ProblemEvaluation wanted;
    wanted.rows = out.rows;
    out.status = assembly_.evaluate(q, wanted);
    return out;
  }

  void line(CheckVerdict verdict, const std::string& subject, const std::string& what, double error,
            const std::string& text) {
    report_.invariances.push_back({verdict, subject, what, error, "", text});
  }

  void judge_term(int e) {
    const EnergyUse& use = scene_.energies[at(e)];
    const bool objective =
        std::all_of(use.laws.begin(), use.laws.end(), [](const LawUse& law) { return law.description.objective; });
    judge_motion(e, objective, "translation", translated_);
    judge_motion(e, objective, "rotation", rotated_);
    if (!objective) name_role(e);
  }

  /// What rounding may leave of an energy that vanishes, as the others are.
  double least_energy() const {
    double largest = 0.0;
    for (const double energy : here_.energy) largest = std::max(largest, std::fabs(energy));
    return nothing * largest;
  }

  double change(int e, const Reading& reading) const {
    const double before = here_.energy[at(e)], after = reading.energy[at(e)];
    const double larger = std::max({std::fabs(before), std::fabs(after), least_energy()});
    return larger > 0.0 ? std::fabs(after - before) / larger : 0.0;
  }

  void judge_motion(int e, bool objective, const char* what, const Reading (&moved)[2]) {
    if (!objective) return;
    const std::string name = term_name(scene_, e);
    for (const Reading& reading : moved) {
      if (!reading.status.ok())
        return line(CheckVerdict::note, name, what, unjudged, "not judged: " + reading.status.text);
    }
    const double worst = std::max(change(e, moved[0]), change(e, moved[1]));
    if (worst > tolerance) {
      line(CheckVerdict::failed, name, what, worst, "claims to be objective, and changes");
    } else if (scene_.curves[at(scene_.energies[at(e)].curve)]->view.rigid) {
      line(CheckVerdict::ok, name, what, worst, "its curve is rigid");
    } else if (std::fabs(here_.energy[at(e)]) <= least_energy()) {
      line(CheckVerdict::note, name, what, worst, "vanishes at " + state_.name + ": nothing was judged");
    } else {
      line(CheckVerdict::ok, name, what, worst, "");
    }
  }

  /// What a motion there and back does to an energy that claims nothing.
  std::string response(int e, const Reading (&moved)[2]) const {
    if (!moved[0].status.ok() || !moved[1].status.ok()) return "";
    const double back = moved[0].energy[at(e)], here = here_.energy[at(e)], forth = moved[1].energy[at(e)];
    const double size = std::max({std::fabs(back), std::fabs(here), std::fabs(forth)});
    const double resistance = back + forth - 2.0 * here;
    if (resistance > felt * size) return "resists";
    return std::fabs(forth - back) > felt * size || resistance < -felt * size ? "drives" : "ignores";
  }

  void name_role(int e) {
    const std::string name = term_name(scene_, e);
    const std::string translation = response(e, translated_), rotation = response(e, rotated_);
    if (translation.empty() || rotation.empty()) {
      const Status& status = translated_[0].status.ok() ? rotated_[0].status : translated_[0].status;
      return line(CheckVerdict::note, name, "role", unjudged, "not judged: " + status.text);
    }
    std::string text = translation == rotation ? translation + " translation and rotation"
                                               : translation + " translation, " + rotation + " rotation";
    const bool resists = translation == "resists" || rotation == "resists";
    if (resists && translation != "drives" && rotation != "drives") {
      text += ": it holds '" + scene_.curves[at(scene_.energies[at(e)].curve)]->name + "' in place";
    } else if (translation == "ignores" && rotation == "ignores") {
      text += ", though it does not claim to be objective";
    }
    line(CheckVerdict::ok, name, "role", unjudged, text);
  }

  /// How a group of rows takes a motion: they stay, they turn as vectors of the global axes do, or they change.
  enum class RowChange : int { none, turned, changed };
  RowChange row_change(const RowOrigin& origin, const RowReading& reading) const {
    double before = 0.0, after = 0.0, largest = 0.0;
    for (int r = origin.first; r < origin.first + origin.count; ++r) {
      const double a = rows_here_.rows[at(r)], b = reading.rows[at(r)];
      before += a * a;
      after += b * b;
      largest = std::max(largest, std::fabs(b - a));
    }
    if (largest <= felt * size_) return RowChange::none;
    return std::fabs(std::sqrt(after) - std::sqrt(before)) <= felt * size_ ? RowChange::turned : RowChange::changed;
  }

  void judge_rows(const RowOrigin& origin) {
    const std::string name = origin_name(scene_, origin);
    for (const RowReading* reading : {&rows_here_, &rows_translated_, &rows_rotated_}) {
      if (reading->status.ok()) continue;
      const std::string why = reading->status.text.empty() ? "a row has left its window" : reading->status.text;
      return line(CheckVerdict::note, name, "rows", unjudged, "not judged: " + why);
    }
    const bool by_translation = row_change(origin, rows_translated_) != RowChange::none;
    const RowChange by_rotation = row_change(origin, rows_rotated_);
    if (!by_translation && by_rotation != RowChange::changed) {
      const bool vectors = by_rotation == RowChange::turned;
      return line(CheckVerdict::ok, name, "rows", unjudged, vectors ? "turn with the scene" : "move with the scene");
    }
    const std::string by = !by_translation                     ? "rotation"
                           : by_rotation == RowChange::changed ? "translation and rotation"
                                                               : "translation";
    if (origin.constraint < 0) {
      line(CheckVerdict::failed, name, "rows", unjudged, "change under " + by + ", as a curve's own rows must not");
    } else {
      line(CheckVerdict::note, name, "rows", unjudged, "feel " + by + ": they stand in space");
    }
  }

  void name_supports() {
    for (const auto& curve : scene_.curves) {
      std::string text;
      for (int end = 0; end < 2; ++end) {
        const EndCondition& held = curve->view.end[end];
        const bool position = held.position_held[0] || held.position_held[1] || held.position_held[2];
        if (!position && !held.rotation_held && !held.edge_held) continue;
        text += (text.empty() ? "" : ", ") + std::string(end == 0 ? "first end " : "last end ") + curve->end_text[end];
      }
      const std::string name =
          std::string(curve->view.kind == CurveKind::wire ? "wire '" : "vessel '") + curve->name + "'";
      if (curve->view.rigid) text = "rigid";
      line(CheckVerdict::ok, name, "supports", unjudged, text.empty() ? "none" : text);
    }
  }

  Assembly& assembly_;
  const Scene& scene_;
  const State& state_;
  Mover mover_;
  CheckReport& report_;
  Vector3 centre_, shift_, axis_;
  double size_ = 0.0;
  Reading here_, translated_[2], rotated_[2];
  RowReading rows_here_, rows_translated_, rows_rotated_;
};

}  // namespace

void check_invariances(Assembly& assembly, const std::vector<State>& states, const CheckOptions&, CheckReport& report) {
  if (!states.empty()) InvarianceCheck(assembly, states.back(), report).run();
}

}  // namespace bowstring::checking
