#pragma once

#include <string>

#include "writers/svg/markup.hpp"
#include "writers/svg/projection.hpp"

namespace bowstring {

Attributes contact_attributes();

/// A contact force as a circle. Its outline tells neighbours apart, and leaves most of a small circle to its fill.
std::string contact_symbol(const Vector2& at, double radius, const Attributes& more = {});

Attributes support_attributes();

/// A triangle with its tip at `at`, which extends in the unit direction `outward`.
std::string support_symbol(const Vector2& at, const Vector2& outward);

/// How the first `axes` global axes project, as arrows from `center`. An axis along the view is a circle with a
/// dot where it points to the reader, and with a cross where it points away.
std::string triad(const Vector2& center, const View& view, int axes);

}  // namespace bowstring
