#include "core/composition/nearest.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace bowstring {
namespace {

constexpr std::size_t largest_answer = 3;
constexpr std::size_t shortest_part = 3;

std::string folded(std::string_view name) {
  std::string result(name);
  for (char& letter : result) {
    letter = letter == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return result;
}

/// Optimal string alignment distance (Damerau 1964, restricted: no substring is edited twice).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({previous[j] + 1, current[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], before[j - 2] + 1);
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

std::size_t largest_distance(std::size_t length) {
  if (length <= 1) return 0;
  if (length <= 3) return 1;
  return length <= 5 ? 2 : 3;
}

/// Whether `part` stands in `whole` at the begin of a hyphenated word: "strain" in "vessel-strain".
bool is_part(const std::string& part, const std::string& whole) {
  if (part.size() < shortest_part) return false;
  const std::size_t place = whole.find(part);
  return place != std::string::npos && (place == 0 || whole[place - 1] == '-');
}

}  // namespace

std::vector<std::string> nearest_names(std::string_view word, const std::vector<std::string>& candidates) {
  struct Ranked {
    std::size_t rank;
    const std::string* name;
  };
  constexpr std::size_t part_rank = 100;
  const std::string wanted = folded(word);
  std::vector<Ranked> near;
  for (const std::string& candidate : candidates) {
    const std::string name = folded(candidate);
    const std::size_t shorter = std::min(wanted.size(), name.size());
    const std::size_t distance = edit_distance(wanted, name);
    if (distance <= largest_distance(shorter)) {
      near.push_back({distance, &candidate});
    } else if (is_part(wanted, name) || is_part(name, wanted)) {
      near.push_back({part_rank, &candidate});
    }
  }
  std::stable_sort(near.begin(), near.end(), [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });

  std::vector<std::string> names;
  for (const Ranked& one : near) {
    const bool as_near = one.rank <= near.front().rank + 1;
    const bool repeated = std::find(names.begin(), names.end(), *one.name) != names.end();
    if (as_near && !repeated && names.size() < largest_answer) names.push_back(*one.name);
  }
  return names;
}

std::string quoted_alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += "'" + names[i] + "'";
  }
  return text;
}

std::string did_you_mean(const std::vector<std::string>& names) {
  return names.empty() ? "" : "did you mean " + quoted_alternatives(names) + "?";
}

std::string joined(const std::vector<std::string>& texts, const char* between) {
  std::string text;
  for (std::size_t i = 0; i < texts.size(); ++i) text += (i > 0 ? between : "") + texts[i];
  return text;
}

std::string counted(int count, const std::string& singular) {
  return std::to_string(count) + " " + singular + (count == 1 ? "" : "s");
}

std::string comma_separated(const std::vector<std::string>& names) { return joined(names, ", "); }

}  // namespace bowstring
