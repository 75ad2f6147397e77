#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/composition/recorded_state.hpp"
#include "core/composition/value_range.hpp"
#include "core/interfaces/curve.hpp"
#include "core/interfaces/registry.hpp"
#include "core/measure/curve_sampling.hpp"

namespace bowstring {

struct GivenMeasure;

/// One thing that is wrong with the user's input, as a person reads it.
struct InputError {
  std::string position;      ///< "file:line:column", or "--set path=value"
  std::string found;         ///< "unknown key 'stifness' in energy 'anchoring'"
  std::string expected;      ///< "one of: on, name, stiffness"
  std::string mend;          ///< "did you mean 'stiffness'?"
  std::string text() const;  ///< "position: found; expected …; mend"
};

/// A plugin that the composition names, with its checked parameters.
struct ComponentChoice {
  Kind kind = Kind::energy;
  std::string name;  ///< the plugin's: "wire-bending"
  ParameterSet parameters;
  const ComponentDescriptor* descriptor = nullptr;
  std::string position;  ///< of the table, "file:line:column"
};

/// One end of a curve: a type, or what is held axis by axis.
struct EndTable {
  std::string type = "pinned";  ///< `free` | `pinned` | `clamped` | `held-edge`; "" where axes are given instead
  bool position_held[3] = {true, true, true};  ///< per axis
  bool rotation_held = false;
  bool edge_held = false;
  bool in_end_axes = false;     ///< held axes, `move` and `turn` are in the end's axes, tangent first
  std::vector<double> tangent;  ///< dimension numbers, not yet normalised, or empty
  std::vector<double> move;     ///< dimension numbers: prescribed displacement from State 1, mm, or empty
  /// Prescribed rotation from State 1, rad, whole turns counted: one number (in the plane, or about the tangent), or
  /// three (a rotation vector), or empty.
  std::vector<double> turn;
  std::string position;

