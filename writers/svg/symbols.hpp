#pragma once

#include <string>

#include "writers/svg/markup.hpp"
#include "writers/svg/projection.hpp"

namespace bowstring {

Attributes contact_attributes();
Attributes support_attributes();

/// A triangle with its tip at `at`, which extends in the unit direction `outward`.
std::string support_symbol(const Vector2& at, const Vector2& outward);

/// How the first `axes` global axes project, as arrows from `center`; an axis along the view is a dot.
std::string triad(const Vector2& center, const View& view, int axes);

}  // namespace bowstring
