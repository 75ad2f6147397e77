#pragma once

#include "core/composition/components.hpp"
#include "core/composition/curves.hpp"
#include "core/interfaces/span.hpp"

namespace bowstring {

/// One [[loss]], with the measure that it compares with, which is read here.
LossTable read_loss(const Node& table, const CurveNames& names, Reading& reading);
/// What [[loss]] takes beside curves, measures and plugins.
Span<const ParameterDeclaration> loss_schema();

}  // namespace bowstring
