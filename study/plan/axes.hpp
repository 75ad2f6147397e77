#pragma once

#include <string>
#include <vector>

#include "core/composition/report.hpp"
#include "core/composition/tree.hpp"
#include "study/plan/study_file.hpp"

namespace bowstring::study {

/// Reads the entries of [axes]; a sample becomes one axis for each of its numbers, in one group. `study_file`: what
/// bases are relative to.
void read_axes(const Node& table, const std::string& study_file, std::vector<Axis>& axes,
               std::vector<AxisGroup>& groups, Report& report);

/// The axis of that name; -1 where there is none, which is reported: `whose` names it, "'exclude'".
int find_axis(const std::vector<Axis>& axes, const std::string& name, const Position& position,
              const std::string& whose, Report& report);

/// The alternative of an axis that a value means: its label, its number in the axis' unit, a quantity. -1: none.
int find_alternative(const Axis& axis, const Node& value);

/// "N_mm2" of "N mm^2", "N_per_mm" of "N/mm", "seconds" of "s": a unit as the name of a column has it.
std::string unit_suffix(const std::string& unit);

/// A name as a column can have it: letters, digits and '_'.
std::string column_name(const std::string& name);

}  // namespace bowstring::study