  bool position_free() const noexcept { return !position_held[0] && !position_held[1] && !position_held[2]; }
  /// "pinned", "position held free, rotation held", for people.
  std::string text(int dimension) const;
};

struct VesselTable {
  std::string name;
  ComponentChoice geometry;
  std::optional<ParameterValue> radius;  ///< a profile; empty: from the geometry's point data
  ComponentChoice kinematics;
  EndTable end[2];
  bool rigid = false;
  std::string position;
};

/// What the user says of a wire's length in the body; `by_ends`: it slides where both ends are held along a vessel.
enum class LengthRule : int { by_ends, sliding, fixed };

struct WireTable {
  std::string name;
  std::string vessel;                       ///< that it starts along; "" where there is none
  std::optional<ComponentChoice> geometry;  ///< its own State 1, instead of the vessel's centerline
  LengthRule length = LengthRule::by_ends;
  std::string length_position;  ///< where the user says so
  int nodes = 0;                ///< 0: the vessel's or the geometry's
  std::vector<double> span;     ///< where along the vessel it starts and ends in State 1, mm; empty: all of it
  std::string span_position;
  std::vector<double> spacing;  ///< each edge's share of the length, summing to 1; empty: uniform
  std::string spacing_position;
  ParameterValue radius;  ///< a profile
  ComponentChoice kinematics;
  EndTable end[2];
  std::string position;
};

struct EnergyTable {
  std::string label;  ///< `name`, or else the type: how paths and results call it
  std::string on;     ///< a curve
  ComponentChoice component;
};

struct ConstraintTable {
  std::string label;
  std::vector<std::string> on;  ///< curves
  ComponentChoice component;
};

/// A curve of the solution, as a measure, against another measure. It changes nothing of the solution.
struct LossTable {
  std::string label;
  std::string on;       ///< a curve
  std::string against;  ///< "/…/observed.csv", "/…/result.json#iliac"; absolute
  std::string position, against_position;
  CurveSampling sampling;  ///< of `on`, and of what it is compared with where that is a curve
  std::shared_ptr<const GivenMeasure> observed;
  ComponentChoice transport, ground_cost;
};

/// Thresholds of `converged`.
struct CertificateTable {
  double stationarity = 1e-6;     ///< N
  double penetration = 1e-8;      ///< mm, of rows
  double complementarity = 1e-8;  ///< N mm
  double multiplier = -1e-8;      ///< N, smallest admissible
  double minimum_stretch = 0.2;   ///< an edge at or below this ratio counts as folded
  std::string require = "none";   ///< "none" | "minimum"
};

/// Where a solve starts, if not at the composition's own start.
struct StartTable {
  std::string from;               ///< a result document, absolute; "": none
  std::string position;           ///< of `from`
  std::string name;               ///< "the start 'result.json'", for messages
  bool rest_is_previous = false;  ///< the state becomes the rest state of the vessels; else that is State 1
  std::shared_ptr<const RecordedState> state;
};

/// A walk from one value of a path to another, over the equilibria in between.
struct ContinuationTable {
  bool given = false;
  std::string path;
  ValueRange range;
  bool fallback = false;  ///< only where the solve from the start does not converge
  bool arclength = true;  ///< along the path of equilibria where that can be
  // Shares of the way.
  double first_step = 0.1, smallest_step = 1e-4, largest_step = 0.25;
  double tolerance = 1e-6;  ///< to which folds and bifurcations are located
  long most_points = 500;
  std::string position, path_position, from_position, to_position;
};

/// Several starts, and the equilibria that they lead to.
struct MultistartTable {
  bool given = false;
  long starts = 8;  ///< the first one unperturbed
  long seed = 1;
  bool seed_given = false;
  std::optional<double> perturbation;  ///< mm, root mean square; empty: from the scene
  bool mirrored = true;                ///< every second start is the mirror image of the one before it
  double distance = 1e-3;              ///< mm: equilibria are one where no node is farther apart
  bool saddles = true;                 ///< looked for between neighbouring minima
  std::string position;
};

/// One of the states that a composition chains. Its overrides are in the composition that is read for it.
struct StepTable {
  std::string name;               ///< or its number, from 1
  bool rest_is_previous = false;  ///< the state before becomes the rest state of vessels; else that stays State 1
  std::string position;
  /// The resolved tables in which its composition differs from that of the step before, JSON text; "": none.
  std::string tables = "";
};

/// A checked, resolved composition: every reference holds, every number is in mm, N, rad.
struct Composition {
  int schema = 1;
  std::string title;
  std::string file;
  std::vector<std::string>
      input_files;  ///< all that the user has given: the file, its bases, data of plugins; absolute
  int dimension = 3;
  std::vector<VesselTable> vessels;
  std::vector<WireTable> wires;
  std::vector<EnergyTable> energies;
  std::vector<ConstraintTable> constraints;
  std::vector<LossTable> losses;
  ComponentChoice enforcement, solver;
  CertificateTable certificate;
  StartTable start;
  ContinuationTable continuation;
  MultistartTable multistart;
  std::vector<StepTable> steps;          ///< all of them, whichever this composition is read for
  int step = 0;                          ///< the one that it is read for
  std::vector<std::string> plugin_path;  ///< absolute
  std::string resolved_json;             ///< everything above with defaults filled in, as the result document holds it
  std::vector<std::string> warnings;
  std::vector<std::string> without_effect;  ///< declared, allowed, and idle in this scene: for `explain`
};

/// Every plugin that a composition names, in the order of its tables; one as often as it is named.
std::vector<const ComponentChoice*> components_of(const Composition& composition);

/// The files of data that a composition names, absolute: those of parameters, and the document of [start].
std::vector<std::string> data_files_of(const Composition& composition);

/// `path=value` from the command line, applied after the file's own overrides.
struct Override {
  std::string path;   ///< "energy.axial-tension.tension"
  std::string value;  ///< TOML; what does not parse as TOML is a string
  /// Where it comes from, if not from the command line: "scene.toml:31:8"; errors then begin with it.
  std::string position = "";
  std::string directory = "";  ///< what files in `value` are relative to; "": the working directory
  bool after_steps = false;    ///< it comes after the overrides of steps
};

struct CompositionRequest {
  std::string file;
  std::vector<Override> overrides;
  /// The composition itself. `file`, which need not exist, is then what errors call it and where its paths start.
  std::optional<std::string> text = std::nullopt;
  int step = 0;  ///< of a composition with steps: the one whose overrides, after those before it, count
  /// A state is handed over in memory: [start] needs no 'from', and the document that it names is not read.
  bool from_memory = false;
};

struct CompositionOutcome {
  std::optional<Composition> composition;
  std::vector<InputError> errors;  ///< of the whole file at once; empty on success
  Status plugin_failure;           ///< `failed`: a known plugin could not be loaded (exit code 3)
};

/// Reads, overrides, resolves and checks a composition. Opens, through the registry, only the plugins that it names.
CompositionOutcome load_composition(const CompositionRequest& request, Registry& registry);

/// The plugin path that a composition asks for, read before any registry exists; relative to the file, absolute here.
std::vector<std::string> composition_plugin_path(const CompositionRequest& request);

}  // namespace bowstring
