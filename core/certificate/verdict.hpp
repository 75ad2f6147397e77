#pragma once

namespace bowstring {

/// What the kernel says of a solution: the `status` of a result document, described in docs/results.md.
enum class Verdict : int { converged, invalid, stalled, infeasible, diverged, failed };
const char* verdict_name(Verdict verdict) noexcept;

}  // namespace bowstring
