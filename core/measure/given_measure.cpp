#include "core/measure/given_measure.hpp"

#include <filesystem>
#include <utility>

#include "core/composition/composition.hpp"
#include "core/composition/sha256.hpp"
#include "core/measure/measure_table.hpp"
#include "core/measure/result_curve.hpp"

namespace bowstring {
namespace {

constexpr const char* curve_of_rows = "curve";

bool begins_as_json(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n", text.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0);
  return first != std::string::npos && text[first] == '{';
}

}  // namespace

MeasureName measure_name(const std::string& text) {
  const std::size_t mark = text.rfind('#'), slash = text.rfind('/');
  const bool of_folder = slash != std::string::npos && mark != std::string::npos && mark < slash;
  std::error_code ignored;
  if (mark == std::string::npos || of_folder || std::filesystem::exists(text, ignored)) return {text, ""};
  return {text.substr(0, mark), text.substr(mark + 1)};
}

std::optional<GivenMeasure> read_given_measure(const MeasureName& name, const std::string& text,
                                               std::vector<InputError>& errors) {
  const std::size_t before = errors.size();
  GivenMeasure out;
  out.name = name;
  out.sha256 = sha256_hex(text);
  if (begins_as_json(text)) {
    std::optional<NodalCurve> curve = read_result_curve(text, name.file, name.curve, errors);
    if (!curve) return std::nullopt;
    out.is_curve = true;
    out.curve = std::move(*curve);
    return out;
  }
  out.is_curve = !name.curve.empty();
  if (out.is_curve && name.curve != curve_of_rows) {
    errors.push_back({name.text(), "'" + name.curve + "' of a file of places",
                      "'" + name.file + "' alone, or '" + name.file + "#curve' for the curve through its rows",
                      "curves have names in result documents"});
  }
  MeasureTable table = read_measure_table(text, name.file, errors);
  if (errors.size() > before) return std::nullopt;
  out.has_weights = table.has_weights;
  if (out.is_curve) out.curve = {table.measure.position, std::move(table.radius)};
  out.places = std::move(table.measure);
  return out;
}

std::optional<CurveMeasure> measure_of(const GivenMeasure& given, const CurveSampling& sampling, bool keeps_weights,
                                       std::vector<InputError>& errors) {
  CurveMeasure out;
  if (!given.is_curve) {
    out.measure = given.places;
    return out;
  }
  const auto refuse = [&](std::string found, std::string expected, std::string mend) {
    errors.push_back({given.name.text(), std::move(found), std::move(expected), std::move(mend)});
    return std::nullopt;
  };
  const bool has_frames = given.places.has_frames();
  if (sampling.points > 0 && has_frames) {
    return refuse("orientations of nodes, where a curve is resampled", "positions alone, from which frames are made",
                  "remove the columns qw, qx, qy, qz, or do not resample");
  }
  if (given.has_weights && !(keeps_weights && sampling.points == 0)) {
    return refuse("weights of nodes, where a curve is weighted anew", "no column 'weight'",
                  "remove it, or do not resample and choose no weights");
  }
  if (const Status status = measure_of_curve(given.curve, sampling, out); !status.ok()) {
    return refuse(status.text, "", "");
  }
  if (has_frames) out.measure.orientation = given.places.orientation;
  if (given.has_weights) out.measure.weight = given.places.weight;
  return out;
}

}  // namespace bowstring
