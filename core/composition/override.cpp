#include "core/composition/override.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/vocabulary.hpp"

namespace bowstring {
namespace {

/// The steps of a path. A step may be written in quotes, as TOML writes keys.
std::vector<std::string> split_at_dots(const std::string& path) {
  std::vector<std::string> steps(1);
  char quote = '\0';
  for (const char letter : path) {
    if (letter == quote) {
      quote = '\0';
    } else if (quote == '\0' && (letter == '"' || letter == '\'')) {
      quote = letter;
    } else if (quote == '\0' && letter == '.') {
      steps.emplace_back();
    } else {
      steps.back() += letter;
    }
  }
  return steps;
}

/// Follows one path through the tree.
class Walk {
 public:
  Walk(Node& root, const std::string& path, const Position& position, Report& report)
      : here_(&root), path_(path), steps_(split_at_dots(path)), position_(position), report_(report) {}

  void put(Node value) {
    if (!check_steps()) return;
    while (next_ + 1 < steps_.size()) {
      if (!advance()) return;
    }
    if (here_->is_list()) {
      replace_item(std::move(value));
    } else if (enter_as_table()) {
      here_->set({steps_[next_], position_, std::move(value)});
    }
  }

 private:
  void fail(const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(position_, "path '" + path_ + "': " + found, expected, mend);
  }

  bool check_steps() {
    if (contains_name(steps_, "")) {
      fail("a step without a name", "names with one dot between two of them",
           "write it as in 'wire.lunderquist.radius'");
      return false;
    }
    const std::string& first = steps_.front();
    if (contains_name(overridable_names(), first)) return true;
    const std::string expected = "one of: " + comma_separated(overridable_names());
    if (contains_name(later_table_names(), first)) {
      fail("'" + first + "' is not available in this version", expected, "leave this override out");
    } else if (contains_name(top_level_names(), first)) {
      fail("'" + first + "' is read before any override", expected, "write it in the file itself");
    } else {
      const std::vector<std::string> near = nearest_names(first, overridable_names());
      fail("no table '" + first + "'", expected, near.empty() ? "start the path with one of them" : did_you_mean(near));
    }
    return false;
  }

  /// "wire.lunderquist", the part that has been followed.
  std::string so_far() const {
    std::string text;
    for (std::size_t i = 0; i < next_; ++i) text += (i > 0 ? "." : "") + steps_[i];
    return text;
  }

  bool advance() {
    if (here_->is_list()) {
      Node* item = find_item();
      if (item == nullptr) return false;
      here_ = item;
    } else {
      if (!enter_as_table()) return false;
      here_ = &entry_of(steps_[next_])->value;
    }
    ++next_;
    return true;
  }

  /// A name alone stands for { type = name } where a plugin or an end is chosen.
  bool enter_as_table() {
    if (here_->is_text() && names_a_type()) {
      Node table;
      table.position = here_->position;
      table.inline_table = true;
      table.set({"type", here_->position, *here_});
      *here_ = table;
    }
    if (here_->is_table()) return true;
    fail("'" + so_far() + "' is " + description(*here_) + ", not a table", "a path that ends there",
         "write '" + so_far() + "'");
    return false;
  }

  bool names_a_type() const {
    const std::string& key = steps_[next_ - 1];
    if (steps_.front() == "loss") return key == "transport" || key == "ground-cost";
    return key == "kinematics" || (next_ >= 2 && steps_[next_ - 2] == "ends");
  }

  bool among_ends() const { return next_ > 0 && steps_[next_ - 1] == "ends"; }

  Entry* entry_of(const std::string& key) {
    if (here_->find(key) == nullptr) {
      here_->set({key, position_, made_for(key)});
    }
    return here_->find(key);
  }

  Node made_for(const std::string& key) const {
    Node made;
    made.position = position_;
    made.inline_table = true;
    if (next_ == 0 && contains_name(list_table_names(), key)) made.type = Node::Type::list;
    if (key == "ends") {
      made.type = Node::Type::list;
      made.items.assign(2, text_node("pinned", position_));
    }
    return made;
  }

  void replace_item(Node value) {
    Node* item = find_item();
    if (item == nullptr) return;
    const Entry* name = item->find("name");
    if (name != nullptr && value.is_table() && value.find("name") == nullptr) value.set(*name);
    *item = std::move(value);
  }

  std::vector<Node*> items_called(const std::string& name, bool by_name) {
    std::vector<Node*> found;
    for (Node& item : here_->items) {
      const std::string type = item.is_text() ? item.text : item.text_at("type");
      if ((by_name ? label_of(item, steps_[0]) : type) == name) found.push_back(&item);
    }
    return found;
  }

  Node* find_item() {
    const std::string& name = steps_[next_];
    std::vector<Node*> found = items_called(name, true);
    if (among_ends() && !here_->items.empty()) {
      if (name == "first") return &here_->items.front();
      if (name == "last") return &here_->items.back();
    }
    if (found.empty()) found = items_called(name, false);
    if (found.size() == 1) return found.front();
    if (found.empty()) {
      fail_unknown_item(name);
    } else {
      fail_ambiguous_item(name, found);
    }
    return nullptr;
  }

  void fail_unknown_item(const std::string& name) {
    std::vector<std::string> labels;
    for (const Node& item : here_->items) labels.push_back(label_of(item, steps_[0]));
    const std::vector<std::string> near = nearest_names(name, labels);
    fail("no entry '" + name + "' in '" + so_far() + "'",
         labels.empty() ? "an entry, but there is none" : "one of: " + comma_separated(labels),
         near.empty() ? "name an entry that the file has" : did_you_mean(near));
  }

  void fail_ambiguous_item(const std::string& name, const std::vector<Node*>& found) {
    std::string places;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (i > 0) places += i + 1 == found.size() ? " and " : ", ";
      places += "'" + label_of(*found[i], steps_[0]) + "' at " + found[i]->position.text();
    }
    fail("'" + name + "' fits " + std::to_string(found.size()) + " entries of '" + so_far() + "': " + places,
         "a path that fits one",
         among_ends() ? "write 'first' or 'last'" : "use their names, and give each its own `name`");
  }

  Node* here_;
  const std::string& path_;
  const std::vector<std::string> steps_;
  const Position& position_;
  Report& report_;
  std::size_t next_ = 0;
};

}  // namespace

void apply_override(Node& root, const std::string& path, const Position& path_position, Node value, Report& report) {
  Walk(root, path, path_position, report).put(std::move(value));
}

}  // namespace bowstring
