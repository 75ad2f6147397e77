#include "losses/transport/network-simplex/dense_costs.hpp"

#include <algorithm>
#include <cmath>

#include "plugins/sdk/guard.hpp"

namespace bowstring::simplex {
namespace {

void require(const Status& status) {
  if (!status.ok()) throw StatusError(status);
}

}  // namespace

void DenseCosts::load(PairCosts& source) {
  evaluated_.clear();
  data_ = source.matrix();
  if (data_ != nullptr) return;
  make_room(source);
  require(source.rows(0, source.row_count(), own_));
}

void DenseCosts::load_bounds(PairCosts& source) {
  if (!source.dear() || source.matrix() != nullptr) return load(source);
  source_ = &source;
  make_room(source);
  require(source.lower_bounds(0, source.row_count(), own_));
  if (!std::all_of(own_.begin(), own_.end(), [](double bound) { return std::isfinite(bound); })) {
    throw StatusError(Code::failed, "a lower bound of the ground cost is not finite");
  }
  evaluated_.assign(own_.size(), false);
}

void DenseCosts::make_room(const PairCosts& source) {
  own_.resize(static_cast<std::size_t>(source.row_count()) * static_cast<std::size_t>(source.column_count()));
  data_ = own_.data();
}

std::size_t DenseCosts::evaluate(const std::vector<Arc>& arcs) {
  if (evaluated_.empty()) return 0;
  const auto place = [this](int row, int column) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(source_->column_count()) +
           static_cast<std::size_t>(column);
  };
  std::vector<int> pairs;
  for (const Arc& arc : arcs) {
    if (!evaluated_[place(arc.row, arc.column)]) pairs.insert(pairs.end(), {arc.row, arc.column});
  }
  std::vector<double> value(pairs.size() / 2);
  if (!value.empty()) require(source_->evaluate(pairs, value));
  for (std::size_t k = 0; k < value.size(); ++k) {
    const std::size_t at = place(pairs[2 * k], pairs[2 * k + 1]);
    own_[at] = value[k];
    evaluated_[at] = true;
  }
  return value.size();
}

}  // namespace bowstring::simplex
