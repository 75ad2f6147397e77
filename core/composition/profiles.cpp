#include "core/composition/profiles.hpp"

#include <optional>
#include <vector>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"

namespace bowstring {
namespace {

const std::vector<std::string> profile_forms{"table", "segments", "column"};

NumberRules arc_rules() {
  NumberRules rules;
  rules.units = {"mm"};
  return rules;
}

/// Reads one profile that is written as a table.
class ProfileReader {
 public:
  ProfileReader(const std::string& subject, const NumberRules& rules, ParameterValue& out, Report& report)
      : subject_(subject), rules_(rules), out_(out), report_(report) {}

  bool read(const Node& node) {
    const bool keys_known = check_keys(
        node, subject_, {"table", "segments", "column", "unit", "measured-from", "factor"}, "remove it", report_);
    const Entry* form = the_form(node, keys_known);
    if (form == nullptr) return false;
    const bool form_good = read_form(*form) && read_unit(node, *form);
    const bool origin_good = read_origin(node, form->key == "table");
    const bool factor_good = read_factor(node, form->key == "column");
    return keys_known && form_good && origin_good && factor_good;
  }

 private:
  bool fail(const Node& node, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(node.position, found, expected, mend);
    return false;
  }

  /// Null where there is not one; a misspelt key has then been reported already.
  const Entry* the_form(const Node& node, bool keys_known) {
    const Entry* form = nullptr;
    int forms = 0;
    for (const std::string& name : profile_forms) {
      if (const Entry* entry = node.find(name)) {
        form = entry;
        ++forms;
      }
    }
    if (forms == 1) return form;
    if (forms == 0 && !keys_known) return nullptr;
    fail(node, subject_ + " has " + (forms == 0 ? "none" : "more than one") + " of 'table', 'segments' and 'column'",
         "exactly one of them", "write a value, or a table with one of these keys");
    return nullptr;
  }

  bool read_form(const Entry& form) {
    if (form.key == "table") return read_table(form.value);
    if (form.key == "segments") return read_segments(form.value);
    out_.profile.form = Profile::Form::column;
    out_.profile.column = form.value.text;
    if (form.value.is_text() && !form.value.text.empty()) return true;
    return fail(form.value, "'column' of " + subject_ + " is " + description(form.value),
                "the name of a column of the geometry's point data", "write column = \"<name>\"");
  }

  bool read_table(const Node& table) {
    out_.profile.form = Profile::Form::table;
    if (!table.is_list() || table.items.empty()) {
      return fail(table, "'table' of " + subject_ + " is " + (table.is_list() ? "empty" : description(table)),
                  "a list of pairs [arc length, value]", "write table = [[\"0 mm\", <value>], …]");
    }
    bool good = true;
    for (const Node& row : table.items) good = read_row(row) && good;
    return good;
  }

  bool read_row(const Node& row) {
    if (!row.is_list() || row.items.size() != 2) {
      return fail(row, "a row of 'table' of " + subject_ + " is " + row_description(row), "a pair [arc length, value]",
                  "write [\"0 mm\", <value>]");
    }
    const auto arc = read_number(row.items[0], "an arc length of " + subject_, arc_rules(), report_);
    const bool value_good = read_value(row.items[1], "a value of " + subject_);
    if (!arc || !value_good) return false;
    std::vector<double>& arcs = out_.profile.arc;
    arcs.push_back(arc->value);
    if (arcs.size() < 2 || arcs[arcs.size() - 2] < arcs.back()) return true;
    return fail(row.items[0],
                "arc length " + decimal(arcs.back()) + " mm of " + subject_ + " follows " +
                    decimal(arcs[arcs.size() - 2]) + " mm",
                "arc lengths that increase", "sort the rows, one per arc length");
  }

  static std::string row_description(const Node& row) {
    return row.is_list() ? "a list of " + std::to_string(row.items.size()) : description(row);
  }

  bool read_segments(const Node& segments) {
    out_.profile.form = Profile::Form::segments;
    if (!segments.is_table() || segments.entries.empty()) {
      return fail(segments,
                  "'segments' of " + subject_ + " is " + (segments.is_table() ? "empty" : description(segments)),
                  "a table of values by segment label", "write segments = { <label> = <value> }");
    }
    bool good = true;
    for (const Entry& entry : segments.entries) {
      out_.profile.segment.push_back(entry.key);
      good = read_value(entry.value, "segment '" + entry.key + "' of " + subject_) && good;
    }
    return good;
  }

