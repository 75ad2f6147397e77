#include "core/check/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check/differences.hpp"

namespace bowstring::checking {

namespace {

constexpr double rounding = 64.0 * std::numeric_limits<double>::epsilon();
constexpr double weakest_family = 1e-9;  // of the largest size of all
constexpr double unsettled = 0.1;        // of the miss: differences that still move by more do not settle
constexpr double kink = 0.3;             // of the jump at the first step; where f is smooth it shrinks like the step
constexpr double shrinking = 0.2;        // of the miss at a ten times larger step
constexpr double clearly = 0.01;         // of the tolerance: better need not be known

/// The largest of each family, spread to its members.
std::vector<double> family_largest(const std::vector<double>& numbers, const std::vector<int>& family) {
  std::vector<double> largest;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto f = static_cast<std::size_t>(family[i]);
    if (f >= largest.size()) largest.resize(f + 1, 0.0);
    largest[f] = std::max(largest[f], numbers[i]);
  }
  std::vector<double> out(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) out[i] = largest[static_cast<std::size_t>(family[i])];
  return out;
}

}  // namespace

Comparison::Comparison(Claim claim, double tolerance)
    : claim_(std::move(claim)), tolerance_(tolerance), track_(claim_.value.size()) {
  const std::size_t k = claim_.value.size();
  std::vector<double> size(k);
  double largest = 0.0;
  for (std::size_t i = 0; i < k; ++i) {
    size[i] = claim_.size[i] * claim_.weight[i];
    largest = std::max(largest, size[i]);
    vanishes_ = vanishes_ && claim_.value[i] == 0.0;
  }
  scale_ = family_largest(size, claim_.family);
  for (std::size_t i = 0; i < k; ++i) {
    scale_[i] = std::max({size[i], claim_.floor * scale_[i], weakest_family * largest, claim_.least});
  }
}

void Comparison::add(double step, const Samples& f) {
  const std::size_t k = claim_.value.size();
  std::vector<double> magnitude(k);
  for (std::size_t i = 0; i < k; ++i) {
    double largest = 0.0;
    for (const std::vector<double>* values : f) largest = std::max(largest, std::fabs((*values)[i]));
    magnitude[i] = std::max(largest * claim_.weight[i], claim_.magnitude);
  }
  magnitude = family_largest(magnitude, claim_.family);
  for (std::size_t i = 0; i < k; ++i) {
    const double fm2 = (*f[0])[i], fm1 = (*f[1])[i], f0 = (*f[2])[i], fp1 = (*f[3])[i], fp2 = (*f[4])[i];
    const double w = claim_.weight[i];
    const double noise = rounding * magnitude[i] / step;
    const double difference = first_difference(fm2, fm1, fp1, fp2, step);
    const double relative_to = std::max(scale_[i], std::fabs(difference) * w);
    Track& track = track_[i];
    vanishes_ = vanishes_ && std::fabs(difference) * w <= noise;
    if (track.steps > 0 && noise > tolerance_ * relative_to) continue;
    const double miss = std::max(0.0, std::fabs(claim_.value[i] - difference) * w - noise);
    track.difference[1] = std::exchange(track.difference[0], difference);
    track.miss[2] = std::exchange(track.miss[1], std::exchange(track.miss[0], miss));
    track.noise = noise;
    track.jump = std::fabs(fp1 - 2.0 * f0 + fm1) / step * w;
    if (track.steps++ == 0) track.first_jump = track.jump;
    const double error = miss == 0.0 ? 0.0 : miss / relative_to;
    track.error = std::min(track.error, std::isfinite(error) ? error : std::numeric_limits<double>::max());
  }
  compared_ = true;
}

bool Comparison::settled() const noexcept {
  const auto clear = [&](const Track& track) { return track.error <= clearly * tolerance_; };
  return compared_ && std::all_of(track_.begin(), track_.end(), clear);
}

double Comparison::error(int component) const noexcept {
  const Track& track = track_[static_cast<std::size_t>(component)];
  return converges(track) ? std::min(track.error, tolerance_) : track.error;
}

bool Comparison::converges(const Track& track) const noexcept {
  return track.steps >= 2 && track.miss[0] <= shrinking * track.miss[1] &&
         (track.steps == 2 || track.miss[1] <= shrinking * track.miss[2]);
}

bool Comparison::keeps_jumping(const Track& track) const noexcept {
  return track.steps >= 2 && track.jump > kink * track.first_jump + track.noise;
}

Outcome Comparison::outcome(int component) const noexcept {
  const auto i = static_cast<std::size_t>(component);
  const Track& track = track_[i];
  if (track.error <= tolerance_ || converges(track)) return Outcome::agrees;
  const double moved = std::fabs(track.difference[0] - track.difference[1]) * claim_.weight[i];
  if (track.steps >= 2 && moved > unsettled * track.miss[0] + track.noise) return Outcome::not_smooth;
  const bool kinked = std::any_of(track_.begin(), track_.end(), [&](const Track& other) {
    return keeps_jumping(other) && other.jump > kink * track.miss[0];
  });
  return kinked ? Outcome::not_smooth : Outcome::wrong;
}

}  // namespace bowstring::checking
