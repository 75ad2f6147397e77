#include "losses/transport/network-simplex/spanning_tree.hpp"

#include <limits>
#include <utility>

namespace bowstring::simplex {
namespace {

/// The arcs at each node: those of node k are `of[start[k]]` … `of[start[k + 1] − 1]`.
struct Incidence {
  std::vector<int> start, of;
};

Incidence incidence(int rows, std::size_t nodes, const std::vector<Arc>& arcs) {
  Incidence out{std::vector<int>(nodes + 1, 0), std::vector<int>(2 * arcs.size())};
  for (const Arc& arc : arcs) {
    ++out.start[static_cast<std::size_t>(arc.row) + 1];
    ++out.start[static_cast<std::size_t>(rows + arc.column) + 1];
  }
  for (std::size_t k = 0; k < nodes; ++k) out.start[k + 1] += out.start[k];
  std::vector<int> filled(out.start.begin(), out.start.end() - 1);
  for (std::size_t k = 0; k < arcs.size(); ++k) {
    for (const int node : {arcs[k].row, rows + arcs[k].column}) {
      out.of[static_cast<std::size_t>(filled[static_cast<std::size_t>(node)]++)] = static_cast<int>(k);
    }
  }
  return out;
}

}  // namespace

void SpanningTree::build(int rows, int columns, int root, const std::vector<Arc>& arcs) {
  const auto count = static_cast<std::size_t>(rows + columns);
  rows_ = rows;
  root_ = root;
  nodes_.assign(count, Node{0, -1, 1});
  next_.assign(count, -1);
  previous_.assign(count, -1);
  last_.resize(count);
  for (std::size_t k = 0; k < count; ++k) last_[k] = static_cast<int>(k);
  const Incidence at_node = incidence(rows, count, arcs);
  std::vector<int> waiting{root};
  int before = root;
  size_ = 0;
  while (!waiting.empty()) {
    const int node = waiting.back();
    waiting.pop_back();
    ++size_;
    link(before, node);
    before = node;
    const auto k = static_cast<std::size_t>(node);
    for (int a = at_node.start[k]; a < at_node.start[k + 1]; ++a) {
      const Arc& arc = arcs[static_cast<std::size_t>(at_node.of[static_cast<std::size_t>(a)])];
      const int other = node < rows ? rows + arc.column : arc.row;
      if (other == at(node).parent) continue;
      at(other).parent = node;
      at(other).mass = arc.mass;
      waiting.push_back(other);
    }
  }
  link(before, root);
  for (int node = before; node != root; node = previous_of(node)) {
    const int parent = at(node).parent;
    at(parent).size += at(node).size;
    if (last_of(parent) == parent) last_of(parent) = last_of(node);
  }
}

SpanningTree::Blocking SpanningTree::find_blocking(int row, int column) const noexcept {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  Blocking on_row{-1, 0, most, true}, on_column{-1, 0, most, false};
  int a = row, b = column;
  while (a != b) {
    const Node &of_a = at(a), &of_b = at(b);
    if (of_a.size < of_b.size) {
      if (a < rows_ && of_a.mass < on_row.mass) {
        on_row.mass = of_a.mass;
        on_row.node = a;
      }
      a = of_a.parent;
    } else {
      if (b >= rows_ && of_b.mass <= on_column.mass) {
        on_column.mass = of_b.mass;
        on_column.node = b;
      }
      b = of_b.parent;
    }
  }
  on_row.join = on_column.join = a;
  return on_row.mass < on_column.mass ? on_row : on_column;
}

/// Arcs alternate: what the entering arc brings leaves the first one up from its ends, comes on the second, …
void SpanningTree::push_mass(int from, int join, std::int64_t mass) noexcept {
  for (int node = from; node != join; node = at(node).parent) {
    at(node).mass -= mass;
    mass = -mass;
  }
}

void SpanningTree::add_size(int from, int join, int change) noexcept {
  for (int node = from; node != join; node = at(node).parent) at(node).size += change;
}

void SpanningTree::link(int node, int after) noexcept {
  next_of(node) = after;
  previous_of(after) = node;
}

void SpanningTree::cut(int top) noexcept {
  const int tail = last_of(top), before = previous_of(top);
  link(before, next_of(tail));
  for (int node = at(top).parent; node >= 0 && last_of(node) == tail; node = at(node).parent) last_of(node) = before;
}

/// Turns the subtree of `top`, which has been cut off, so that `node` is on top of it. Its list becomes that of node's
/// old subtree, then what its old parent had besides, and so on up. Returns the list's last node.
int SpanningTree::reroot(int top, int node, std::int64_t entering_mass) noexcept {
  const int total = at(top).size;
  int below = node, last = last_of(node), before = previous_of(node), after = next_of(last), tail = last;
  int up = at(node).parent, size = at(node).size;
  std::int64_t mass = at(node).mass;
  at(node).mass = entering_mass;
  at(node).size = total;
  while (below != top) {
    const int up_last = last_of(up), up_before = previous_of(up), up_parent = at(up).parent;
    const int up_after = up_last == last ? after : next_of(up_last);
    link(tail, up);
    if (up_last == last) {
      tail = before;
    } else {
      link(before, after);
      tail = up_last;
    }
    std::swap(mass, at(up).mass);
    size = std::exchange(at(up).size, total - size);
    at(up).parent = below;
    below = up;
    last = up_last;
    before = up_before;
    after = up_after;
    up = up_parent;
  }
  for (int k = top; k != node; k = at(k).parent) last_of(k) = tail;
  last_of(node) = tail;
  return tail;
}

void SpanningTree::hang(int node, int tail, int parent) noexcept {
  link(tail, next_of(parent));
  link(parent, node);
  at(node).parent = parent;
  for (int k = parent; k >= 0 && last_of(k) == parent; k = at(k).parent) last_of(k) = tail;
}

SpanningTree::Part SpanningTree::exchange(int row, int column) {
  const int row_node = row, column_node = rows_ + column;
  const Blocking blocking = find_blocking(row_node, column_node);
  push_mass(row_node, blocking.join, blocking.mass);
  push_mass(column_node, blocking.join, blocking.mass);
  const int top = blocking.node, count = at(top).size;
  const int inside = blocking.on_row_side ? row_node : column_node, outside = row_node + column_node - inside;
  add_size(at(top).parent, blocking.join, -count);
  add_size(outside, blocking.join, count);
  cut(top);
  const int tail = reroot(top, inside, blocking.mass);
  hang(inside, tail, outside);
  if (2 * count <= size_) return {inside, count, blocking.on_row_side};
  return {next_of(tail), size_ - count, !blocking.on_row_side};
}

bool SpanningTree::carry(const std::vector<std::int64_t>& supply, const std::vector<std::int64_t>& demand) {
  std::vector<std::int64_t> net(supply);
  net.reserve(nodes_.size());
  for (const std::int64_t mass : demand) net.push_back(-mass);
  const int tail = previous_of(root_);
  for (int node = tail; node != root_; node = previous_of(node)) {
    const std::int64_t upward = net[static_cast<std::size_t>(node)];
    if (node < rows_ ? upward < 0 : upward >= 0) return false;
    net[static_cast<std::size_t>(at(node).parent)] += upward;
  }
  for (int node = tail; node != root_; node = previous_of(node)) {
    const std::int64_t upward = net[static_cast<std::size_t>(node)];
    at(node).mass = node < rows_ ? upward : -upward;
  }
  return true;
}

std::vector<Arc> SpanningTree::arcs(std::int64_t more_than) const {
  std::vector<Arc> out;
  for (int node = 0; node < static_cast<int>(nodes_.size()); ++node) {
    const Node& here = at(node);
    if (here.parent < 0 || here.mass <= more_than) continue;
    if (node < rows_) out.push_back({node, here.parent - rows_, here.mass});
    if (node >= rows_) out.push_back({here.parent, node - rows_, here.mass});
  }
  return out;
}

}  // namespace bowstring::simplex
