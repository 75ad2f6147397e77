#include "core/composition/numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/composition/units.hpp"

namespace bowstring {
namespace {

constexpr double unbounded = 1e308;

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit.empty() ? number : number + " " + unit;
}

/// "a number", "a quantity in N/mm or N/mm^2", "a number or a quantity in mm".
std::string kinds_of_number(const std::vector<std::string>& units) {
  bool plain = false;
  std::string quantities;
  for (const std::string& unit : units) {
    if (unit.empty()) {
      plain = true;
    } else {
      quantities += (quantities.empty() ? "a quantity in " : " or ") + unit;
    }
  }
  if (!plain) return quantities;
  return quantities.empty() ? "a number" : "a number or " + quantities;
}

/// Reads and checks one number.
class NumberReader {
 public:
  NumberReader(const Node& node, const std::string& subject, const NumberRules& rules, Report& report)
      : node_(node), subject_(subject), rules_(rules), report_(report) {}

  std::optional<Number> read() const {
    std::optional<Number> number;
    if (node_.type == Node::Type::integer || node_.type == Node::Type::number) {
      number = read_bare(node_.type == Node::Type::integer ? static_cast<double>(node_.integer) : node_.number);
    } else if (node_.is_text()) {
      number = read_text();
    } else {
      fail(subject_ + " is " + description(node_), expected_number(rules_), "write " + written_number(rules_));
    }
    return number && is_admissible(*number) ? number : std::nullopt;
  }

 private:
  void fail(const std::string& found, const std::string& expected, const std::string& mend) const {
    report_.error(node_.position, found, expected, mend);
  }

  std::optional<Number> read_bare(double value) const {
    const auto plain = std::find(rules_.units.begin(), rules_.units.end(), "");
    if (plain != rules_.units.end()) {
      return Number{value, static_cast<int>(plain - rules_.units.begin())};
    }
    if (rules_.units.size() == 1 || rules_.bare_means_first) return Number{value, 0};
    const std::string number = decimal(value);
    fail("ambiguous unit: " + subject_ + " is the bare number " + number, kinds_of_number(rules_.units),
         "write " + written_number(rules_, number) + ", which mean different things");
    return std::nullopt;
  }

  std::optional<Number> read_text() const {
    const std::optional<Quantity> quantity = split_quantity(node_.text);
    if (!quantity) {
      fail(subject_ + " is " + description(node_), expected_number(rules_), "write " + written_number(rules_));
      return std::nullopt;
    }
    const std::string number = decimal(quantity->number);
    if (quantity->unit.empty()) {
      const bool plain = rules_.units.front().empty();
      fail(subject_ + " is " + description(node_) + (plain ? "" : " without a unit"), expected_number(rules_),
           "write " + written_number(rules_, number));
      return std::nullopt;
    }
    return convert(*quantity);
  }

  std::optional<Number> convert(const Quantity& quantity) const {
    UnitOutcome outcome = UnitOutcome::other_dimension;
    for (std::size_t i = 0; i < rules_.units.size(); ++i) {
      const UnitConversion conversion = convert_unit(quantity.unit, rules_.units[i]);
      if (conversion.outcome == UnitOutcome::converted) {
        return Number{conversion(quantity.number), static_cast<int>(i)};
      }
      outcome = conversion.outcome;
    }
    fail_unit(quantity, outcome);
    return std::nullopt;
  }

  void fail_unit(const Quantity& quantity, UnitOutcome outcome) const {
    const std::string written = "write " + written_number(rules_, decimal(quantity.number));
    const std::string unit = "'" + quantity.unit + "'";
    if (outcome == UnitOutcome::no_database) {
      fail("unit " + unit + " of " + subject_ + " needs the UDUNITS-2 database, which cannot be read",
           expected_number(rules_), written + ", or install the database (libudunits2-data)");
    } else if (outcome == UnitOutcome::unknown_unit) {
      fail("unknown unit " + unit + " of " + subject_, expected_number(rules_), written);
    } else {
      fail("wrong unit: " + subject_ + " is " + description(node_), expected_number(rules_), written);
    }
  }

  bool is_admissible(const Number& number) const {
    const std::string& unit = rules_.units[static_cast<std::size_t>(number.alternative)];
    if (!std::isfinite(number.value)) {
      fail(subject_ + " is " + description(node_) + ", which is not finite", "a finite number",
           "write " + written_number(rules_));
      return false;
    }
    const bool low = rules_.lower_exclusive ? number.value <= rules_.lower : number.value < rules_.lower;
    const bool high = number.value > rules_.upper;
    if (!low && !high) return true;
    fail(subject_ + " is " + (node_.is_text() ? node_.text : decimal(number.value)) + ", out of bounds",
         expected_bounds(rules_.lower, rules_.upper, rules_.lower_exclusive, unit),
         std::string("write a ") + (low ? "larger" : "smaller") + " number");
    return false;
  }

  const Node& node_;
  const std::string& subject_;
  const NumberRules& rules_;
  Report& report_;
};

}  // namespace

NumberRules::NumberRules(const ParameterDeclaration& declaration)
    : lower(declaration.lower), upper(declaration.upper), lower_exclusive(declaration.lower_exclusive) {
  units.clear();
  std::string rest = declaration.unit == nullptr ? "" : declaration.unit;
  for (std::size_t bar = rest.find('|'); bar != std::string::npos; bar = rest.find('|')) {
    units.push_back(rest.substr(0, bar));
    rest.erase(0, bar + 1);
  }
  units.push_back(rest);
}

std::optional<Number> read_number(const Node& node, const std::string& subject, const NumberRules& rules,
                                  Report& report) {
  return NumberReader(node, subject, rules, report).read();
}

std::string expected_bounds(double lower, double upper, bool lower_exclusive, const std::string& unit) {
  std::string text;
  if (lower > -unbounded) {
    text = (lower_exclusive ? "more than " : "at least ") + with_unit(decimal(lower), unit);
  }
  if (upper < unbounded) {
    text += (text.empty() ? "at most " : " and at most ") + with_unit(decimal(upper), unit);
  }
  return text;
}

std::string expected_number(const NumberRules& rules) {
  const std::string bounds = expected_bounds(rules.lower, rules.upper, rules.lower_exclusive, "");
  return kinds_of_number(rules.units) + (bounds.empty() ? "" : ", ") + bounds;
}

std::string written_number(const NumberRules& rules, const std::string& number) {
  std::string text;
  for (const std::string& unit : rules.units) {
    text += text.empty() ? "" : " or ";
    text += unit.empty() ? number : "\"" + number + " " + unit + "\"";
  }
  return text;
}

}  // namespace bowstring
