#pragma once

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"
#include "core/composition/curves.hpp"
#include "core/composition/tree.hpp"

namespace bowstring {

EnergyTable read_energy(const Node& table, const CurveNames& names, Reading& reading);

/// `on` is [wire, vessel].
ConstraintTable read_constraint(const Node& table, const CurveNames& names, Reading& reading);

}  // namespace bowstring
