#include "core/composition/recorded_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "core/composition/json_words.hpp"
#include "core/composition/sha256.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// A list of numbers, or of lists of them, one after the other; what is none is not a number.
void add_numbers(const Json& value, std::vector<double>& out) {
  if (value.is_array()) {
    for (const Json& entry : value) add_numbers(entry, out);
  } else {
    out.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
}

std::vector<double> numbers_of(const Json& table, const char* key) {
  std::vector<double> out;
  const auto found = table.find(key);
  if (found != table.end() && found->is_array()) add_numbers(*found, out);
  return out;
}

RecordedCurve curve_of(const Json& entry) {
  RecordedCurve out;
  out.name = text_of(entry, "name");
  out.kind = text_of(entry, "kind") == "wire" ? CurveKind::wire : CurveKind::vessel;
  out.points = numbers_of(entry, "points");
  const auto points = entry.find("points");
  if (points != entry.end() && points->is_array() && !points->empty() && points->front().is_array()) {
    out.dimension = static_cast<int>(points->front().size());
  }
  out.frames = numbers_of(entry, "frames");
  out.share = numbers_of(entry, "material_share");
  out.along = text_of(entry, "along");
  const std::vector<double> span = numbers_of(entry, "span_mm");
  if (span.size() == 2) out.along_begin = span[0], out.along_end = span[1];
  const auto held = entry.find("held_frames");
  for (std::size_t e = 0; held != entry.end() && held->is_array() && e < std::min<std::size_t>(2, held->size()); ++e) {
    if ((*held)[e].is_array()) add_numbers((*held)[e], out.held_frame[e]);
  }
  return out;
}

class StateReader {
 public:
  StateReader(const Json& document, const std::string& name, std::vector<DocumentFlaw>& flaws)
      : document_(document), name_(name), flaws_(flaws) {}

  RecordedState read() {
    RecordedState out;
    if (!has_format()) return out;
    const Json* state = table_of(document_, "state", "");
    if (state == nullptr) return out;
    if (const Json* fields = table_of(*state, "fields", "state.")) read_numbers(*fields, "field", out.fields);
    if (const Json* groups = table_of(*state, "multipliers", "state.")) {
      read_numbers(*groups, "multipliers", out.multipliers);
    }
    read_manifolds(out.fields);
    read_curves(out.curves);
    return out;
  }

 private:
  void flaw(const std::string& found, const std::string& expected, const std::string& mend) {
    flaws_.push_back({name_ + " " + found, expected, mend});
  }

  bool has_format() {
    const auto format = document_.is_object() ? document_.find("format") : document_.end();
    if (format == document_.end()) {
      flaw("has no 'format'", written_by_solve, name_a_written_file);
      return false;
    }
    if (*format == result_format) return true;
    flaw("has format " + shown(*format), "\"" + std::string(result_format) + "\"",
         "solve it again with this version, which reads no other");
    return false;
  }

  const Json* table_of(const Json& parent, const char* key, const std::string& path) {
    const auto found = parent.find(key);
    if (found != parent.end() && found->is_object()) return &*found;
    flaw((found == parent.end() ? "has no '" + path + key + "'" : "has " + shown(*found) + " as '" + path + key + "'"),
         "a table of numbers by name", name_a_written_file);
    return nullptr;
  }

  void read_numbers(const Json& table, const char* kind, std::vector<NamedNumbers>& out) {
    for (const auto& [name, list] : table.items()) {
      const std::string owner = std::string(kind) + " '" + name + "'";
      NamedNumbers numbers;
      numbers.name = name;
      if (!list.is_array()) {
        flaw("has " + shown(list) + " as " + owner, "a list of numbers", name_a_written_file);
        continue;
      }
      for (const Json& entry : list) {
        const double value = entry.is_number() ? entry.get<double>() : std::nan("");
        if (!std::isfinite(value)) {
          flaw("has " + shown(entry) + " as number " + std::to_string(numbers.values.size()) + " of " + owner,
               "finite numbers", "start from a result whose state is known");
          break;
        }
        numbers.values.push_back(value);
      }
      if (numbers.values.size() == list.size()) out.push_back(std::move(numbers));
    }
  }

  /// A direction and a rotation both store four numbers, with another meaning.
  void read_manifolds(std::vector<NamedNumbers>& fields) const {
    const Json none = Json::array();
    const auto problem = document_.find("problem");
    const Json& declared =
        problem != document_.end() && problem->is_object() && problem->contains("fields") ? (*problem)["fields"] : none;
    for (const Json& field : declared) {
      if (!field.is_object() || !field.contains("name") || !field.contains("manifold")) continue;
      for (NamedNumbers& numbers : fields) {
        if (field["name"] == numbers.name && field["manifold"].is_string()) {
          numbers.manifold = field["manifold"].get<std::string>();
        }
      }
    }
  }

  void read_curves(std::vector<RecordedCurve>& curves) const {
    const auto list = document_.find("curves");
    if (list == document_.end() || !list->is_array()) return;
    for (const Json& entry : *list) {
      if (!entry.is_object() || text_of(entry, "name").empty()) continue;
      curves.push_back(curve_of(entry));
      curves.back().kinematics = kinematics_of(curves.back());
      find_flaw(curves.back());
    }
  }

  /// "nodes" of the wire or vessel of that name in the composition; "" where it does not say.
  std::string kinematics_of(const RecordedCurve& curve) const {
    const auto composition = document_.find("composition");
    const char* tables = curve.kind == CurveKind::wire ? "wire" : "vessel";
    if (composition == document_.end() || !composition->is_object() || !composition->contains(tables)) return "";
    for (const Json& table : (*composition)[tables]) {
      if (!table.is_object() || text_of(table, "name") != curve.name) continue;
      const auto kinematics = table.find("kinematics");
      return kinematics != table.end() && kinematics->is_object() ? text_of(*kinematics, "type") : "";
    }
    return "";
  }

  const Json& document_;
  const std::string& name_;
  std::vector<DocumentFlaw>& flaws_;
};

}  // namespace

