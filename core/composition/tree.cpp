#include "core/composition/tree.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

namespace bowstring {

const Entry* Node::find(std::string_view key) const noexcept {
  if (!is_table()) return nullptr;
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry;
  }
  return nullptr;
}

Entry* Node::find(std::string_view key) noexcept {
  return const_cast<Entry*>(static_cast<const Node*>(this)->find(key));
}

std::string Node::text_at(std::string_view key) const {
  const Entry* entry = find(key);
  return entry != nullptr && entry->value.is_text() ? entry->value.text : "";
}

void Node::set(Entry entry) {
  if (Entry* present = find(entry.key)) {
    *present = std::move(entry);
  } else {
    entries.push_back(std::move(entry));
  }
}

void Node::erase(std::string_view key) {
  const auto same = [key](const Entry& entry) { return entry.key == key; };
  entries.erase(std::remove_if(entries.begin(), entries.end(), same), entries.end());
}

Node text_node(std::string text, const Position& position) {
  Node node;
  node.type = Node::Type::text;
  node.position = position;
  node.text = std::move(text);
  return node;
}

std::string decimal(double number) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, number);
  return error == std::errc() ? std::string(digits, end) : std::to_string(number);
}

namespace {

/// A text as a message can show it: on one line and not too long.
std::string shown(const std::string& text) {
  std::size_t longest = 80;
  while (longest < text.size() && longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0U) == 0x80U) {
    --longest;  // no letter of UTF-8 is cut
  }
  std::string result;
  for (const char letter : text.substr(0, longest)) {
    result += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
  }
  return "\"" + result + (text.size() > longest ? "…\"" : "\"");
}

}  // namespace

std::string description(const Node& node) {
  switch (node.type) {
    case Node::Type::table:
      return "a table";
    case Node::Type::list:
      return "a list";
    case Node::Type::text:
      return "text " + shown(node.text);
    case Node::Type::integer:
      return "whole number " + std::to_string(node.integer);
    case Node::Type::number:
      return "number " + decimal(node.number);
    case Node::Type::flag:
      return node.flag ? "true" : "false";
    case Node::Type::date:
      return "a date or time";
  }
  return "nothing";
}

}  // namespace bowstring
