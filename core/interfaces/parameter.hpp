#pragma once

#include <string>
#include <vector>

#include "core/interfaces/status.hpp"

namespace bowstring {

enum class ParameterType : int { scalar, profile, vector, path, choice, integer, flag, text, names, list };

/// The one declaration of a parameter: parser, default, bounds, `describe`, documentation and the resolved
/// composition all come from it. Plain constants, so that a schema is a static table.
struct ParameterDeclaration {
  const char* key;
  ParameterType type;
  /// UDUNITS-2 unit of the number that the component receives: "N mm^2"; "" without dimension; alternatives
  /// that mean different things are separated by '|' ("N/mm|N/mm^2"): the user's unit then decides which one.
  /// A bare number is in the unit stated here, unless there are alternatives: then it is an error.
  const char* unit;
  /// TOML text of the default ("0.0", "\"1 mm\"", "true"); nullptr: the user has to give it;
  /// "": optional without default (`Parameters::has` tells).
  const char* default_text;
  const char* description;
  double lower = -1e308;         ///< smallest admissible number, in `unit`
  double upper = 1e308;          ///< largest admissible number, in `unit`
  bool lower_exclusive = false;  ///< `lower` itself is not admissible
  bool differentiable = false;   ///< results are differentiable in this number
  const char* choices = "";      ///< of a `choice`: "first|second"; of a scalar: names that may stand for a number
  const ParameterDeclaration* items = nullptr;  ///< of a `list` of tables: the declaration of one entry
  int item_count = 0;
};

/// A parameter that this scene cannot feel. It is allowed, and `explain` says so where the user has given it.
struct IdleParameter {
  std::string key, reason;  ///< "torsional-stiffness", "a curve in the plane does not twist"
};

/// A quantity along a curve. Arc coordinates in mm.
struct Profile {
  enum class Form : int { constant, table, segments, column };
  enum class Origin : int { first_end, sheath, tip };

  Form form = Form::constant;
  double constant = 0.0;
  std::vector<double> arc;           ///< of a table, increasing; linear in between, constant beyond
  std::vector<double> value;         ///< of a table or of segments
  std::vector<std::string> segment;  ///< of segments: labels of the geometry's point data
  std::string column;                ///< of a column: name of the geometry's point data
  Origin measured_from = Origin::first_end;
};

struct ParameterSet;

/// One parameter's checked value in the declared unit.
struct ParameterValue {
  std::string key;
  ParameterType type = ParameterType::scalar;
  bool given = false;               ///< false: the declared default
  int unit_alternative = 0;         ///< which of the units separated by '|'
  double number = 0.0;              ///< scalar
  long integer = 0;                 ///< integer
  bool flag = false;                ///< flag
  std::string text;                 ///< choice, text, path (absolute), or the name that stands for a scalar
  std::vector<double> vector;       ///< vector
  std::vector<std::string> names;   ///< names: a list of texts, or one text
  Profile profile;                  ///< profile
  std::vector<ParameterSet> items;  ///< list
  std::string position;             ///< "file:line:column" of the value in the composition, "" for a default
};

/// The checked parameters of one component. The accessors throw `std::out_of_range` naming the key when the
/// schema does not declare it; inside a plugin the SDK's guard turns that into a status.
struct ParameterSet {
  std::vector<ParameterValue> values;

  const ParameterValue* find(const std::string& key) const noexcept;
  const ParameterValue& at(const std::string& key) const;
  bool has(const std::string& key) const noexcept { return find(key) != nullptr; }

  double scalar(const std::string& key) const { return at(key).number; }
  long integer(const std::string& key) const { return at(key).integer; }
  bool flag(const std::string& key) const { return at(key).flag; }
  const std::string& text(const std::string& key) const { return at(key).text; }
  const std::vector<double>& vector(const std::string& key) const { return at(key).vector; }
  const std::vector<std::string>& names(const std::string& key) const { return at(key).names; }
  const Profile& profile(const std::string& key) const { return at(key).profile; }
};

}  // namespace bowstring
