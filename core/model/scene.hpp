#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/constraint.hpp"
#include "core/interfaces/energy.hpp"
#include "core/interfaces/geometry.hpp"
#include "core/interfaces/kinematics.hpp"
#include "core/interfaces/solver.hpp"
#include "core/model/component.hpp"
#include "core/model/held_axes.hpp"

namespace bowstring {

/// One curve of the scene with what the composition, the geometry and its kinematics say of it.
struct Curve {
  std::string name;
  CurveView view;  ///< points into the vectors below
  std::vector<double> reference, start, start_turn, edge_length, fraction, arc;
  /// Node positions of State 1 where the rest state, `reference`, is a later one; else empty. Arc coordinates, data
  /// and profiles stay State 1's, and so does what ends hold.
  std::vector<double> state1;
  std::vector<double> previous;  ///< as in CurveView; empty: none
  std::vector<double> radius;    ///< nodal; empty where none is known
  std::vector<PointData> data;   ///< the geometry's, one value per node
  std::vector<std::string> label;
  std::vector<double> state1_tangent[2];  ///< unit, three numbers: of the geometry, whatever tangent is held
  /// Of a clamped end: the least turn of the global axes to its State 1 tangent, then its prescribed rotation; w, x, y,
  /// z. Empty where no rotation is held.
  std::vector<double> held_frame[2];
  std::string end_text[2];                    ///< what the ends hold, for people
  std::string end_position[2];                ///< where the composition says so
  int along = -1;                             ///< the vessel that a wire starts along …
  double along_begin = 0.0, along_end = 0.0;  ///< … between these arc coordinates of it, mm
  std::string kinematics_name;
  Owned<Kinematics> kinematics{nullptr, nullptr};
  Needs needs;
  KinematicsDeclaration declaration;
  int coordinate_begin = 0, coordinates = 0;  ///< slice of q
  int unknown_begin = 0, unknowns = 0;        ///< slice of the tangent numbers, fixed ones included
  const SiteDeclaration* site(Site which) const noexcept;
  const std::vector<double>& state1_points() const noexcept { return state1.empty() ? reference : state1; }
};

struct LawUse {
  const Law* law = nullptr;
  LawDescription description;
  std::vector<std::vector<double>> parameters;  ///< sampled at the law's places
};

struct EnergyUse {
  std::string label, plugin;
  int curve = 0;
  ParameterSet parameters;
  Owned<Energy> energy{nullptr, nullptr};
  EnergyDeclaration declaration;
  std::vector<LawUse> laws;
};

struct ConstraintUse {
  std::string label, plugin;  ///< no plugin: rows of ends that are held along axes of their own
  Owned<Constraint> constraint{nullptr, nullptr};
  ConstraintScene scene;
  RowDeclaration rows;
  std::vector<HeldAxis> held_axes;  ///< of such rows, one per row
};

/// Everything that will be assembled. Curves first the vessels, then the wires, in the composition's order.
struct Scene {
  int dimension = 3;
  std::vector<std::unique_ptr<Curve>> curves;
  std::vector<EnergyUse> energies;
  std::vector<ConstraintUse> constraints;
  int coordinates = 0, unknowns = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> without_effect;

  const Curve* find(const std::string& name) const noexcept;
  std::vector<double> start_coordinates() const;
  std::vector<double> reference_coordinates() const;
};

/// What a carried state is to one curve of a scene.
struct CarriedCurve {
  bool recorded = false;            ///< the state has a curve of this name …
  bool same_mesh = false;           ///< … whose nodes stand for the same material: numbers may be taken as they stand
  std::vector<double> share;        ///< nodes: where in the recorded material each lies; beyond 0 … 1 outside of it
  std::vector<double> points;       ///< its shape here, nodes × dimension, mm; empty: not known
  std::vector<double> orientation;  ///< edges × 4: quaternions, first axis along the edge; empty: not known
  std::string told;                 ///< what is interpolated: "from 24 nodes to 30"
  std::string flaw;                 ///< why the shape is not known
};

/// In the order of a scene's curves.
struct CarriedCurves {
  std::vector<CarriedCurve> curves;
  std::vector<std::string> warnings;
};

struct SceneOutcome {
  std::unique_ptr<Scene> scene;
  CarriedCurves carried;           ///< none where no state is carried
  std::vector<InputError> errors;  ///< of the input (exit code 2)
  Status plugin_failure;           ///< of a plugin (exit code 3)
};

/// Builds curves, samples profiles, asks energies for their needs, kinematics for their fields and constraints for
/// their rows. `traits` are the solver's: they set the default contact window.
///
/// `carried`: the state that the solve starts from, which terms may see (CurveView::previous), and which becomes the
/// rest state of the vessels where it says so. Then their reference is its shape at their nodes, and their own start is
/// that shape as well; wires keep their own. Ends hold what they hold without it: places and rotations of State 1 as
/// the composition moves and turns them. A state of another scene is refused at `carried->position`.
SceneOutcome build_scene(const Composition& composition, const SolverTraits& traits,
                         const CarriedState* carried = nullptr);

/// A profile at arc coordinates `arc` of a curve of length `length`, with the geometry's data and labels at the
/// coordinates `node_arc`. Answers `invalid_input` naming an unknown column or segment with what there is.
Status sample_profile(const Profile& profile, const Curve& curve, const std::vector<double>& arc,
                      std::vector<double>& out);

}  // namespace bowstring
