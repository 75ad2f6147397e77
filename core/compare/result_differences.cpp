#include "core/compare/result_differences.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/json_words.hpp"
#include "core/curve/arc_length.hpp"
#include "core/model/carried_curve.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double number_of(const Json* value) { return value != nullptr && value->is_number() ? value->get<double>() : unknown; }

double number_at(const Json& table, const char* key) { return number_of(find_key(table, key)); }

/// Every number that one of two tables has, a null included.
std::vector<NumberDifference> numbers_of(const Json& a, const Json& b) {
  std::vector<NumberDifference> out;
  const auto numeric = [](const Json* value) { return value != nullptr && (value->is_number() || value->is_null()); };
  const auto add = [&](const std::string& key) {
    const Json *in_a = find_key(a, key), *in_b = find_key(b, key);
    const double one = number_of(in_a), other = number_of(in_b);
    const bool known = std::isfinite(one) || std::isfinite(other);
    if (known && (in_a == nullptr || numeric(in_a)) && (in_b == nullptr || numeric(in_b))) {
      out.push_back({key, one, other});
    }
  };
  for (const auto& [key, value] : a.items()) add(key);
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) add(key);
  }
  return out;
}

double magnitude(const Json* force) {
  double square = 0.0;
  if (force == nullptr || !force->is_array()) return unknown;
  for (const Json& entry : *force) square += entry.is_number() ? entry.get<double>() * entry.get<double>() : unknown;
  return std::sqrt(square);
}

/// Named forces, in the order in which they are met.
class Forces {
 public:
  void take(const Json& document, double NumberDifference::*side) {
    side_ = side;
    for (const Json& contact : document["contacts"]) {
      const double force = number_at(contact, "force_N");
      const std::string vessel = text_of(contact, "vessel");
      const std::string where = text_of(contact, "wire") + (vessel.empty() ? "" : " on " + vessel);
      double& sum = at("contacts of " + where + ", sum");
      sum = (std::isnan(sum) ? 0.0 : sum) + force;
      double& largest = at("contacts of " + where + ", largest");
      largest = std::isnan(largest) ? force : std::max(largest, force);
    }
    for (const Json& support : document["supports"]) {
      at("support of " + text_of(support, "on") + ", " + text_of(support, "end") + " end") =
          magnitude(find_key(support, "force_N"));
    }
  }
  std::vector<NumberDifference> all;

 private:
  double& at(const std::string& name) {
    for (NumberDifference& one : all) {
      if (one.path == name) return one.*side_;
    }
    all.push_back({name, unknown, unknown});
    return all.back().*side_;
  }
  double NumberDifference::*side_ = nullptr;
};

/// Shares of the material at which either curve has a node.
std::vector<double> shares_of_both(const RecordedCurve& a, const RecordedCurve& b) {
  std::vector<double> out;
  std::set_union(a.share.begin(), a.share.end(), b.share.begin(), b.share.end(), std::back_inserter(out));
  return out;
}

CurveDifference curve_difference(const RecordedCurve& a, const RecordedCurve& b) {
  CurveDifference out;
  out.name = a.name;
  out.nodes_a = a.nodes();
  out.nodes_b = b.nodes();
  if (!a.flaw.empty() || !b.flaw.empty()) {
    out.unknown = a.flaw.empty() ? "B has it with " + b.flaw : "A has it with " + a.flaw;
  } else if (a.dimension != b.dimension) {
    out.unknown = "one is in the plane, the other in space";
  }
  if (!out.unknown.empty()) return out;
  const std::vector<double> share = shares_of_both(a, b);
  const std::vector<double> one = interpolated_points(a, share), other = interpolated_points(b, share);
  const std::vector<double> arc = polyline_arc(one, a.dimension);
  const auto d = static_cast<std::size_t>(a.dimension);
  std::vector<double> distance(share.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    double square = 0.0;
    for (std::size_t k = 0; k < d; ++k) square += std::pow(one[d * i + k] - other[d * i + k], 2);
    distance[i] = std::sqrt(square);
    if (distance[i] > out.largest) out.largest = distance[i], out.largest_share = share[i];
    if (i > 0) out.mean += 0.5 * (distance[i] + distance[i - 1]) * (arc[i] - arc[i - 1]) / arc.back();
  }
  return out;
}

