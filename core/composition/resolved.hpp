#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"

namespace bowstring {

/// The composition as a JSON text with every default filled in: the same tables and keys as a composition in TOML,
/// bare numbers in the declared units, and text with a unit where the unit decides what is meant. Numbers in the
/// shortest form that gives the same double back (at most 17 digits), always in the same order. Written as TOML
/// again (core/composition/resolved_toml.hpp), it resolves to itself.
///
/// Steps stand in that of the first of them, whose overrides are in it already: a step holds whole resolved tables,
/// those that differ from the ones before, so that it does not depend on how a path was written. The composition of a
/// later step is that of its state alone.
std::string resolved_json(const Composition& composition);

/// One plugin with its parameters, as it stands there: JSON text, a table with `type`.
std::string component_json(const ComponentChoice& choice);

/// The tables of a resolved composition that differ from those of another, JSON text; "" where none does. What steps
/// cannot set is left out.
std::string differing_tables(const std::string& resolved, const std::string& before);

}  // namespace bowstring
