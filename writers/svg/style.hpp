#pragma once

#include <string>

#include "writers/reading/result.hpp"

namespace bowstring::style {

/// Colours of Okabe and Ito, "Color Universal Design" (2008), which all kinds of colour vision tell apart.
constexpr const char* vessel = "#0072B2";
constexpr const char* lumen = "#DCEBF6";
constexpr const char* state1 = "#8C8C8C";
constexpr const char* contact_fill = "#D55E00";
constexpr const char* ink = "#1A1A1A";
constexpr const char* soft_ink = "#595959";
constexpr const char* wires[] = {"#1A1A1A", "#009E73", "#CC79A7", "#E69F00"};

constexpr const char* wall1_dashes = "6,4";
constexpr const char* centerline1_dashes = "2,3";
constexpr const char* wall_width = "1";
constexpr const char* centerline_width = "0.8";

constexpr double least_wire_width = 1.2;   ///< px
constexpr double greatest_contact = 7.0;   ///< px, radius of the largest force
constexpr double negligible_force = 1e-6;  ///< N, below the accuracy of any solution

/// Colour of the wire with this index among the curves.
const char* wire_color(const Result& result, int curve);

/// px; the wire's true diameter, or the least width where that is thinner or unknown.
double wire_width(const ResultCurve& wire, double scale);

/// The largest contact force, N; 0 where none is worth a circle.
double largest_force(const Result& result);

/// px; the circle's area is proportional to the force.
double contact_radius(double force, double largest);

}  // namespace bowstring::style
