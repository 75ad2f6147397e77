#include "core/measure/measure_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/composition/nearest.hpp"
#include "core/curve/csv_cells.hpp"
#include "core/transport/check_measure.hpp"

namespace bowstring {
namespace {

using csv::as_number;

constexpr std::size_t most_reported = 50;
constexpr const char* expected_columns = "x_mm,y_mm,z_mm[,qw,qx,qy,qz][,weight][,any point data]";

/// The columns that are read, in the order in which a row's numbers are kept.
constexpr std::array<const char*, 9> known{"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "weight", "radius_mm"};
constexpr std::size_t x = 0, qw = 3, weight = 7, radius = 8, of_no_use = known.size();

std::string in_lower_case(std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return text;
}

/// The known column that a name was probably meant to be; "" where it is data.
std::string meant(const std::string& name) {
  for (const char* column : known) {
    if (in_lower_case(name) == column) return column;
  }
  return in_lower_case(name)[0] == 'w' && !nearest_names(name, {"weight"}).empty() ? "weight" : "";
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, std::vector<InputError>& errors)
      : text_(text), name_(name), errors_(errors) {}

  MeasureTable read() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);
    bool good = true;
    while (good && !text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      const std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (csv::is_passed_over(line)) continue;
      if (column_.empty()) {
        good = read_header(csv::cells_of(line));
      } else {
        read_row(csv::cells_of(line));
      }
    }
    if (good) finish();
    tell();
    return std::move(out_);
  }

 private:
  void error(std::size_t line, std::string found, std::string expected, std::string mend) {
    const std::string position = line > 0 ? name_ + ":" + std::to_string(line) : name_;
    found_.push_back({line, {position, std::move(found), std::move(expected), std::move(mend)}});
  }

  /// In the order of the lines.
  void tell() {
    std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t told = std::min(found_.size(), most_reported);
    for (std::size_t k = 0; k < told; ++k) errors_.push_back(std::move(found_[k].second));
    if (found_.size() == told) return;
    errors_.push_back({name_, "and " + counted(static_cast<int>(found_.size() - told), "more error"), "", ""});
  }

  bool has(std::size_t which) const { return std::find(column_.begin(), column_.end(), which) != column_.end(); }

