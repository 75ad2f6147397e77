#include <sstream>
#include <string>
#include <utility>

#include "core/curve/arc_length.hpp"
#include "core/curve/point_table.hpp"
#include "core/curve/spline_curve.hpp"
#include "core/interfaces/geometry.hpp"
#include "plugins/sdk/plugin.hpp"

namespace bowstring {
namespace {

constexpr ParameterDeclaration schema[] = {
    {.key = "file",
     .type = ParameterType::path,
     .unit = "",
     .default_text = nullptr,
     .description = "comma-separated points: x_mm,y_mm[,z_mm][,radius_mm][,any point data], lines with # skipped"},
    {.key = "nodes",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "",
     .description = "number of nodes, uniform in arc length; by default the points as they stand",
     .lower = 3,
     .upper = 1e6},
    {.key = "coordinates",
     .type = ParameterType::choice,
     .unit = "",
     .default_text = "\"LPS\"",
     .description = "axes of the file; RAS is converted to LPS on reading: x and y change sign",
     .choices = "LPS|RAS"},
    {.key = "smoothing",
     .type = ParameterType::scalar,
     .unit = "mm",
     .default_text = "0.0",
     .description = "root-mean-square distance from the points that a smoothing spline may leave",
     .lower = 0.0},
    {.key = "smoothing-degree",
     .type = ParameterType::integer,
     .unit = "",
     .default_text = "5",
     .description = "degree of that spline, 3 or 5, and of the one through the points where only nodes are given",
     .lower = 3,
     .upper = 5},
};

/// A centerline from a file: the points as they stand, or nodes on a spline. See README.md.
class Csv final : public Geometry {
 public:
  explicit Csv(const ParameterSet& parameters)
      : file_(parameters.text("file")),
        right_anterior_superior_(parameters.text("coordinates") == "RAS"),
        smoothing_(parameters.scalar("smoothing")),
        degree_(static_cast<int>(parameters.integer("smoothing-degree"))),
        nodes_(parameters.has("nodes") ? static_cast<int>(parameters.integer("nodes")) : 0) {
    if (degree_ != 3 && degree_ != 5) {
      throw StatusError(Code::invalid_input,
                        "'smoothing-degree' is " + std::to_string(degree_) + "; expected 3 or 5; give one of them");
    }
  }

  Status build(int dimension, CurveGraph& out) noexcept override {
    return guard([&] {
      PointTable table;
      Status status = read_point_table(file_, dimension, table);
      if (!status) return status;
      if (right_anterior_superior_) turn_to_lps(table.points, dimension);
      CurveGeometry curve;
      if (smoothing_ > 0.0 || nodes_ > 0) {
        status = put_on_spline(table, dimension, curve, out.warnings);
        if (!status) return status;
      } else {
        curve.points = std::move(table.points);
        curve.data = std::move(table.data);
        curve.label = std::move(table.label);
      }
      out.curves.push_back(std::move(curve));
      return Status{};
    });
  }

 private:
  static void turn_to_lps(std::vector<double>& points, int dimension) {
    for (std::size_t i = 0; i < points.size(); i += static_cast<std::size_t>(dimension)) {
      points[i] = -points[i];
      points[i + 1] = -points[i + 1];
    }
  }

  Status put_on_spline(PointTable& table, int dimension, CurveGeometry& curve,
                       std::vector<std::string>& warnings) const {
    const std::size_t d = static_cast<std::size_t>(dimension);
    const std::size_t rows = table.points.size() / d;
    if (rows < static_cast<std::size_t>(degree_) + 1) {
      return Status::failure(Code::invalid_input,
                             file_ + ": " + std::to_string(rows) + " points; expected at least " +
                                 std::to_string(degree_ + 1) + " for a spline of degree " + std::to_string(degree_) +
                                 "; " + (degree_ == 5 && rows > 3 ? "set smoothing-degree = 3" : "add rows") +
                                 ", or leave out 'nodes' and 'smoothing'");
    }
    std::vector<double> parameter = chord_parameters(table.points, dimension);
    SplineFit fit;
    Status status = fit_spline(parameter, table.points, dimension, degree_, smoothing_, fit);
    if (!status) return Status::failure(status.code, file_ + ": " + status.text);
    if (smoothing_ > 0.0 && fit.distance < smoothing_) warnings.push_back(single_polynomial(fit.distance));

    const ArcLength arc = fit.curve.arc_length();
    if (nodes_ > 0) {
      resample(table, arc, parameter, curve);
      parameter = arc.even_parameters(nodes_);
    } else {
      curve.data = std::move(table.data);
      curve.label = std::move(table.label);
    }
    curve.points.resize(parameter.size() * d);
    for (std::size_t i = 0; i < parameter.size(); ++i) {
      fit.curve.evaluate(parameter[i], 0, curve.points.data() + i * d);
    }
    curve.first_tangent = fit.curve.tangent(parameter.front());
    curve.last_tangent = fit.curve.tangent(parameter.back());
    return {};
  }

  /// Point data linear in arc length between the points of the file, labels those of the nearest one.
  void resample(const PointTable& table, const ArcLength& arc, const std::vector<double>& parameter,
                CurveGeometry& curve) const {
    std::vector<double> from;
    for (const double t : parameter) from.push_back(arc.at(t));
    const std::vector<double> to = even_stations(arc.total(), nodes_);
    for (const PointData& given : table.data) {
      PointData data{given.name, {}};
      for (const double s : to) data.value.push_back(interpolate_linearly(from, given.value, s));
      curve.data.push_back(std::move(data));
    }
    if (table.label.empty()) return;
    for (const double s : to) curve.label.push_back(table.label[nearest_index(from, s)]);
  }

  std::string single_polynomial(double distance) const {
    std::ostringstream text;
    text << file_ << ": smoothing " << smoothing_ << " mm is more than the " << distance
         << " mm that a single polynomial of degree " << degree_
         << " leaves; that polynomial is used; a smaller smoothing keeps more of the curve";
    return text.str();
  }

  std::string file_;
  bool right_anterior_superior_;
  double smoothing_;
  int degree_;
  int nodes_;
};

}  // namespace
}  // namespace bowstring

BOWSTRING_PLUGIN(bowstring::component<bowstring::Geometry, bowstring::Csv>(
    bowstring::Kind::geometry, "csv", "A centerline and its point data from a comma-separated file, smoothed or not",
    bowstring::schema))
