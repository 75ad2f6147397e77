#include "core/procedure/multistart.hpp"

namespace bowstring {

void find_equilibria(Session&, const MultistartTable&, const std::function<bool(const IterationRecord&)>&, Solution&,
                     std::vector<Equilibrium>&) {}

}  // namespace bowstring