std::vector<CurveDifference> curve_differences(const std::string& a, const std::string& b) {
  std::vector<DocumentFlaw> ignored;  // of the state, which curves do without
  const RecordedState one = read_recorded_state(a, "A", ignored), other = read_recorded_state(b, "B", ignored);
  std::vector<CurveDifference> out;
  const auto alone = [&](const RecordedCurve& curve, const char* where) {
    CurveDifference difference;
    difference.name = curve.name;
    difference.unknown = where;
    out.push_back(std::move(difference));
  };
  for (const RecordedCurve& curve : one.curves) {
    if (const RecordedCurve* partner = other.find(curve.name)) {
      out.push_back(curve_difference(curve, *partner));
    } else {
      alone(curve, "only in A");
    }
  }
  for (const RecordedCurve& curve : other.curves) {
    if (one.find(curve.name) == nullptr) alone(curve, "only in B");
  }
  return out;
}

/// The value of each entry of `losses`, by its name.
Json loss_values(const Json& document) {
  Json out = Json::object();
  const Json* losses = find_key(document, "losses");
  if (losses == nullptr || !losses->is_array()) return out;
  for (const Json& entry : *losses) {
    if (!entry.is_object()) continue;
    const Json* value = find_key(entry, "value");
    out[text_of(entry, "name")] = value != nullptr ? *value : Json();
  }
  return out;
}

WordDifference words(const std::string& name, const Json& a, const Json& b) {
  return {name, text_of(a, name.c_str()), text_of(b, name.c_str())};
}

std::vector<NumberDifference> chosen(const Json& a, const Json& b, std::initializer_list<const char*> keys) {
  std::vector<NumberDifference> out;
  for (const char* key : keys) {
    const double one = number_at(a, key), other = number_at(b, key);
    if (!std::isnan(one) || !std::isnan(other)) out.push_back({key, one, other});
  }
  return out;
}

Json table_at(const Json& parent, const char* key) {
  const Json* found = find_key(parent, key);
  return found != nullptr && found->is_object() ? *found : Json::object();
}

std::string started(const RecordedResult& result) {
  if (!result.predecessor.empty()) return "from the run " + result.predecessor;
  if (!result.start) return "from its own start";
  if (result.start->file.empty()) return "from a state in memory";
  return "from '" + result.start->file + "' (sha256 " + result.start->sha256.substr(0, 12) + "…)";
}

}  // namespace

ResultDifferences result_differences(const RecordedResult& a, const RecordedResult& b) {
  const Json one = Json::parse(a.text), other = Json::parse(b.text);
  ResultDifferences out;
  out.status = words("status", one, other);
  out.reason = words("reason", one, other);
  out.second_order = words("second_order", one["certificate"], other["certificate"]);
  out.quantities = numbers_of(one["quantities"], other["quantities"]);
  out.energies = numbers_of(one["energy"], other["energy"]);
  out.certificate = numbers_of(one["certificate"], other["certificate"]);
  out.losses = numbers_of(loss_values(one), loss_values(other));
  out.curves = curve_differences(a.text, b.text);
  Forces forces;
  forces.take(one, &NumberDifference::a);
  forces.take(other, &NumberDifference::b);
  out.forces = std::move(forces.all);
  out.effort = chosen(table_at(one, "problem"), table_at(other, "problem"), {"unknowns"});
  const std::vector<NumberDifference> counts =
      chosen(one["solver"], other["solver"], {"iterations", "factorizations", "evaluations", "epochs"});
  out.effort.insert(out.effort.end(), counts.begin(), counts.end());
  out.seconds = chosen(table_at(one["solver"], "seconds"), table_at(other["solver"], "seconds"), {"setup", "solve"});
  out.bits = compare_bits(a.text, b.text);
  return out;
}

int Comparison::things() const {
  const auto counted = std::count_if(composition.begin(), composition.end(), [](const CompositionDifference& one) {
    return one.matters && one.because_of.empty();
  });
  return static_cast<int>(counted) + (provenance.empty() ? 0 : 1);
}

Comparison compare_questions(const RecordedResult& a, const RecordedResult& b, Registry* registry) {
  Comparison out;
  out.composition = composition_differences(a.composition, b.composition, registry);
  out.provenance = provenance_differences(a.provenance, b.provenance, {"in A", "in B"});
  const bool other_document = a.start.has_value() != b.start.has_value() ||
                              (a.start && a.start->sha256 != b.start->sha256) || a.predecessor != b.predecessor;
  const bool told = std::any_of(out.composition.begin(), out.composition.end(), [](const auto& difference) {
    return difference.path == "start" || difference.path == "start.from";
  });
  if (other_document && !told) out.provenance.push_back("start: " + started(a) + " in A, " + started(b) + " in B");
  return out;
}

}  // namespace bowstring
