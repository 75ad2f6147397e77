#include "core/curve/bend_chain.hpp"

#include <cmath>
#include <utility>

#include "core/curve/gauss_legendre.hpp"

namespace bowstring {

namespace {

constexpr double two_pi = 6.283185307179586476925287;

/// Angle that a segment's tangent has turned at the arc length `s` from its start.
double turned_angle(const BendSegment& segment, double s) {
  const double phase = two_pi * s / segment.length;
  return segment.bend * (phase - std::sin(phase)) / two_pi;
}

}  // namespace

BendChain::BendChain(std::vector<BendSegment> segments) : segments_(std::move(segments)) {
  start_.push_back({});
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const BendSegment& segment = segments_[i];
    const Start& from = start_.back();
    const Vector3 toward = bend_direction(i);
    const double cosine = std::cos(segment.plane);
    const double sine = std::sin(segment.plane);
    // The bend turns the plane of tangent and `toward`; `aside`, perpendicular to both, stays.
    const Vector3 aside = cosine * from.binormal - sine * from.normal;
    const Vector3 turned = std::cos(segment.bend) * toward - std::sin(segment.bend) * from.tangent;
    Start next;
    next.arc = from.arc + segment.length;
    next.position = position_in(i, segment.length);
    next.tangent = std::cos(segment.bend) * from.tangent + std::sin(segment.bend) * toward;
    next.normal = cosine * turned - sine * aside;
    next.binormal = sine * turned + cosine * aside;
    start_.push_back(next);
  }
}

std::size_t BendChain::segment_at(double arc) const {
  std::size_t i = 0;
  while (i + 1 < segments_.size() && arc >= start_[i + 1].arc) ++i;
  return i;
}

Vector3 BendChain::bend_direction(std::size_t segment) const {
  const double plane = segments_[segment].plane;
  return std::cos(plane) * start_[segment].normal + std::sin(plane) * start_[segment].binormal;
}

Vector3 BendChain::position_in(std::size_t segment, double local) const {
  const BendSegment& shape = segments_[segment];
  const Start& from = start_[segment];
  const int panels = 8 + static_cast<int>(std::ceil(4.0 * std::abs(shape.bend)));
  double along = 0.0;
  double aside = 0.0;
  for (int i = 0; i < panels; ++i) {
    const double begin = local * i / panels;
    const double end = local * (i + 1) / panels;
    along += gauss_legendre([&](double s) { return std::cos(turned_angle(shape, s)); }, begin, end);
    aside += gauss_legendre([&](double s) { return std::sin(turned_angle(shape, s)); }, begin, end);
  }
  return from.position + along * from.tangent + aside * bend_direction(segment);
}

Vector3 BendChain::position(double arc) const {
  const std::size_t i = segment_at(arc);
  return position_in(i, arc - start_[i].arc);
}

Vector3 BendChain::tangent(double arc) const {
  const std::size_t i = segment_at(arc);
  const double angle = turned_angle(segments_[i], arc - start_[i].arc);
  return std::cos(angle) * start_[i].tangent + std::sin(angle) * bend_direction(i);
}

Vector3 BendChain::curvature_vector(double arc) const {
  const std::size_t i = segment_at(arc);
  const BendSegment& segment = segments_[i];
  const double s = arc - start_[i].arc;
  const double angle = turned_angle(segment, s);
  const double curvature = segment.bend / segment.length * (1.0 - std::cos(two_pi * s / segment.length));
  return curvature * (std::cos(angle) * bend_direction(i) - std::sin(angle) * start_[i].tangent);
}

}  // namespace bowstring
