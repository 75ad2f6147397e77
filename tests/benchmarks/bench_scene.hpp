#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/assembly/assembly.hpp"
#include "core/composition/composition.hpp"

namespace bowstring::benchmarks {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Which terms a scene is composed of; the kinematics' own rows are always there.
struct Terms {
  bool wire_bending = false, vessel_strain = false, anchoring = false, axial_tension = false, contact = false;
};
inline constexpr Terms all_terms{true, true, true, true, true};

struct SceneChoice {
  std::string file;  ///< of the project's `scenes` folder
  std::string kinematics;
  int nodes = 80;
  Terms terms = all_terms;
};

/// A shipped scene with its two curves 'iliac' and 'lunderquist', a contact window of two segments, and some of its
/// terms left out; and two states near its start that the wire's contact rows can be evaluated at.
struct BenchScene {
  std::unique_ptr<Composition> composition;
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Assembly> assembly;
  std::vector<double> state[2];
  std::vector<double> multipliers;

  const Curve& vessel() const { return *scene->find("iliac"); }
  const Curve& wire() const { return *scene->find("lunderquist"); }
};

/// Throws std::runtime_error with the refusal's text.
std::unique_ptr<BenchScene> make_bench_scene(const SceneChoice& choice);

/// Where the first entry of a field stands among the scene's coordinates and tangent numbers.
struct FieldPlace {
  int coordinate = -1, unknown = -1;
};
FieldPlace field_place(const Curve& curve, const std::string& name);

}  // namespace bowstring::benchmarks
