#include "writers/vtp/markup.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

#include "writers/vtp/base64.hpp"

namespace bowstring {

namespace {

/// Columns of numbers per point.
using Column = std::function<double(const ModelPoint&, int)>;

struct PointArray {
  const char* name;
  int components;
  Column value;
  const char* attributes = "";
};

Column number(double ModelPoint::*field) {
  return [field](const ModelPoint& point, int) { return point.*field; };
}

Column vector(Vector3 ModelPoint::*field) {
  return [field](const ModelPoint& point, int k) { return (point.*field)[k]; };
}

Column frame_axis(int axis) {
  return [axis](const ModelPoint& point, int k) { return point.frame.matrix()(k, axis); };
}

std::vector<PointArray> point_arrays() {
  return {
      {"s_mm", 1, number(&ModelPoint::arc)},
      {"radius_mm", 1, number(&ModelPoint::radius)},
      {"curvature_per_mm", 1, number(&ModelPoint::curvature)},
      {"twist_per_mm", 1, number(&ModelPoint::twist)},
      {"moment_N_mm", 3, vector(&ModelPoint::moment),
       R"( ComponentName0="torsion" ComponentName1="bending 2" ComponentName2="bending 3")"},
      {"displacement_mm", 3, vector(&ModelPoint::displacement)},
      {"frame_1", 3, frame_axis(0)},
      {"frame_2", 3, frame_axis(1)},
      {"frame_3", 3, frame_axis(2)},
      {"normal", 3, vector(&ModelPoint::normal)},
      {"force_N", 3, vector(&ModelPoint::force)},
      {"gap_mm", 1, number(&ModelPoint::gap)},
  };
}

template <class T>
std::string bytes(const std::vector<T>& numbers) {
  std::string out(numbers.size() * sizeof(T), '\0');
  if (!numbers.empty()) std::memcpy(out.data(), numbers.data(), out.size());
  return out;
}

/// The byte count and the bytes, encoded as one.
std::string encoded(const std::string& content) {
  return base64(bytes(std::vector<std::uint64_t>{content.size()}) + content);
}

std::string data_array(const std::string& type, const std::string& name, const std::string& attributes,
                       const std::string& content) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\"" + attributes + " format=\"binary\">\n" +
         encoded(content) + "\n</DataArray>\n";
}

/// Strings one after the other, each with a zero behind it.
std::string field(const std::string& name, const std::vector<std::string>& strings) {
  std::string content;
  for (const std::string& text : strings) content += text + '\0';
  return "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" + std::to_string(strings.size()) +
         "\" format=\"binary\">\n" + encoded(content) + "\n</Array>\n";
}

std::string axes_in_words(const Result& result) {
  const std::string axes = "LPS, mm: x to the patient's left, y to posterior, z to superior";
  if (result.patient_axes) return axes;
  return axes + "; the scene is generated, not measured, and its own x, y, z are written as such";
}

std::string field_data(const Result& result, const Model& model) {
  std::vector<std::string> parts;
  for (const ModelPart& part : model.parts) parts.push_back(part.name);
  const std::vector<std::string> kinds(std::begin(part_kind_names), std::end(part_kind_names));
  // 3D Slicer takes the axes from the first string of SPACE (vtkMRMLModelStorageNode).
  return "<FieldData>\n" + field("SPACE", {"LPS"}) + field("coordinates", {axes_in_words(result)}) +
         field("title", {result.title}) +
         field("status", {result.reason.empty() ? result.status : result.status + ": " + result.reason}) +
         field("part_names", parts) + field("kind_names", kinds) + "</FieldData>\n";
}

std::string points(const Model& model) {
  std::vector<double> numbers;
  for (const ModelPoint& point : model.points) {
    numbers.insert(numbers.end(), point.position.data.begin(), point.position.data.end());
  }
  return "<Points>\n" + data_array("Float64", "Points", " NumberOfComponents=\"3\"", bytes(numbers)) + "</Points>\n";
}

std::string point_data(const Model& model) {
  const bool contacts = !model.vertices.part.empty();
  // Of all vectors 3D Slicer turns the active one and the normals into its own axes, RAS, and no others.
  std::string out =
      std::string("<PointData Vectors=\"") + (contacts ? "force_N" : "displacement_mm") + "\" Normals=\"normal\">\n";
  for (const PointArray& array : point_arrays()) {
    std::vector<double> numbers;
    for (const ModelPoint& point : model.points) {
      for (int k = 0; k < array.components; ++k) numbers.push_back(array.value(point, k));
    }
    if (std::none_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) continue;
    if (!contacts && std::string("force_N") == array.name) continue;
    out += data_array("Float64", array.name,
                      " NumberOfComponents=\"" + std::to_string(array.components) + "\"" + array.attributes,
                      bytes(numbers));
  }
  return out + "</PointData>\n";
}

/// In VTK's order of cells: vertices, lines, polygons.
std::string cell_data(const Model& model) {
  std::vector<std::int32_t> part, kind;
  for (const ModelCells* cells : {&model.vertices, &model.lines, &model.triangles}) {
    part.insert(part.end(), cells->part.begin(), cells->part.end());
  }
  for (const std::int32_t p : part) {
    kind.push_back(static_cast<std::int32_t>(model.parts[static_cast<std::size_t>(p)].kind));
  }
  return "<CellData Scalars=\"kind\">\n" + data_array("Int32", "kind", "", bytes(kind)) +
         data_array("Int32", "part", "", bytes(part)) + "</CellData>\n";
}

std::string cells(const std::string& element, const ModelCells& cells) {
  return "<" + element + ">\n" + data_array("Int64", "connectivity", "", bytes(cells.connectivity)) +
         data_array("Int64", "offsets", "", bytes(cells.offsets)) + "</" + element + ">\n";
}

std::string piece_start(const Model& model) {
  const auto count = [](const ModelCells& cells) { return std::to_string(cells.part.size()); };
  return "<Piece NumberOfPoints=\"" + std::to_string(model.points.size()) + "\" NumberOfVerts=\"" +
         count(model.vertices) + "\" NumberOfLines=\"" + count(model.lines) +
         "\" NumberOfStrips=\"0\" NumberOfPolys=\"" + count(model.triangles) + "\">\n";
}

}  // namespace

std::string vtp_text(const Result& result, const Model& model) {
  const std::string order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return "<?xml version=\"1.0\"?>\n<!-- SPACE=LPS: x left, y posterior, z superior, in mm -->\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"" +
         order + "\" header_type=\"UInt64\">\n<PolyData>\n" + field_data(result, model) + piece_start(model) +
         point_data(model) + cell_data(model) + points(model) + cells("Verts", model.vertices) +
         cells("Lines", model.lines) + cells("Strips", {}) + cells("Polys", model.triangles) +
         "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace bowstring
