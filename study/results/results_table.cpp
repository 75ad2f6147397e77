#include "study/results/results_table.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/composition/tree.hpp"
#include "study/plan/axes.hpp"

namespace bowstring::study {
namespace {

std::string cell(double number) { return std::isfinite(number) ? decimal(number) : ""; }

std::string cell(const RunRecord::Number& number) { return number ? cell(*number) : ""; }

/// RFC 4180: in quotes where it has to be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char letter : text) out += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return out + "\"";
}

struct Column {
  std::string name;
  std::function<std::string(std::size_t)> cell;  ///< of a run
};

class Table {
 public:
  explicit Table(const Collected& collected) : data_(collected.data), records_(collected.records) {
    add("run", [](std::size_t r) { return std::to_string(r); });
    add_axes();
    add("status", [this](std::size_t r) { return cell(records_[r].status); });
    add("second_order", [this](std::size_t r) { return cell(records_[r].second_order); });
    add_quantities();
    add_counts();
    add_certificate();
    add_energies();
    add_seconds();
    add("reason", [this](std::size_t r) { return cell(records_[r].reason); });
  }

  std::string text() const {
    std::string out;
    for (std::size_t c = 0; c < columns_.size(); ++c) out += (c > 0 ? "," : "") + cell(columns_[c].name);
    out += '\n';
    for (std::size_t r = 0; r < data_.runs.size(); ++r) {
      for (std::size_t c = 0; c < columns_.size(); ++c) out += (c > 0 ? "," : "") + columns_[c].cell(r);
      out += '\n';
    }
    return out;
  }

 private:
  void add(const std::string& name, std::function<std::string(std::size_t)> content) {
    columns_.push_back({name, std::move(content)});
  }

  void add_axes() {
    for (std::size_t a = 0; a < data_.axes.size(); ++a) {
      add(data_.axes[a].column, [this, a](std::size_t r) {
        const int k = data_.runs[r].choice[a];
        if (k < 0) return std::string();
        const AxisData& axis = data_.axes[a];
        return axis.numeric() ? cell(axis.number[static_cast<std::size_t>(k)])
                              : cell(axis.label[static_cast<std::size_t>(k)]);
      });
    }
  }

  void add_quantities() {
    for (const QuantityData& quantity : data_.quantities) {
      add(quantity.column, [&quantity](std::size_t r) { return cell(quantity.value[r]); });
      if (!quantity.has_reference()) continue;
      const std::string suffix = quantity.unit.empty() ? "" : "_" + unit_suffix(quantity.unit);
      const std::string stem = quantity.column.substr(0, quantity.column.size() - suffix.size());
      add(stem + "_reference" + suffix, [&quantity](std::size_t r) { return cell(quantity.reference[r]); });
      add(stem + "_error" + suffix,
          [&quantity](std::size_t r) { return cell(std::abs(quantity.value[r] - quantity.reference[r])); });
    }
  }

  void add_count(const std::string& name, int RunRecord::*count) {
    if (has_column(name)) return;
    add(name, [this, count](std::size_t r) {
      const bool solved = !records_[r].solve_seconds.empty();
      return solved ? std::to_string(records_[r].*count) : std::string();
    });
  }

  void add_counts() {
    add_count("unknowns", &RunRecord::unknowns);
    add_count("iterations", &RunRecord::iterations);
    add_count("factorizations", &RunRecord::factorizations);
    add_count("evaluations", &RunRecord::evaluations);
    add_count("epochs", &RunRecord::epochs);
  }

  bool has_column(const std::string& name) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) { return column.name == name; });
  }

  void add_certificate() {
    const std::vector<std::pair<std::string, std::string>> figures{
        {"stationarity_N", "stationarity"},
        {"max_penetration_mm", "max_penetration_mm"},
        {"max_penetration_dense_mm", "max_penetration_dense_mm"},
        {"min_stretch", "min_stretch"}};
    for (const auto& [name, key] : figures) {
      if (has_column(name)) continue;
      add(name, [this, key = key](std::size_t r) {
        const auto found = records_[r].certificate.find(key);
        return found == records_[r].certificate.end() ? std::string() : cell(found->second);
      });
    }
  }

  void add_energies() {
    for (const EnergyData& energy : data_.energies) {
      const std::string name = "energy_" + column_name(energy.term) + "_N_mm";
      if (!has_column(name)) add(name, [&energy](std::size_t r) { return cell(energy.value[r]); });
    }
    if (has_column("energy_total_N_mm")) return;
    add("energy_total_N_mm", [this](std::size_t r) {
      const auto& energy = records_[r].energy;
      return energy.empty() ? std::string() : cell(energy.back().second);
    });
  }

  void add_seconds() {
    const auto add_time = [this](const std::string& name, double RunRecord::*seconds) {
      add(name, [this, seconds](std::size_t r) {
        return records_[r].solve_seconds.empty() ? std::string() : cell(records_[r].*seconds);
      });
    };
    add_time("load_seconds", &RunRecord::load_seconds);
    add_time("setup_seconds", &RunRecord::setup_seconds);
    add("solve_seconds", [this](std::size_t r) { return cell(data_.runs[r].solve_seconds); });
    if (data_.repeats > 1) {
      add("least_solve_seconds", [this](std::size_t r) {
        const std::vector<double>& all = records_[r].solve_seconds;
        return all.empty() ? std::string() : cell(*std::min_element(all.begin(), all.end()));
      });
    }
    add_time("total_seconds", &RunRecord::total_seconds);
  }

  const StudyData& data_;
  const std::vector<RunRecord>& records_;
  std::vector<Column> columns_;
};

}  // namespace

std::string results_csv(const Collected& collected) { return Table(collected).text(); }

}  // namespace bowstring::study
