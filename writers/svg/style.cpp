#include "writers/svg/style.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bowstring::style {

const char* wire_color(const Result& result, int curve) {
  std::size_t before = 0;
  for (int i = 0; i < curve; ++i) before += result.curves[static_cast<std::size_t>(i)].wire;
  return wires[before % std::size(wires)];
}

double wire_width(const ResultCurve& wire, double scale) {
  double radius = 0.0;
  for (const double r : wire.radius) {
    if (std::isfinite(r)) radius = std::max(radius, r);
  }
  return std::max(least_wire_width, 2.0 * radius * scale);
}

double largest_force(const Result& result) {
  double largest = 0.0;
  for (const ResultContact& contact : result.contacts) {
    if (contact.force > largest && std::isfinite(contact.force)) largest = contact.force;
  }
  return largest > negligible_force ? largest : 0.0;
}

double contact_radius(double force, double largest) { return greatest_contact * std::sqrt(force / largest); }

}  // namespace bowstring::style
