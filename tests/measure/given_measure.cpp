#include "core/measure/given_measure.hpp"

#include <doctest/doctest.h>

#include "core/composition/composition.hpp"

using namespace bowstring;

namespace {

const char* const rows = "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n4,0,0\n";

const char* const document = R"({"format": "bowstring.result/1", "curves": [
  {"name": "iliac", "points": [[0, 0], [3, 4]], "radius_mm": [5, 6]},
  {"name": "wire", "points": [[0, 0, 1], [3, 4, 1]], "radius_mm": null}]})";

std::string errors_text(const std::vector<InputError>& errors) {
  std::string out;
  for (const InputError& error : errors) out += error.text() + "\n";
  return out;
}

CurveMeasure measure(const std::string& name, const std::string& text, const CurveSampling& sampling = {},
                     bool keeps_weights = true) {
  std::vector<InputError> errors;
  const auto given = read_given_measure(measure_name(name), text, errors);
  REQUIRE_MESSAGE(given, errors_text(errors));
  const auto out = measure_of(*given, sampling, keeps_weights, errors);
  REQUIRE_MESSAGE(out, errors_text(errors));
  return *out;
}

std::string refusal(const std::string& name, const std::string& text, const CurveSampling& sampling = {},
                    bool keeps_weights = true) {
  std::vector<InputError> errors;
  const auto given = read_given_measure(measure_name(name), text, errors);
  if (given) CHECK_FALSE(measure_of(*given, sampling, keeps_weights, errors));
  return errors_text(errors);
}

}  // namespace

TEST_CASE("a name's last '#' begins the name of a curve") {
  CHECK(measure_name("a.csv").curve == "");
  CHECK(measure_name("b#c/a.csv").file == "b#c/a.csv");
  CHECK(measure_name("b#c/r.json#iliac").file == "b#c/r.json");
  CHECK(measure_name("b#c/r.json#iliac").curve == "iliac");
  CHECK(measure_name("r.json#iliac").text() == "r.json#iliac");
}

TEST_CASE("rows are places, or the nodes of a curve") {
  const CurveMeasure places = measure("a.csv", rows), curve = measure("a.csv#curve", rows);
  CHECK_FALSE(places.measure.has_frames());
  CHECK(places.arc.empty());
  CHECK(curve.measure.has_frames());
  CHECK(curve.arc == std::vector<double>{0, 1, 4});
  CHECK(curve.measure.position == places.measure.position);
  CHECK(measure("a.csv", rows, {2, CurveWeights::arc_length, {}}).measure.count() == 3);
  CHECK(measure("a.csv#curve", rows, {2, CurveWeights::arc_length, {}}).measure.count() == 2);
}

TEST_CASE("a curve of a result document") {
  const CurveMeasure iliac = measure("r.json#iliac", document, {0, CurveWeights::lumen_section, {}});
  CHECK(iliac.measure.position == std::vector<double>{0, 0, 0, 3, 4, 0});
  CHECK(iliac.arc == std::vector<double>{0, 5});
  CHECK(iliac.measure.weight[1] == doctest::Approx(36.0 / 61.0));
  CHECK(measure("r.json#wire", document).measure.position == std::vector<double>{0, 0, 1, 3, 4, 1});
}

TEST_CASE("what a file gives the nodes of a curve is kept, or in the way") {
  const std::string framed = "x_mm,y_mm,z_mm,qw,qx,qy,qz,weight\n0,0,0,1,0,0,0,1\n1,0,0,0,1,0,0,3\n";
  const CurveMeasure kept = measure("a.csv#curve", framed);
  CHECK(kept.measure.weight == std::vector<double>{1, 3});
  CHECK(kept.measure.orientation == std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0});
  CHECK(refusal("a.csv#curve", framed, {}, false) ==
        "a.csv#curve: weights of nodes, where a curve is weighted anew; expected no column 'weight'; remove it, or do "
        "not "
        "resample and choose no weights\n");
  CHECK(
      refusal("a.csv#curve", framed, {5, CurveWeights::uniform, {}}) ==
      "a.csv#curve: orientations of nodes, where a curve is resampled; expected positions alone, from which frames are "
      "made; remove the columns qw, qx, qy, qz, or do not resample\n");
}

TEST_CASE("curves that a document does not have, and documents that are none") {
  CHECK(refusal("r.json#iliak", document) ==
        "r.json: the document has no curve 'iliak'; expected one of: iliac, wire; did you mean 'iliac'?\n");
  CHECK(refusal("r.json", document) ==
        "r.json: no curve of the document is named; expected one of: iliac, wire; write r.json#iliac\n");
  CHECK(
      refusal("r.json#iliac", "{\"format\": \"bowstring.transport/1\"}") ==
      "r.json: the format is \"bowstring.transport/1\"; expected \"bowstring.result/1\"; name a file that was written "
      "with --out\n");
  CHECK(refusal("r.json#iliac", "{").find("r.json: it is no JSON (") == 0);
  CHECK(refusal("a.csv#iliac", rows) ==
        "a.csv#iliac: 'iliac' of a file of places; expected 'a.csv' alone, or 'a.csv#curve' for the curve through its "
        "rows; curves have names in result documents\n");
  CHECK(refusal("r.json#iliac",
                R"({"format": "bowstring.result/1", "curves": [{"name": "iliac", "points": [[null, 1]]}]})") ==
        "r.json: the points of curve 'iliac' are not known; expected two or three numbers for each node; look at the "
        "document's status and reason\n");
}
