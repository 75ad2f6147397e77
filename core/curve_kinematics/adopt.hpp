#pragma once

#include <vector>

#include "core/curve_kinematics/curve_mesh.hpp"
#include "core/curve_kinematics/fields.hpp"
#include "core/interfaces/kinematics.hpp"

/// What every kinematics of straight edges does to take the shape of another curve.
namespace bowstring {

/// `invalid_input` naming the first thing that is no shape of this curve: another number of nodes, a number that is not
/// finite, an edge of length zero, a quaternion that is not of length 1.
Status check_shape(const CurveMesh& mesh, const CurveShape& shape);

/// Writes the positions, and of a sliding wire its length: that of its edges in this shape without the held ones.
void adopt_positions(const CurveMesh& mesh, const CurveShape& shape, const FieldSlot& position, const FieldSlot& length,
                     Span<double> q);

/// Angles of the edges in the plane, without jumps along the curve. Of the whole turns by which they are not determined
/// those are taken that leave the least angle to the held tangents (`held`, their angles, the first end's first), or
/// else to the angle `near` of the first edge.
std::vector<double> adopted_angles(const CurveMesh& mesh, const CurveShape& shape, const std::vector<double>& held,
                                   double near);

}  // namespace bowstring
