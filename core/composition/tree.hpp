#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/composition/position.hpp"

namespace bowstring {

struct Entry;

/// One value of a composition with the place that it came from. Copies keep their places, so that a tree put
/// together from several files still says where each value stands.
struct Node {
  enum class Type : int { table, list, text, integer, number, flag, date };

  Type type = Type::table;
  Position position;
  std::string text;
  long integer = 0;
  double number = 0.0;
  bool flag = false;
  std::vector<Entry> entries;  ///< of a table, in the order of the text
  std::vector<Node> items;     ///< of a list
  bool inline_table = false;   ///< written as { … }, not under a header or by dotted keys

  bool is_table() const noexcept { return type == Type::table; }
  bool is_list() const noexcept { return type == Type::list; }
  bool is_text() const noexcept { return type == Type::text; }

  /// Null where this is no table or has no such key.
  const Entry* find(std::string_view key) const noexcept;
  Entry* find(std::string_view key) noexcept;
  /// The text under a key; "" where there is none.
  std::string text_at(std::string_view key) const;
  /// Adds the entry or replaces the one of its key.
  void set(Entry entry);
  void erase(std::string_view key);
};

struct Entry {
  std::string key;
  Position position;  ///< of the key
  Node value;
};

Node text_node(std::string text, const Position& position);

/// What stands there, for messages: `text "abc"`, `whole number 3`, `number 0.5`, `true`, `a list`, `a table`.
std::string description(const Node& node);

/// A number in the shortest decimal form that gives it back.
std::string decimal(double number);

}  // namespace bowstring
