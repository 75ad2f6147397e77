#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace bowstring::testing {

struct VtpCells {
  std::vector<std::int64_t> connectivity, offsets;

  /// The points of cell c.
  std::vector<std::size_t> cell(std::size_t c) const;
};

/// What a VTK XML PolyData file holds, read by Boost's XML parser and a base64 decoder of its own, which share nothing
/// with the writer.
struct VtpFile {
  std::string active_vectors, active_normals;
  std::vector<std::array<double, 3>> points;
  std::map<std::string, std::vector<double>> scalars;                 ///< one number per point
  std::map<std::string, std::vector<std::array<double, 3>>> vectors;  ///< three
  std::map<std::string, std::vector<std::int32_t>> cell_data;
  std::map<std::string, std::vector<std::string>> fields;
  VtpCells vertices, lines, polygons;

  /// The number of the part of this name, which must exist.
  std::int32_t part(const std::string& name) const;
  /// The cells of a part, as numbers within their type.
  std::vector<std::size_t> cells_of(const std::string& part_name) const;
};

/// Reads, and checks all that the format demands: the attributes of the file, one piece, sizes that agree with the
/// counts of the piece, connectivity and offsets in range.
VtpFile read_vtp(const std::string& text);

}  // namespace bowstring::testing
