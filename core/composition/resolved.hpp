#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"

namespace bowstring {

/// The composition as a JSON text with every default filled in: the same tables and keys as a composition in TOML,
/// bare numbers in the declared units, and text with a unit where the unit decides what is meant. Numbers in the
/// shortest form that gives the same double back (at most 17 digits), always in the same order. Written as TOML
/// again, it resolves to itself.
std::string resolved_json(const Composition& composition);

}  // namespace bowstring