  /// Every value of a profile is in the same unit alternative, that of the first.
  bool read_value(const Node& node, const std::string& subject) {
    const std::optional<Number> number = read_number(node, subject, rules_, report_);
    if (!number) return false;
    const bool first = out_.profile.value.empty();
    out_.profile.value.push_back(number->value);
    if (first) out_.unit_alternative = number->alternative;
    if (number->alternative == out_.unit_alternative) return true;
    const auto unit = [&](int i) { return rules_.units[static_cast<std::size_t>(i)]; };
    return fail(node,
                subject + " is in " + unit(number->alternative) + ", an earlier one in " + unit(out_.unit_alternative),
                "one kind of unit in a profile", "write all values in " + unit(out_.unit_alternative));
  }

  /// A column's numbers carry no unit: where units mean different things, the user says which it is.
  bool read_unit(const Node& node, const Entry& form) {
    const Entry* unit = node.find("unit");
    const std::string expected = "one of: " + comma_separated(rules_.units);
    if (form.key != "column") {
      return unit == nullptr || fail(unit->value, "'unit' of " + subject_ + " without a 'column'",
                                     "units in the values themselves", "remove it");
    }
    if (unit == nullptr) {
      return rules_.units.size() == 1 ||
             fail(form.value, "'column' of " + subject_ + " without a unit", expected,
                  "write { column = \"" + form.value.text + "\", unit = \"" + rules_.units.front() + "\" }");
    }
    for (std::size_t i = 0; i < rules_.units.size(); ++i) {
      if (!unit->value.is_text() || unit->value.text != rules_.units[i]) continue;
      out_.unit_alternative = static_cast<int>(i);
      return true;
    }
    return fail(unit->value, "'unit' of " + subject_ + " is " + description(unit->value), expected,
                "write the unit that the column's numbers are in");
  }

  bool read_origin(const Node& node, bool allowed) {
    const Entry* origin = node.find("measured-from");
    if (origin == nullptr) return true;
    if (!allowed) {
      return fail(origin->value, "'measured-from' of " + subject_ + " without a 'table'", "it beside arc lengths only",
                  "remove it");
    }
    const std::string& name = origin->value.text;
    if (name == "tip") out_.profile.measured_from = Profile::Origin::tip;
    if (name == "sheath") out_.profile.measured_from = Profile::Origin::sheath;
    if (name == "tip" || name == "sheath") return true;
    return fail(origin->value, "'measured-from' of " + subject_ + " is " + description(origin->value),
                "'tip' or 'sheath'", "write one of them");
  }

  /// What lets one number vary a whole profile, as sweeps and samples need it.
  bool read_factor(const Node& node, bool is_column) {
    const Entry* entry = node.find("factor");
    if (entry == nullptr) return true;
    if (is_column) {
      return fail(entry->value, "'factor' of " + subject_ + " with a 'column'",
                  "it beside values that stand in the composition", "scale the column's own numbers");
    }
    NumberRules above_zero;
    above_zero.lower = 0.0;
    above_zero.lower_exclusive = true;
    const std::optional<Number> factor = read_number(entry->value, "'factor' of " + subject_, above_zero, report_);
    if (!factor) return false;
    for (double& value : out_.profile.value) value *= factor->value;
    return true;
  }

  const std::string& subject_;
  const NumberRules& rules_;
  ParameterValue& out_;
  Report& report_;
};

}  // namespace

bool read_profile(const Node& node, const std::string& subject, const NumberRules& rules, ParameterValue& out,
                  Report& report) {
  if (node.is_table()) return ProfileReader(subject, rules, out, report).read(node);
  const std::optional<Number> number = read_number(node, subject, rules, report);
  if (!number) return false;
  out.profile.form = Profile::Form::constant;
  out.profile.constant = number->value;
  out.unit_alternative = number->alternative;
  return true;
}

const char* origin_name(Profile::Origin origin) noexcept {
  switch (origin) {
    case Profile::Origin::tip:
      return "tip";
    case Profile::Origin::sheath:
      return "sheath";
    case Profile::Origin::first_end:
      break;
  }
  return "";
}

}  // namespace bowstring
