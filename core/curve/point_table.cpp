#include "core/curve/point_table.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/curve/csv_cells.hpp"

namespace bowstring {

namespace {

using csv::as_number;
using csv::cells_of;
using csv::joined;
using csv::similar_column;

constexpr std::size_t most_reported = 50;
constexpr double smallest_step = 1e-9;  // mm; closer neighbours count as one point

/// What a column is read as.
enum class Role { coordinate, number, label };

struct Column {
  std::string name;
  Role role = Role::number;
  std::size_t axis = 0;  ///< of a coordinate
};

std::string as_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string counted(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

class Reader {
 public:
  Reader(const std::string& file, int dimension) : file_(file), dimension_(static_cast<std::size_t>(dimension)) {}

  Status read(PointTable& out) {
    std::ifstream stream(file_, std::ios::binary);
    if (!stream) return unreadable(std::strerror(errno));
    std::string line;
    for (line_ = 1; std::getline(stream, line); ++line_) {
      std::string_view text = line;
      if (line_ == 1 && text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
      if (csv::is_passed_over(text)) continue;
      if (!columns_.empty()) {
        read_row(cells_of(text));
      } else if (!read_header(cells_of(text))) {
        return result(out);
      }
    }
    if (stream.bad()) return unreadable("the file cannot be read to its end, or is a folder");
    finish();
    return result(out);
  }

 private:
  Status unreadable(const std::string& reason) const {
    return Status::failure(Code::invalid_input,
                           file_ + ": cannot be read (" + reason +
                               "); expected a text file of points; check the path, which is relative to the "
                               "composition");
  }

  void error(std::size_t line, const std::string& found, const std::string& expected, const std::string& mend) {
    ++error_count_;
    if (error_count_ > most_reported) return;
    const std::string place = line > 0 ? file_ + ":" + std::to_string(line) : file_;
    errors_ += (errors_.empty() ? "" : "\n") + place + ": " + found + "; expected " + expected + "; " + mend;
  }

  Status result(PointTable& out) {
    if (error_count_ == 0) {
      out = std::move(table_);
      return {};
    }
    if (error_count_ > most_reported) {
      errors_ += "\n" + file_ + ": and " + counted(error_count_ - most_reported, "more error");
    }
    return Status::failure(Code::invalid_input, errors_);
  }

  std::string expected_columns() const {
    return std::string(dimension_ == 2 ? "x_mm,y_mm" : "x_mm,y_mm,z_mm") + "[,radius_mm][,any point data]";
  }

  bool read_header(const std::vector<std::string>& cells) {
    const std::size_t errors_before = error_count_;
    const bool all_numbers =
        std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return as_number(cell).has_value(); });
    if (all_numbers) {
      error(line_, "numbers where the columns' names belong", expected_columns(),
            "put a line with the names before the points");
      return false;
    }
    for (const std::string& cell : cells) add_column(cell);
    for (const char axis : std::string_view(dimension_ == 2 ? "xy" : "xyz")) require_coordinate(cells, axis);
    return error_count_ == errors_before;
  }

  void add_column(const std::string& name) {
    const auto same = [&name](const Column& column) { return column.name == name; };
    const std::string number = std::to_string(columns_.size() + 1);
    if (name.empty()) {
      error(line_, "column " + number + " has no name", "a name for every column", "name it or remove the comma");
    } else if (std::any_of(columns_.begin(), columns_.end(), same)) {
      error(line_, "column '" + name + "' stands there twice", "every name once", "rename or remove one of them");
    }
    Column column{name, Role::number, 0};
    if (name == "x_mm" || name == "y_mm" || name == "z_mm") {
      column.role = Role::coordinate;
      column.axis = static_cast<std::size_t>(name[0] - 'x');
    } else if (name == "label" || name == "segment") {
      column.role = Role::label;
      if (has_label_) {
        error(line_, "both a column 'label' and a column 'segment'", "one column of labels", "remove one of them");
      }
      has_label_ = true;
    } else {
      table_.data.push_back({name, {}});
    }
    columns_.push_back(std::move(column));
  }

  void require_coordinate(const std::vector<std::string>& cells, char axis) {
    const std::string name = std::string(1, axis) + "_mm";
    const auto same = [&name](const Column& column) { return column.name == name; };
    if (std::any_of(columns_.begin(), columns_.end(), same)) return;
    const std::string similar = similar_column(cells, axis);
    std::string mend =
        similar.empty() ? "name the column of that coordinate" : "rename '" + similar + "' if it is in mm";
    if (cells.size() == 1) mend = "separate the columns by commas";
    if (axis == 'z' && similar.empty() && cells.size() > 1) {
      error(line_, "no column 'z_mm' (3-D scene with 2-D data) among " + joined(cells), expected_columns(),
            "add a column z_mm (0 for a planar curve), or set dimension = 2 in [scene]");
    } else {
      error(line_, "no column '" + name + "' among " + joined(cells), expected_columns(), mend);
    }
  }

  void read_row(const std::vector<std::string>& cells) {
    ++rows_;
    if (cells.size() != columns_.size()) {
      error(line_, "a row of " + counted(cells.size(), "cell"),
            std::to_string(columns_.size()) + ", one for each column that the header names",
            cells.size() < columns_.size() ? "complete the row or remove it" : "remove what is too much, or name it");
      return;
    }
    const std::size_t errors_before = error_count_;
    double point[3] = {0.0, 0.0, 0.0};
    std::vector<double> numbers;
    std::string label;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (columns_[i].role == Role::label) {
        label = cells[i];
        continue;
      }
      const double value = read_number(cells[i], columns_[i]);
      if (columns_[i].role == Role::coordinate) {
        point[columns_[i].axis] = value;
      } else {
        numbers.push_back(value);
      }
    }
    if (error_count_ == errors_before) add_point(point, numbers, label);
  }

