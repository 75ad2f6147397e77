#include "core/compare/number_differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/json_words.hpp"

namespace bowstring {
namespace {

using Json = nlohmann::ordered_json;

/// Keys under which no two solves agree, or where people are spoken to.
constexpr std::array<std::string_view, 10> passed_over = {
    "seconds", "composition", "asked_composition",  "provenance", "warnings", "reason", "claim",
    "study",   "format",      "second_order_reason"};

constexpr std::size_t most_told = 20;

class BitDiffer {
 public:
  BitComparison run(const Json& a, const Json& b) {
    compare("", a, b);
    return std::move(out_);
  }

 private:
  void otherwise(const std::string& path, const std::string& how) {
    if (out_.otherwise.size() < most_told) out_.otherwise.push_back("'" + path + "' " + how);
  }

  static double number_of(const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  }

  static bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

  void compare(const std::string& path, const Json& a, const Json& b) {
    const auto numeric = [](const Json& value) { return value.is_number() || value.is_null(); };
    if (numeric(a) && numeric(b)) {
      if (a.is_null() && b.is_null()) return;
      ++out_.numbers;
      if (a.is_null() || b.is_null() || !same_bits(number_of(a), number_of(b))) {
        out_.different.push_back({path, number_of(a), number_of(b)});
      }
    } else if (a.is_object() && b.is_object()) {
      compare_tables(path, a, b);
    } else if (a.is_array() && b.is_array()) {
      compare_lists(path, a, b);
    } else if (a != b) {
      otherwise(path, "is " + shown(a) + " and " + shown(b));
    }
  }

  void compare_tables(const std::string& path, const Json& a, const Json& b) {
    for (const auto& [key, value] : a.items()) {
      if (is_passed_over(key)) continue;
      const std::string inner = path + (path.empty() ? "" : ".") + key;
      const auto other = b.find(key);
      if (other == b.end()) {
        otherwise(inner, "is in the first alone");
      } else {
        compare(inner, value, *other);
      }
    }
    for (const auto& [key, value] : b.items()) {
      if (!is_passed_over(key) && !a.contains(key)) {
        otherwise(path + (path.empty() ? "" : ".") + key, "is in the second alone");
      }
    }
  }

  void compare_lists(const std::string& path, const Json& a, const Json& b) {
    if (a.size() != b.size()) {
      return otherwise(path, "has " + std::to_string(a.size()) + " and " + std::to_string(b.size()) + " entries");
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      const std::string name = a[i].is_object() ? text_of(a[i], "name") : "";
      compare(path + "." + (name.empty() ? std::to_string(i) : name), a[i], b[i]);
    }
  }

  static bool is_passed_over(std::string_view key) {
    return std::find(passed_over.begin(), passed_over.end(), key) != passed_over.end();
  }

  BitComparison out_;
};

/// "curves.iliac.points" of "curves.iliac.points.12.0".
std::string kind_of(const std::string& path) {
  std::string out;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string step = path.substr(begin, end - begin);
    const bool position =
        !step.empty() && std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (!position) out += (out.empty() ? "" : ".") + step;
    begin = end + 1;
  }
  return out;
}

/// What is left of residuals, and how they got there: it differs by any factor where results hardly do.
bool is_of_solver(const std::string& kind) {
  const auto within = [&](std::string_view table) { return kind.find(table) != std::string::npos; };
  return within("certificate.") || within("solver.");
}

}  // namespace

double NumberDifference::relative() const noexcept {
  return a != 0.0 ? (b - a) / std::fabs(a) : std::numeric_limits<double>::quiet_NaN();
}

BitComparison compare_bits(const std::string& a, const std::string& b) {
  return BitDiffer().run(Json::parse(a), Json::parse(b));
}

std::vector<NumberDifference> largest_differences(const BitComparison& bits, std::size_t most) {
  struct Kind {
    double scale = 0.0, difference = -1.0;
    const NumberDifference* largest = nullptr;
  };
  constexpr double unknown = std::numeric_limits<double>::infinity();  // null on one side: told first
  std::map<std::string, Kind> kinds;
  for (const NumberDifference& one : bits.different) {
    Kind& kind = kinds[kind_of(one.path)];
    const double difference = std::isnan(one.absolute()) ? unknown : std::fabs(one.absolute());
    for (const double value : {one.a, one.b}) {
      if (std::isfinite(value)) kind.scale = std::max(kind.scale, std::fabs(value));
    }
    if (difference <= kind.difference) continue;
    kind.difference = difference;
    kind.largest = &one;
  }
  struct Place {
    bool of_solver;
    double share;
    const NumberDifference* difference;
  };
  std::vector<Place> order;
  for (const auto& [name, kind] : kinds) {
    const double share = kind.scale > 0.0 ? kind.difference / kind.scale : kind.difference;
    order.push_back({is_of_solver(name), share, kind.largest});
  }
  std::stable_sort(order.begin(), order.end(), [](const Place& a, const Place& b) {
    return a.of_solver != b.of_solver ? b.of_solver : a.share > b.share;
  });
  std::vector<NumberDifference> out;
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) out.push_back(*order[i].difference);
  return out;
}

}  // namespace bowstring
