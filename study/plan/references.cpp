#include "study/plan/references.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include <muParser.h>
#include <nlohmann/json.hpp>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/read_file.hpp"
#include "core/simulation/document_path.hpp"
#include "study/plan/axes.hpp"

namespace bowstring::study {
namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class Reader {
 public:
  Reader(const StudyFile& study, Report& report) : study_(study), report_(report) {}

  Reference read(const Entry& entry) {
    const Node& table = entry.value;
    out_.position = entry.position.text();
    if (!check_is_table(table, "'reference'", "write [reference] with finest = \"N\"", report_)) return out_;
    check_keys(table, "[reference]", {"closed-form", "stored", "finest", "richardson", "at"}, "remove it", report_);
    std::vector<const Entry*> forms;
    for (const char* form : {"closed-form", "stored", "finest", "richardson"}) {
      if (const Entry* found = table.find(form)) forms.push_back(found);
    }
    if (forms.size() != 1) {
      report_.error(forms.size() > 1 ? forms[1]->position : entry.position,
                    forms.empty() ? "[reference] does not say what results are compared with"
                                  : "[reference] has both '" + forms[0]->key + "' and '" + forms[1]->key + "'",
                    "one of: closed-form, stored, finest, richardson", "leave one of them");
      return out_;
    }
    const Entry& form = *forms.front();
    const Entry* at = table.find("at");
    if (at != nullptr && form.key != "finest" && form.key != "richardson") {
      fail(at->position, "[reference] has 'at' beside '" + form.key + "'", "it beside finest or richardson",
           form.key == "stored" ? "write it into a row: stored = [{ at = { N = 80 }, peak_displacement_mm = 9.75 }]"
                                : "remove it");
    }
    if (form.key == "closed-form") read_closed_form(form);
    if (form.key == "stored") read_stored(form);
    if (form.key == "finest" || form.key == "richardson") read_axis(form, at);
    return out_;
  }

 private:
  void fail(const Position& position, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(position, found, expected, mend);
  }

  int quantity_called(const Entry& entry) {
    std::vector<std::string> known;
    for (std::size_t k = 0; k < study_.quantities.size(); ++k) {
      const QuantityOfInterest& quantity = study_.quantities[k];
      if (quantity.column == entry.key || quantity.path == entry.key) return static_cast<int>(k);
      known.push_back(quantity.column);
    }
    const std::vector<std::string> near = nearest_names(entry.key, known);
    fail(entry.position, "[reference] names '" + entry.key + "', which is no quantity of this study",
         "one of: " + comma_separated(known), near.empty() ? "add it to quantities" : did_you_mean(near));
    return -1;
  }

  void read_closed_form(const Entry& form) {
    out_.form = Reference::Form::closed_form;
    out_.text = "a closed form";
    out_.expression.resize(study_.quantities.size());
    if (!check_is_table(form.value, "'closed-form'", "write { peak_displacement_mm = \"F*L^3/(3*EI)\" }", report_))
      return;
    const std::vector<double> ones(study_.axes.size(), 1.0);
    for (const Entry& entry : form.value.entries) {
      const int k = quantity_called(entry);
      if (!entry.value.is_text()) {
        fail(entry.value.position, "the closed form of '" + entry.key + "' is " + description(entry.value),
             "an expression in quotes", "write it as in \"F*L^3/(3*EI)\"");
        continue;
      }
      std::string why;
      evaluate(entry.value.text, study_, ones, why);
      if (!why.empty()) {
        std::vector<std::string> names;
        for (const Axis& axis : study_.axes) {
          if (axis.data.numeric()) names.push_back(axis.data.name);
        }
        fail(entry.value.position, "the closed form of '" + entry.key + "' cannot be evaluated (" + why + ")",
             "numbers, + - * / ^, functions, _pi and the numeric axes: " + comma_separated(names),
             "mend the expression");
      } else if (k >= 0) {
        out_.expression[static_cast<std::size_t>(k)] = entry.value.text;
      }
    }
  }

  void read_stored(const Entry& form) {
    out_.form = Reference::Form::stored;
    out_.text = "stored values";
    const Node& value = form.value;
    if (value.is_text()) {
      read_document(value);
    } else if (value.is_list() && !value.items.empty()) {
      for (const Node& row : value.items) read_stored_row(row);
    } else {
      read_stored_row(value);
    }
  }

  /// Quantities and their values; of a part of the runs where it says `at`.
  void read_stored_row(const Node& row) {
    if (!check_is_table(row, "'stored'",
                        "write { peak_displacement_mm = 9.75 }, a list of such with at = { N = 80 }, or a result "
                        "document",
                        report_)) {
      return;
    }
    StoredValues values;
    values.value.resize(study_.quantities.size());
    for (const Entry& entry : row.entries) {
      if (entry.key == "at") {
        values.at = read_places(entry);
        continue;
      }
      const int k = quantity_called(entry);
      const bool whole = entry.value.type == Node::Type::integer;
      if (!whole && entry.value.type != Node::Type::number) {
        fail(entry.value.position, "the stored value of '" + entry.key + "' is " + description(entry.value), "a number",
             "write it in the quantity's own unit");
      } else if (k >= 0) {
        values.value[static_cast<std::size_t>(k)] =
            whole ? static_cast<double>(entry.value.integer) : entry.value.number;
      }
    }
    out_.stored.push_back(std::move(values));
  }

  void read_document(const Node& node) {
    out_.text = "the result " + node.text;
    std::filesystem::path file(node.text);
    if (node.position.source) file = node.position.source->directory / file;
    std::string text;
    if (const std::string why = read_file(file.string(), text); !why.empty()) {
      fail(node.position, "cannot read the reference '" + node.text + "' (" + why + ")",
           "a result document, as `bowstring solve --out` writes it",
           "paths are relative to the file that they stand in");
      return;
    }
    const Json document = Json::parse(text, nullptr, false);
    StoredValues values;
    values.value.resize(study_.quantities.size());
    bool any = false;
    for (std::size_t k = 0; k < study_.quantities.size(); ++k) {
      Selection found;
      if (!follow_path(document, study_.quantities[k].path, found).empty() || found.values.size() != 1) continue;
      if (!found.values.front()->is_number()) continue;
      values.value[k] = found.values.front()->get<double>();
      any = true;
    }
    out_.stored.push_back(std::move(values));
    if (any) return;
    fail(node.position, "the reference '" + node.text + "' holds none of the quantities",
         "a result document, as `bowstring solve --out` writes it", "name a result of this scene");
  }

  int axis_called(const std::string& name, const Position& position) {
    return find_axis(study_.axes, name, position, "[reference]", report_);
  }

  void read_axis(const Entry& form, const Entry* at) {
    const bool richardson = form.key == "richardson";
    out_.form = richardson ? Reference::Form::richardson : Reference::Form::finest;
    out_.axis = axis_called(form.value.text, form.value.position);
    if (out_.axis < 0) return;
    const Axis& axis = study_.axes[static_cast<std::size_t>(out_.axis)];
    if (!axis.data.numeric()) {
      fail(form.value.position,
           "'" + form.key + "' of [reference] is axis '" + axis.data.name + "', which has no numbers",
           "an axis of meshes", "name a numeric axis");
    } else if (richardson && axis.data.number.size() < 3) {
      fail(form.value.position,
           "'richardson' of [reference] is axis '" + axis.data.name + "' with " +
               std::to_string(axis.data.number.size()) + " values",
           "at least three meshes", "add values, or compare with finest = \"" + axis.data.name + "\"");
    }
    out_.text = richardson ? "extrapolation over " + axis.data.name
                           : "the run with " + axis.data.name + " = " +
                                 axis.data.label[static_cast<std::size_t>(axis.data.largest())];
    if (at != nullptr) out_.at = read_places(*at);
    for (const auto& [a, k] : out_.at) {
      const AxisData& data = study_.axes[static_cast<std::size_t>(a)].data;
      out_.text += ", " + data.name + " = " + data.label[static_cast<std::size_t>(k)];
    }
  }

  /// Axes, each at one of its alternatives.
  std::vector<std::pair<int, int>> read_places(const Entry& at) {
    std::vector<std::pair<int, int>> places;
    if (!check_is_table(at.value, "'at' of [reference]", "write at = { contact = \"segment-wise-contact\" }",
                        report_)) {
      return places;
    }
    for (const Entry& entry : at.value.entries) {
      const int a = axis_called(entry.key, entry.position);
      if (a < 0) continue;
      const Axis& axis = study_.axes[static_cast<std::size_t>(a)];
      const int k = find_alternative(axis, entry.value);
      if (k < 0) {
        fail(entry.value.position,
             "'at' of [reference] has " + description(entry.value) + ", which is no value of axis '" + entry.key + "'",
             "one of: " + comma_separated(axis.data.label),
             "the reference would not be reached: name a value of the axis");
      } else if (walked_with_the_reference(a)) {
        fail(entry.position, "'at' of [reference] holds '" + entry.key + "', along which the reference is looked for",
             "axes that are not walked with it", "remove it");
      } else {
        places.emplace_back(a, k);
      }
    }
    return places;
  }

  bool walked_with_the_reference(int axis) const {
    const std::vector<int> walked = walked_with(study_, out_.axis);
    return std::find(walked.begin(), walked.end(), axis) != walked.end();
  }

  const StudyFile& study_;
  Report& report_;
  Reference out_;
};

}  // namespace

Reference read_reference(const Entry* entry, const StudyFile& study, Report& report) {
  return entry == nullptr ? Reference{} : Reader(study, report).read(*entry);
}

double evaluate(const std::string& expression, const StudyFile& study, const std::vector<double>& numbers,
                std::string& why) {
  why.clear();
  try {
    mu::Parser parser;
    for (std::size_t a = 0; a < study.axes.size(); ++a) {
      if (study.axes[a].data.numeric()) parser.DefineConst(column_name(study.axes[a].data.name), numbers[a]);
    }
    parser.SetExpr(expression);
    return parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    why = error.GetMsg();
    return unknown;
  }
}

}  // namespace bowstring::study