  bool read_header(const std::vector<std::string>& cells) {
    const std::size_t before = found_.size();
    if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return as_number(cell).has_value(); })) {
      error(line_, "numbers where the columns' names belong", expected_columns,
            "put a line with the names before the places");
      return false;
    }
    for (std::size_t i = 0; i < cells.size(); ++i) add_column(cells, i);
    for (std::size_t axis = 0; axis < 3; ++axis) require_coordinate(cells, axis);
    require_whole_quaternion();
    return found_.size() == before;
  }

  void add_column(const std::vector<std::string>& cells, std::size_t i) {
    const std::string& name = cells[i];
    const auto found = std::find(known.begin(), known.end(), name);
    column_.push_back(static_cast<std::size_t>(found - known.begin()));
    if (name.empty()) {
      return error(line_, "column " + std::to_string(i + 1) + " has no name", "a name for every column",
                   "name it or remove the comma");
    }
    if (std::find(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(i), name) !=
        cells.begin() + static_cast<std::ptrdiff_t>(i)) {
      error(line_, "column '" + name + "' stands there twice", "every name once", "rename or remove one of them");
    }
    if (column_.back() != of_no_use) return;
    if (const std::string similar = meant(name); !similar.empty()) {
      error(line_, "column '" + name + "', which would be left out", expected_columns,
            "rename it to '" + similar + "', or to what is not so like it");
    }
  }

  void require_coordinate(const std::vector<std::string>& cells, std::size_t axis) {
    if (has(axis)) return;
    const std::string similar = csv::similar_column(cells, known[axis][0]);
    std::string mend =
        similar.empty() ? "name the column of that coordinate" : "rename '" + similar + "' if it is in mm";
    if (axis == 2 && similar.empty()) mend = "add a column z_mm, 0 for places in the plane";
    if (cells.size() == 1) mend = "separate the columns by commas";
    error(line_, std::string("no column '") + known[axis] + "' among " + csv::joined(cells), expected_columns, mend);
  }

  void require_whole_quaternion() {
    std::vector<std::string> there, missing;
    for (std::size_t k = qw; k < weight; ++k) (has(k) ? there : missing).emplace_back(known[k]);
    if (there.empty() || missing.empty()) return;
    error(line_, "columns " + comma_separated(there) + " without " + comma_separated(missing),
          "all of qw, qx, qy, qz, or none", "add the missing columns, or remove the others");
  }

  std::string place() const { return "place " + std::to_string(place_line_.size()) + ": "; }

  void read_row(const std::vector<std::string>& cells) {
    // What cannot be read is left as it is here: nothing more is found wrong with it.
    std::array<double, known.size()> number{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0};
    if (cells.size() != column_.size()) {
      error(line_, place() + "a row of " + counted(static_cast<int>(cells.size()), "cell"),
            std::to_string(column_.size()) + ", one for each column that the header names",
            cells.size() < column_.size() ? "complete the row or remove it" : "remove what is too much, or name it");
    } else {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        if (column_[i] != of_no_use) read_number(cells[i], column_[i], number[column_[i]]);
      }
    }
    place_line_.push_back(line_);
    Measure& measure = out_.measure;
    measure.position.insert(measure.position.end(), number.begin(), number.begin() + 3);
    if (has(qw)) measure.orientation.insert(measure.orientation.end(), &number[qw], &number[qw] + 4);
    if (has(weight)) measure.weight.push_back(number[weight]);
    if (has(radius)) out_.radius.push_back(number[radius]);
  }

  void read_number(const std::string& cell, std::size_t which, double& out) {
    const std::optional<double> value = as_number(cell);
    const std::string where = std::string(" in column '") + known[which] + "'";
    if (value && (std::isfinite(*value) || which == weight)) {
      out = *value;
      return;
    }
    error(
        line_,
        place() + (cell.empty() ? "an empty cell" + where : "'" + cell + "'" + where + (value ? "" : " is no number")),
        value ? "a finite number" : "a number, as 12.5", "correct the cell or remove the row");
  }

  void finish() {
    if (column_.empty()) {
      return error(0, "no line names the columns", expected_columns, "give a header and a row for each place");
    }
    if (place_line_.empty()) return error(0, "no places", "at least one", "give a row for each place");
    out_.has_weights = has(weight);
    if (!out_.has_weights) out_.measure.weight = uniform_weights(place_line_.size());
    for (MeasureFlaw& flaw : flaws_of(out_.measure)) {
      const std::string where = flaw.index < 0 ? "" : "place " + std::to_string(flaw.index) + ": ";
      error(flaw.index < 0 ? 0 : place_line_[static_cast<std::size_t>(flaw.index)], where + flaw.found, flaw.expected,
            flaw.mend);
    }
    // Digits that a file has cut off are no reason for frames to lose their invariances.
    for (std::size_t i = 0; i + 4 <= out_.measure.orientation.size(); i += 4) {
      double* q = &out_.measure.orientation[i];
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      for (int k = 0; k < 4; ++k) q[k] /= length;
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::vector<InputError>& errors_;
  std::vector<std::size_t> column_;      ///< which of the known ones each is
  std::vector<std::size_t> place_line_;  ///< the line of each place
  std::size_t line_ = 0;
  std::vector<std::pair<std::size_t, InputError>> found_;
  MeasureTable out_;
};

}  // namespace

MeasureTable read_measure_table(std::string_view text, const std::string& name, std::vector<InputError>& errors) {
  return Reader(text, name, errors).read();
}

}  // namespace bowstring
