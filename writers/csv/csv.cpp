#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/interfaces/writer.hpp"
#include "core/result/write_file.hpp"
#include "plugins/sdk/plugin.hpp"
#include "writers/reading/result.hpp"

namespace bowstring {
namespace {

constexpr const char* axis_names = "xyz";

/// A cell; one with a comma, a quote or a line break is quoted (RFC 4180).
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

/// The shortest text that reads back as the same number; empty for what is not finite.
std::string cell(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, end.ptr);
}

std::string comment(const std::string& key, std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return "# " + key + ": " + text + "\n";
}

std::string header(const Result& result) {
  std::string out = comment("title", result.title);
  out += comment("status", result.reason.empty() ? result.status : result.status + ", " + result.reason);
  out += comment("units", "mm, 1/mm, N; x, y, z and s are State 2, reference_ is State 1" +
                              std::string(result.patient_axes ? "; axes left, posterior, superior" : ""));
  return out;
}

std::string column_names(int dimension) {
  std::string out = "curve,kind,node,s_mm";
  for (const char* prefix : {"", "reference_"}) {
    for (int k = 0; k < dimension; ++k) out += std::string(",") + prefix + axis_names[k] + "_mm";
  }
  return out + ",displacement_mm,radius_mm,curvature_per_mm,contact_force_N\n";
}

/// Force of the contact rows at every node of a curve, N; not a number where no row is.
std::vector<double> node_forces(const Result& result, int curve) {
  const ResultCurve& wire = result.curves[static_cast<std::size_t>(curve)];
  std::vector<double> forces(wire.points.size(), std::numeric_limits<double>::quiet_NaN());
  for (const ResultContact& contact : result.contacts) {
    if (contact.wire != curve) continue;
    const int node = nearest_node(wire, contact.arc);
    if (node < 0) continue;
    double& force = forces[static_cast<std::size_t>(node)];
    force = std::isnan(force) ? contact.force : force + contact.force;
  }
  return forces;
}

std::string rows(const Result& result, int index) {
  const ResultCurve& curve = result.curves[static_cast<std::size_t>(index)];
  const std::vector<double> forces = node_forces(result, index);
  const std::string start = quoted(curve.name) + (curve.wire ? ",wire," : ",vessel,");
  std::string out;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    std::vector<double> numbers{curve.arc[i]};
    for (const Vector3& point : {curve.points[i], curve.reference[i]}) {
      for (int k = 0; k < result.dimension; ++k) numbers.push_back(point[k]);
    }
    const double displacement = norm(curve.points[i] - curve.reference[i]);
    numbers.insert(numbers.end(), {displacement, curve.radius[i], curve.curvature[i], forces[i]});
    out += start + std::to_string(i);
    for (const double number : numbers) out += "," + cell(number);
    out += '\n';
  }
  return out;
}

/// One row per node of every curve, for spreadsheets and data frames.
class CsvWriter final : public Writer {
 public:
  explicit CsvWriter(const ParameterSet&) {}

  Status write(const char* document, const char* file) noexcept override {
    return guard([&] {
      const Result result = read_result(document);
      std::string text = header(result) + column_names(result.dimension);
      for (std::size_t i = 0; i < result.curves.size(); ++i) text += rows(result, static_cast<int>(i));
      return write_file(file, text);
    });
  }
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Writer, bowstring::CsvWriter>(
    bowstring::Kind::writer, "csv", "A table with one row per node of every curve"))
