#pragma once

#include <string>
#include <vector>

#include <Eigen/Dense>

#include "core/assembly/assembly.hpp"

namespace bowstring {

/// Words for directions without curvature, one text per family: rigid motions of each curve, and of curves that touch,
/// turns about tangents, sliding along a vessel; then what core/check names. `modes`: columns over the free unknowns.
/// `metric`: > 0 per free unknown, in which they are compared. `at_least`: there may be more.
std::vector<std::string> name_neutral_modes(Assembly& assembly, const std::vector<double>& q,
                                            const std::vector<double>& jacobian, const Eigen::VectorXd& metric,
                                            const Eigen::MatrixXd& modes, bool at_least);

/// "'rod' moves most at s = 50 mm, along (0, 1)". One direction over the free unknowns.
std::string describe_direction(const Assembly& assembly, const Eigen::VectorXd& direction);

}  // namespace bowstring
