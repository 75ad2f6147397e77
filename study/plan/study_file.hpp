#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/composition/position.hpp"
#include "study/study_data.hpp"

namespace bowstring::study {

/// An axis with what each of its alternatives changes.
struct Axis {
  AxisData data;
  std::vector<std::vector<Override>> overrides;  ///< per alternative
  std::vector<std::string> base;                 ///< per alternative: another base composition, or ""
  std::string position;                          ///< "study.toml:5:1"
};

/// Axes that are walked together: one axis, axes that are zipped, the numbers of a sample.
struct AxisGroup {
  std::vector<int> axes;
  int count = 0;  ///< alternatives, of each of them
};

enum class Combination : int { crossed, one_at_a_time };

/// What of a run counts: a number of the result document, or of several numbers one.
struct QuantityOfInterest {
  enum class Reduction : int { none, maximum, minimum, sum, mean, root_mean_square, count };

  std::string column, unit;
  std::string path;
  Reduction reduction = Reduction::none;
  Position position;
};
const char* reduction_name(QuantityOfInterest::Reduction reduction) noexcept;  ///< "max", "rms"; "" for none

/// Values from elsewhere: of every run, or of those with the alternatives `at` these axes.
struct StoredValues {
  std::vector<std::pair<int, int>> at;       ///< axis, alternative
  std::vector<std::optional<double>> value;  ///< per quantity
};

/// What results are compared with.
struct Reference {
  enum class Form : int { none, closed_form, stored, finest, richardson };

  Form form = Form::none;
  std::vector<std::string> expression;  ///< closed form, per quantity: of the axes' names; "" without
  std::vector<StoredValues> stored;     ///< the first one counts that fits a run and has the quantity
  int axis = -1;                        ///< of finest and richardson
  std::vector<std::pair<int, int>> at;  ///< axes that are held, each at an alternative; the others are the run's own
  std::string text;                     ///< for people
  std::string position;
};

/// Alternatives that are left out together: a run with one of each axis' listed ones is not part of the study.
struct Exclusion {
  std::vector<std::pair<int, std::vector<int>>> choices;  ///< axis, alternatives
};

/// A study as its file states it, with everything checked that needs no composition.
struct StudyFile {
  std::string file;  ///< as the user gave it
  std::string name;  ///< its file's name without extension; of the reduced form with "-reduced" behind it
  std::string title;
  std::string base;  ///< composition; "" where the alternatives of an axis name theirs
  std::vector<Override> set;
  std::vector<Axis> axes;
  std::vector<AxisGroup> groups;  ///< in the order of the file
  Combination combination = Combination::crossed;
  std::vector<Exclusion> exclusions;
  int repeats = 1;
  int warm_along = -1;  ///< axis; -1: every run starts from cold
  int along = -1;       ///< axis of the mesh
  double target_error = 0.01;
  double time_limit = 0.0;  ///< s, of a run; 0: none
  std::vector<QuantityOfInterest> quantities;
  Reference reference;
};

/// The axis and those that are walked with it: zipped ones, the numbers of one sample.
std::vector<int> walked_with(const StudyFile& study, int axis);

/// Every composition that some run is made from, each once.
std::vector<std::string> bases_of(const StudyFile& study);

/// Reads a study. `reduced`: with what its table [reduced] says instead. All that is wrong with the file is in
/// `errors`, with places; then what is returned has the rest of it, of use for nothing but looking for more.
StudyFile read_study(const std::string& file, bool reduced, std::vector<InputError>& errors);

}  // namespace bowstring::study
