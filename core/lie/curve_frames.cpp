#include "core/lie/curve_frames.hpp"

#include <cassert>
#include <cmath>

#include "core/lie/s2.hpp"

namespace bowstring::lie {

std::vector<Rotation> bishop_edge_frames(Span<const double> points, const Rotation* first) {
  const std::size_t nodes = points.size() / 3;
  std::vector<Rotation> frames;
  if (nodes < 2) return frames;
  frames.reserve(nodes - 1);
  Rotation frame = first != nullptr ? *first : Rotation::identity();
  for (std::size_t i = 0; i + 1 < nodes; ++i) {
    const double* p = points.data() + 3 * i;
    const Vector3 edge = Vector3::load(p + 3) - Vector3::load(p);
    const double length = std::hypot(edge[0], edge[1], edge[2]);
    if (length > 0.0) frame = transport(frame, edge / length);
    frames.push_back(frame);
  }
  return frames;
}

std::vector<se3::Twist> discrete_strain(Span<const Se3> frames, Span<const double> ds) {
  assert(frames.size() == ds.size() + 1);
  std::vector<se3::Twist> strains;
  strains.reserve(ds.size());
  for (std::size_t i = 0; i < ds.size(); ++i) {
    strains.push_back(se3::log(frames[i].inverse() * frames[i + 1]) / ds[i]);
  }
  return strains;
}

std::vector<se2::Twist> discrete_strain(Span<const Se2> frames, Span<const double> ds) {
  assert(frames.size() == ds.size() + 1);
  std::vector<se2::Twist> strains;
  strains.reserve(ds.size());
  for (std::size_t i = 0; i < ds.size(); ++i) {
    strains.push_back(se2::log(frames[i].inverse() * frames[i + 1]) / ds[i]);
  }
  return strains;
}

std::vector<Se3> reconstruct(const Se3& first, Span<const se3::Twist> strains, Span<const double> ds) {
  assert(strains.size() == ds.size());
  std::vector<Se3> frames{first};
  frames.reserve(ds.size() + 1);
  for (std::size_t i = 0; i < ds.size(); ++i) {
    Se3 next = frames.back() * se3::exp(ds[i] * strains[i]);
    next.rotation = next.rotation.normalized();
    frames.push_back(next);
  }
  return frames;
}

std::vector<Se2> reconstruct(const Se2& first, Span<const se2::Twist> strains, Span<const double> ds) {
  assert(strains.size() == ds.size());
  std::vector<Se2> frames{first};
  frames.reserve(ds.size() + 1);
  for (std::size_t i = 0; i < ds.size(); ++i) frames.push_back(frames.back() * se2::exp(ds[i] * strains[i]));
  return frames;
}

}  // namespace bowstring::lie
