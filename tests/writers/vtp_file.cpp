#include "tests/writers/vtp_file.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

namespace bowstring::testing {

namespace {

using Tree = boost::property_tree::ptree;

std::string attribute(const Tree& element, const std::string& name) {
  return element.get<std::string>("<xmlattr>." + name, "");
}

std::string decoded(const std::string& text) {
  std::string out;
  std::uint32_t bits = 0;
  int held = 0;
  std::size_t digits = 0, padding = 0;
  for (const char c : text) {
    if (c == '\n' || c == ' ') continue;
    ++digits;
    if (c == '=') {
      ++padding;
      continue;
    }
    const char* alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* at = std::strchr(alphabet, c);
    if (padding > 0 || at == nullptr) FAIL("found '" << c << "' in base64");
    bits = bits << 6 | static_cast<std::uint32_t>(at - alphabet);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out += static_cast<char>(bits >> held & 0xffu);
  }
  REQUIRE(digits % 4 == 0);
  REQUIRE(padding < 3);
  return out;
}

/// The content behind the byte count.
std::string content(const Tree& array) {
  REQUIRE(attribute(array, "format") == "binary");
  const std::string bytes = decoded(array.data());
  std::uint64_t size = 0;
  REQUIRE(bytes.size() >= sizeof size);
  std::memcpy(&size, bytes.data(), sizeof size);
  REQUIRE(bytes.size() - sizeof size == size);
  return bytes.substr(sizeof size);
}

template <class T>
std::vector<T> numbers(const Tree& array, const std::string& type) {
  REQUIRE(attribute(array, "type") == type);
  const std::string bytes = content(array);
  REQUIRE(bytes.size() % sizeof(T) == 0);
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

std::vector<std::array<double, 3>> triples(const Tree& array, std::size_t count) {
  const std::vector<double> flat = numbers<double>(array, "Float64");
  REQUIRE(flat.size() == 3 * count);
  std::vector<std::array<double, 3>> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back({flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]});
  return out;
}

/// The elements in a section that hold data, with their names.
std::vector<std::pair<std::string, const Tree*>> arrays(const Tree& section) {
  std::vector<std::pair<std::string, const Tree*>> out;
  for (const auto& [tag, element] : section) {
    if (tag == "DataArray" || tag == "Array") out.emplace_back(attribute(element, "Name"), &element);
  }
  return out;
}

VtpCells read_cells(const Tree& piece, const std::string& tag, std::size_t points) {
  VtpCells out;
  for (const auto& [name, array] : arrays(piece.get_child(tag))) {
    (name == "offsets" ? out.offsets : out.connectivity) = numbers<std::int64_t>(*array, "Int64");
  }
  REQUIRE(std::to_string(out.offsets.size()) == attribute(piece, "NumberOf" + tag));
  REQUIRE(static_cast<std::size_t>(out.offsets.empty() ? 0 : out.offsets.back()) == out.connectivity.size());
  REQUIRE(std::is_sorted(out.offsets.begin(), out.offsets.end()));
  for (const std::int64_t point : out.connectivity) {
    if (point < 0 || point >= static_cast<std::int64_t>(points)) FAIL(tag << " have point " << point);
  }
  return out;
}

void read_fields(const Tree& section, VtpFile& out) {
  for (const auto& [name, array] : arrays(section)) {
    REQUIRE(attribute(*array, "type") == "String");
    std::istringstream text(content(*array));
    std::vector<std::string>& strings = out.fields[name];
    for (std::string entry; std::getline(text, entry, '\0');) strings.push_back(entry);
    REQUIRE(std::to_string(strings.size()) == attribute(*array, "NumberOfTuples"));
  }
}

}  // namespace

std::vector<std::size_t> VtpCells::cell(std::size_t c) const {
  std::vector<std::size_t> out;
  const std::int64_t begin = c == 0 ? 0 : offsets[c - 1];
  for (std::int64_t k = begin; k < offsets[c]; ++k) {
    out.push_back(static_cast<std::size_t>(connectivity[static_cast<std::size_t>(k)]));
  }
  return out;
}

std::int32_t VtpFile::part(const std::string& name) const {
  const std::vector<std::string>& names = fields.at("part_names");
  const auto at = std::find(names.begin(), names.end(), name);
  REQUIRE_MESSAGE(at != names.end(), name);
  return static_cast<std::int32_t>(at - names.begin());
}

std::vector<std::size_t> VtpFile::cells_of(const std::string& part_name) const {
  const std::int32_t number = part(part_name);
  const std::vector<std::int32_t>& parts = cell_data.at("part");
  std::vector<std::size_t> out;
  std::size_t first = 0;
  for (const VtpCells* cells : {&vertices, &lines, &polygons}) {
    for (std::size_t c = 0; c < cells->offsets.size(); ++c) {
      if (parts[first + c] == number) out.push_back(c);
    }
    first += cells->offsets.size();
  }
  REQUIRE_MESSAGE(!out.empty(), part_name);
  return out;
}

VtpFile read_vtp(const std::string& text) {
  std::istringstream in(text);
  Tree root;
  boost::property_tree::read_xml(in, root);
  const Tree& file = root.get_child("VTKFile");
  REQUIRE(attribute(file, "type") == "PolyData");
  REQUIRE(attribute(file, "version") == "1.0");
  REQUIRE(attribute(file, "byte_order") == "LittleEndian");
  REQUIRE(attribute(file, "header_type") == "UInt64");
  const Tree& data = file.get_child("PolyData");
  REQUIRE(data.count("Piece") == 1);
  const Tree& piece = data.get_child("Piece");
  const std::size_t count = piece.get<std::size_t>("<xmlattr>.NumberOfPoints");

  VtpFile out;
  read_fields(data.get_child("FieldData"), out);
  out.points = triples(*arrays(piece.get_child("Points")).at(0).second, count);
  out.vertices = read_cells(piece, "Verts", count);
  out.lines = read_cells(piece, "Lines", count);
  out.polygons = read_cells(piece, "Polys", count);
  REQUIRE(attribute(piece, "NumberOfStrips") == "0");
  const Tree& point_data = piece.get_child("PointData");
  out.active_vectors = attribute(point_data, "Vectors");
  out.active_normals = attribute(point_data, "Normals");
  for (const auto& [name, array] : arrays(point_data)) {
    if (attribute(*array, "NumberOfComponents") == "3") {
      out.vectors[name] = triples(*array, count);
    } else {
      REQUIRE(attribute(*array, "NumberOfComponents") == "1");
      out.scalars[name] = numbers<double>(*array, "Float64");
      REQUIRE(out.scalars[name].size() == count);
    }
  }
  const std::size_t cells = out.vertices.offsets.size() + out.lines.offsets.size() + out.polygons.offsets.size();
  for (const auto& [name, array] : arrays(piece.get_child("CellData"))) {
    out.cell_data[name] = numbers<std::int32_t>(*array, "Int32");
    REQUIRE(out.cell_data[name].size() == cells);
  }
  return out;
}

}  // namespace bowstring::testing
