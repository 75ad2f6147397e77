#pragma once

#include "core/composition/components.hpp"
#include "core/composition/composition.hpp"

namespace bowstring {

/// [continuation]; `given` is false without the table. Whether the path leads anywhere and its values are sound is
/// found when the composition is read at its ends.
ContinuationTable read_continuation(const Node& root, Report& report);

/// [multistart]; `given` is false without the table.
MultistartTable read_multistart(const Node& root, Report& report);
/// What [multistart] takes.
Span<const ParameterDeclaration> multistart_schema();

/// The names of every [[step]] in order, and what each says beyond its overrides.
std::vector<StepTable> read_steps(const Node& root, Report& report);

/// Lays the overrides of steps 0 … `last` over the composition, one after the other, and takes the steps themselves
/// away.
void apply_steps(Node& root, int last, Report& report);

}  // namespace bowstring
