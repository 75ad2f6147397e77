#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/recheck/rotation.hpp"

namespace recheck {

using Json = nlohmann::json;

/// What the composition says of one end of a curve. Axes are global.
struct End {
  bool position_held[3] = {false, false, false};
  bool rotation_held = false;
  bool edge_held = false;
  Point tangent;                ///< unit: what a clamp holds in State 1
  Point move;                   ///< mm
  Point turn;                   ///< rotation vector; in the plane its third number
  double twist = 0.0;           ///< rotation about the tangent, before `turn`
  std::vector<Point> row_axes;  ///< the own axes that it is held along, where not all are: one equality row each
};

enum class Extension { sliding, fixed, stretching };

/// How edges are oriented: by an angle in the plane, by a direction in space, by a frame where something twists.
enum class Orientation { angle, direction, frame };

struct Curve {
  std::string name;
  bool wire = false;
  bool edge_frames = false;  ///< orientations are unknowns of their own; otherwise they follow from the nodes
  bool rigid = false;
  Extension extension = Extension::stretching;
  Orientation orientation = Orientation::angle;
  int dimension = 3, nodes = 0;
  End end[2];
  std::vector<Point> reference, points;  ///< nodes: the rest state; what `curves` says of State 2, mm
  std::vector<Point> state1;             ///< nodes: State 1, mm: `reference` but where the rest state is a later one
  bool later_rest = false;
  Point rest_tangent[2];       ///< what a clamped end holds in a later rest state
  std::vector<double> radius;  ///< nodes, mm; empty where unknown
  std::vector<double> share;   ///< edges: f_i of a sliding wire, 0 on held edges
  Json description;            ///< its table in the composition

  std::vector<Point> position;       ///< nodes: state
  std::vector<double> angle;         ///< edges: in the plane, or the twist of `nodes` with frames
  std::vector<Frame<double>> frame;  ///< edges: of edge frames in space
  std::vector<double> edge_length;   ///< edges: of a vessel of edge frames
  std::optional<double> length;      ///< of a sliding wire, without held edges
  std::vector<double> held_angle;    ///< clamped ends, the first before the last
  std::vector<Frame<double>> held_frame;

  int edges() const { return nodes - 1; }
  bool edge_held(int edge) const;
  bool position_held(int node, int axis) const;
  bool wholly_held(int node) const;
  /// Number of the end's held tangent among those of the curve; −1 where it holds none.
  int held_tangent(int end) const;
};

/// One entry of `contacts`: where a row acts, and what it says.
struct ContactEntry {
  std::string wire, vessel;
  double coordinate = 0.0;  ///< wire edges from the first node
  double vessel_arc = 0.0;  ///< mm, State 1
  double gap = 0.0, force = 0.0;
};

struct Thresholds {
  double stationarity = 1e-6, penetration = 1e-8, complementarity = 1e-8, multiplier = -1e-8, stretch = 0.2;
};

/// A written result document, and nothing but what it holds.
struct Result {
  std::string status;
  int dimension = 3;
  std::vector<Curve> curves;
  Json energies = Json::array(), constraints = Json::array();  ///< of the composition
  Thresholds thresholds;
  std::map<std::string, std::vector<double>> multipliers;
  std::map<std::string, double> energy;  ///< reported, with "total"
  double stationarity = 0.0;             ///< reported, N
  std::vector<ContactEntry> contacts;
  std::vector<std::string> unknown;  ///< parts of the document that this program cannot judge

  const Curve& curve(const std::string& name) const;
  int index(const std::string& name) const;
};

/// Throws std::runtime_error saying what the document lacks.
/// The document's own state, "", then those of its other steps and its equilibria.
std::vector<std::pair<std::string, Result>> read_results(const std::string& file);

/// A quantity of the composition: a number, or a number and its unit in one text.
double number_of(const Json& value);

}  // namespace recheck
