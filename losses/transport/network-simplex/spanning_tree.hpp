#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bowstring::simplex {

/// Mass that goes from a row to a column.
struct Arc {
  int row, column;
  std::int64_t mass;
};

/// A basis of a transport problem: a spanning tree of rows and columns with the mass on each of its arcs. Nodes are
/// the rows, then the columns: column j is node rows + j. Its root is a column.
///
/// The tree is strongly feasible: from every node some mass could be sent on to the root. All arcs lead from a row to
/// a column, so this says that an arc up from a row may be empty, and an arc down to a column may not. Among the arcs
/// that block an exchange the last one on the cycle leaves, seen from its top and in the direction of the arc that
/// enters: this keeps the tree strongly feasible, and the method cannot cycle (W. H. Cunningham, Math. Programming 11
/// (1976) 105).
class SpanningTree {
 public:
  bool empty() const noexcept { return nodes_.empty(); }
  void clear() noexcept { nodes_.clear(); }
  int root() const noexcept { return root_; }
  int parent(int node) const noexcept { return nodes_[static_cast<std::size_t>(node)].parent; }
  std::int64_t mass_to_parent(int node) const noexcept { return nodes_[static_cast<std::size_t>(node)].mass; }
  /// The node after this one where parents come before their children; after the last one the root.
  int next(int node) const noexcept { return next_[static_cast<std::size_t>(node)]; }

  /// The arcs have to span the nodes that they touch, and to be strongly feasible from `root`.
  void build(int rows, int columns, int root, const std::vector<Arc>& arcs);

  /// One of the two parts that the leaving arc had held together, the smaller one: `count` nodes from `first` by
  /// `next`.
  struct Part {
    int first, count;
    bool has_entering_row;  ///< the row of the arc that entered is in it, and its column in the other
  };
  /// The arc enters, and the one that blocks leaves.
  Part exchange(int row, int column);

  /// Other masses on the same tree. False, and the tree is as before, where it would not be strongly feasible.
  bool carry(const std::vector<std::int64_t>& supply, const std::vector<std::int64_t>& demand);

  /// Arcs with more mass than that, by node.
  std::vector<Arc> arcs(std::int64_t more_than) const;

  std::size_t memory_bytes() const noexcept {
    return nodes_.capacity() * sizeof(Node) +
           (next_.capacity() + previous_.capacity() + last_.capacity()) * sizeof(int);
  }

 private:
  struct Node {
    std::int64_t mass;  ///< on the arc between the node and its parent
    int parent;
    int size;  ///< nodes of its subtree
  };
  struct Blocking {
    int node, join;
    std::int64_t mass;
    bool on_row_side;
  };

  Node& at(int node) noexcept { return nodes_[static_cast<std::size_t>(node)]; }
  const Node& at(int node) const noexcept { return nodes_[static_cast<std::size_t>(node)]; }
  int& next_of(int node) noexcept { return next_[static_cast<std::size_t>(node)]; }
  int& previous_of(int node) noexcept { return previous_[static_cast<std::size_t>(node)]; }
  int& last_of(int node) noexcept { return last_[static_cast<std::size_t>(node)]; }
  Blocking find_blocking(int row, int column) const noexcept;
  void push_mass(int from, int join, std::int64_t mass) noexcept;
  void add_size(int from, int join, int change) noexcept;
  void link(int node, int after) noexcept;
  void cut(int top) noexcept;
  int reroot(int top, int node, std::int64_t entering_mass) noexcept;
  void hang(int node, int tail, int parent) noexcept;

  int rows_ = 0, root_ = 0;
  int size_ = 0;  // nodes that have an arc
  std::vector<Node> nodes_;
  std::vector<int> next_, previous_, last_;  // a circular list, parents first; the last node of each subtree
};

}  // namespace bowstring::simplex