void find_flaw(RecordedCurve& curve) {
  constexpr double unit_length = 1e-6;
  const auto finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
  };
  const auto is_rotation = [&](const double* q) {
    return std::fabs(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) - 1.0) <= unit_length;
  };
  const std::size_t nodes = curve.share.size(), d = static_cast<std::size_t>(curve.dimension);
  curve.flaw.clear();
  if (nodes == 0) {
    curve.flaw = "no 'material_share', which older versions did not write";
  } else if (nodes < 3 || (d != 2 && d != 3) || curve.points.size() != nodes * d || !finite(curve.points)) {
    curve.flaw = "'points' that are not known";
  } else if (!finite(curve.share) || curve.share.front() != 0.0 || curve.share.back() != 1.0 ||
             std::adjacent_find(curve.share.begin(), curve.share.end(), [](double a, double b) { return a >= b; }) !=
                 curve.share.end()) {
    curve.flaw = "a 'material_share' that does not grow from 0 to 1";
  } else if (curve.frames.size() != 4 * nodes || !finite(curve.frames)) {
    curve.flaw = "'frames' that are not known";
  }
  for (std::size_t i = 0; curve.flaw.empty() && i < nodes; ++i) {
    if (!is_rotation(curve.frames.data() + 4 * i)) curve.flaw = "'frames' that are no unit quaternions";
  }
  for (const std::vector<double>& held : curve.held_frame) {
    if (!curve.flaw.empty() || held.empty()) continue;
    if (held.size() != 4 || !finite(held) || !is_rotation(held.data())) {
      curve.flaw = "'held_frames' that are no unit quaternions";
    }
  }
}

const RecordedCurve* RecordedState::find(const std::string& curve) const noexcept {
  for (const RecordedCurve& one : curves) {
    if (one.name == curve) return &one;
  }
  return nullptr;
}

RecordedState read_recorded_state(const std::string& text, const std::string& name, std::vector<DocumentFlaw>& flaws) {
  Json document;
  try {
    document = Json::parse(text);
  } catch (const Json::exception& error) {
    flaws.push_back({name + " is no JSON (" + problem_of(error) + ")", written_by_solve, name_a_written_file});
    return {};
  }
  RecordedState out = StateReader(document, name, flaws).read();
  out.sha256 = sha256_hex(text);
  return out;
}

}  // namespace bowstring