  double read_number(const std::string& cell, const Column& column) {
    const std::string unit = column.role == Role::coordinate || column.name == "radius_mm" ? " in mm" : "";
    const std::optional<double> value = as_number(cell);
    const std::string where = " in column '" + column.name + "'";
    if (!value) {
      error(line_, cell.empty() ? "an empty cell" + where : "'" + cell + "'" + where + " is no number",
            "a number" + unit + ", as 12.5",
            column.role == Role::number && column.name != "radius_mm"
                ? "correct the cell; text is read from a column named 'label' or 'segment' only"
                : "correct the cell or remove the row");
      return 0.0;
    }
    if (!std::isfinite(*value)) {
      error(line_, "'" + cell + "'" + where, "a finite number" + unit, "correct the cell or remove the row");
    } else if (column.name == "radius_mm" && *value <= 0.0) {
      error(line_, "radius_mm " + cell, "a radius above 0 mm", "correct the cell or remove the row");
    }
    return *value;
  }

  void add_point(const double* point, const std::vector<double>& numbers, const std::string& label) {
    if (dimension_ == 2 && point[2] != 0.0 && out_of_plane_++ == 0) {
      line_out_of_plane_ = line_;
      height_ = point[2];
    }
    if (!table_.points.empty()) {
      const double* before = table_.points.data() + table_.points.size() - dimension_;
      double square = 0.0;
      for (std::size_t k = 0; k < dimension_; ++k) square += std::pow(point[k] - before[k], 2);
      if (std::sqrt(square) <= smallest_step) {
        error(line_, "the point of line " + std::to_string(line_before_) + " again", "points that are apart",
              "remove one of the two rows");
        return;
      }
    }
    line_before_ = line_;
    table_.points.insert(table_.points.end(), point, point + dimension_);
    for (std::size_t i = 0; i < numbers.size(); ++i) table_.data[i].value.push_back(numbers[i]);
    if (has_label_) table_.label.push_back(label);
  }

  void finish() {
    if (columns_.empty()) {
      error(0, "no line names the columns", expected_columns(), "give a header and a row for each point");
      return;
    }
    if (out_of_plane_ > 0) {
      error(line_out_of_plane_,
            "2-D scene with 3-D data: z_mm is " + as_text(height_) + " here and not 0 in " +
                counted(out_of_plane_, "row") + " in all",
            "0 in every row, or no column z_mm", "set dimension = 3 in [scene], or project the points into the plane");
    }
    if (rows_ < 3) {
      error(0, counted(rows_, "point"), "at least 3", "add rows, in the order of the curve");
    }
  }

  const std::string& file_;
  std::size_t dimension_;
  std::size_t line_ = 0, line_before_ = 0, rows_ = 0;
  std::vector<Column> columns_;
  bool has_label_ = false;
  std::size_t out_of_plane_ = 0, line_out_of_plane_ = 0;
  double height_ = 0.0;
  PointTable table_;
  std::string errors_;
  std::size_t error_count_ = 0;
};

}  // namespace

Status read_point_table(const std::string& file, int dimension, PointTable& out) {
  return Reader(file, dimension).read(out);
}

}  // namespace bowstring
