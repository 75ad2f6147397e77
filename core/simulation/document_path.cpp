#include "core/simulation/document_path.hpp"

#include <algorithm>
#include <charconv>

#include "core/composition/nearest.hpp"

namespace bowstring {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> split_at_dots(const std::string& path) {
  std::vector<std::string> steps;
  for (std::size_t begin = 0; begin <= path.size() && !path.empty();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    steps.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return steps;
}

class Walk {
 public:
  Walk(const Json& root, const std::string& path) : path_(path), steps_(split_at_dots(path)) { here_.values = {&root}; }

  std::string follow(Selection& out) {
    while (next_ < steps_.size()) {
      if (!advance()) return error_;
    }
    out = std::move(here_);
    return "";
  }

 private:
  bool advance() {
    if (!here_.of_every_entry && here_.values.front()->is_array()) return enter_list(*here_.values.front());
    std::size_t used = 0;
    for (const Json*& value : here_.values) {
      const Json* inside = value->is_object() ? find_key(*value, used) : nullptr;
      if (inside == nullptr) return fail(*value);
      value = inside;
    }
    next_ += used;
    return true;
  }

  /// Keys may have dots themselves ("iliac.positions"): the shortest run of steps that is a key.
  const Json* find_key(const Json& table, std::size_t& used) const {
    std::string key;
    for (std::size_t last = next_; last < steps_.size(); ++last) {
      key += (last > next_ ? "." : "") + steps_[last];
      const auto found = table.find(key);
      if (found == table.end()) continue;
      used = last + 1 - next_;
      return &*found;
    }
    return nullptr;
  }

  bool enter_list(const Json& list) {
    const std::string& step = steps_[next_];
    const Json* entry = nullptr;
    for (const Json& item : list) {
      if (entry == nullptr && entry_label(item) == step && !step.empty()) entry = &item;
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
    const bool is_index = error == std::errc() && end == step.data() + step.size();
    if (entry == nullptr && is_index && index < list.size()) entry = &list[index];
    if (entry != nullptr) {
      here_.values = {entry};
      ++next_;
      return true;
    }
    std::size_t used = 0;
    const auto has_key = [&](const Json& item) { return item.is_object() && find_key(item, used) != nullptr; };
    if (is_index || !std::all_of(list.begin(), list.end(), has_key)) return fail(list);
    here_ = {{}, true};
    for (const Json& item : list) here_.values.push_back(&item);
    if (list.empty()) next_ = steps_.size();  // of no entry every key is nothing
    return true;
  }

  std::string so_far() const {
    std::string text;
    for (std::size_t i = 0; i < next_; ++i) text += (i > 0 ? "." : "") + steps_[i];
    return text.empty() ? "the document" : "'" + text + "'";
  }

  bool fail(const Json& here) {
    std::vector<std::string> known;
    if (here.is_object()) {
      for (const auto& entry : here.items()) known.push_back(entry.key());
    } else if (here.is_array()) {
      for (const Json& item : here) {
        if (const std::string label = entry_label(item); !label.empty()) known.push_back(label);
      }
      if (known.empty() && !here.empty() && here.front().is_object()) {
        for (const auto& entry : here.front().items()) known.push_back(entry.key());
      }
    }
    error_ = "path '" + path_ + "': no '" + steps_[next_] + "' in " + so_far() + ", which is " + json_description(here);
    if (!known.empty()) error_ += "; expected one of: " + comma_separated(known);
    if (here.is_array() && !here.empty()) {
      error_ += (known.empty() ? "; expected" : ", or") + std::string(" a number from 0 to ") +
                std::to_string(here.size() - 1);
    }
    if (const std::string hint = did_you_mean(nearest_names(steps_[next_], known)); !hint.empty())
      error_ += "; " + hint;
    return false;
  }

  const std::string& path_;
  const std::vector<std::string> steps_;
  std::size_t next_ = 0;
  Selection here_;
  std::string error_;
};

}  // namespace

std::string follow_path(const Json& root, const std::string& path, Selection& out) {
  return Walk(root, path).follow(out);
}

std::string entry_label(const Json& entry) {
  if (!entry.is_object()) return "";
  for (const char* key : {"name", "type"}) {
    if (const auto found = entry.find(key); found != entry.end() && found->is_string()) {
      return found->get<std::string>();
    }
  }
  return "";
}

std::string json_description(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::object:
      return "a table";
    case Json::value_t::array:
      return "a list of " + std::to_string(value.size());
    case Json::value_t::string:
      return "text";
    case Json::value_t::boolean:
      return "a flag";
    default:
      return "a number";
  }
}

}  // namespace bowstring
