#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "core/check/check.hpp"

namespace bowstring::checking {

/// Modes that one sentence describes.
struct ModeFamily {
  std::string subject;  ///< "'wire'", "the scene"
  int count = 0;
  std::string text;  ///< "its nodes may slide along it"
};

/// Families of near-zero modes; arguments as of `name_modes`.
std::vector<ModeFamily> mode_families(const Assembly& assembly, const std::vector<double>& q,
                                      const Eigen::VectorXd& scale, Eigen::MatrixXd modes);

/// Words for near-zero modes: columns over the free unknowns in mm, x = scale · δ. Counts those of each curve that lie
/// in a family (rigid motions, sliding of its nodes along it, turns of single frames); of the rest it names the unknown
/// that moves most. `at_least`: there may be more modes than were looked for.
std::vector<CheckLine> name_modes(const Assembly& assembly, const std::vector<double>& q, const Eigen::VectorXd& scale,
                                  Eigen::MatrixXd modes, bool at_least);

}  // namespace bowstring::checking
