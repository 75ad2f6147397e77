#include "core/result/solved.hpp"

#include "core/result/document.hpp"

namespace bowstring {

Solved solve_and_read(Session& session, const Registry& registry,
                      const std::function<bool(const IterationRecord&)>& progress) {
  Solved out;
  out.solution = solve(session, progress);
  out.readable = read_solution(session, out.solution, out.readings);
  out.document = result_document(session, out.solution, out.readings, registry);
  return out;
}

}  // namespace bowstring
