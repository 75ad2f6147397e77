#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/lie/so3.hpp"
#include "writers/reading/result.hpp"

namespace bowstring {

/// A point of the file with all its data. What is unknown, or has no meaning there, is not a number.
struct ModelPoint {
  Vector3 position;                                              ///< mm
  Vector3 normal;                                                ///< unit: outward on surfaces, else across the curve
  Vector3 displacement;                                          ///< mm
  Vector3 moment;                                                ///< N mm, in the axes of the frame
  Vector3 force;                                                 ///< N; zero where no contact is
  lie::Rotation frame;                                           ///< first axis along the curve
  double arc = 0.0, radius = 0.0, curvature = 0.0, twist = 0.0;  ///< mm, mm, 1/mm, 1/mm
  double gap = 0.0;                                              ///< mm
};

/// The numbers of cell array `kind`.
enum class PartKind : std::int32_t { vessel_centerline, wire_centerline, lumen, wire_surface, contact_forces };
inline constexpr const char* part_kind_names[] = {"vessel centerline", "wire centerline", "lumen surface",
                                                  "wire surface", "contact forces"};

struct ModelPart {
  std::string name;
  PartKind kind;
};

/// Cells of one type: cell c has the points connectivity[offsets[c − 1]] … connectivity[offsets[c] − 1].
struct ModelCells {
  std::vector<std::int64_t> connectivity, offsets;
  std::vector<std::int32_t> part;

  void add(const std::vector<std::int64_t>& points, std::int32_t of_part);
};

/// What one VTK PolyData holds.
struct Model {
  std::vector<ModelPoint> points;
  std::vector<ModelPart> parts;
  ModelCells vertices, lines, triangles;
};

/// Centerlines of all curves, the surfaces of those with a radius, and the contact rows as points, in this order.
/// Throws a StatusError with `invalid_input` that says where something is missing: finite points, reference points and
/// frames, a radius at every node or at none, a contact's place on its wire. Contact rows without a known force are
/// left out, and the name of the part says how many.
Model build_model(const Result& result);

}  // namespace bowstring
