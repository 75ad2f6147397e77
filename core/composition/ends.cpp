#include "core/composition/ends.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/composition/keys.hpp"
#include "core/composition/nearest.hpp"
#include "core/composition/numbers.hpp"

namespace bowstring {
namespace {

const std::vector<std::string>& end_type_names() {
  static const std::vector<std::string> names{"free", "pinned", "clamped", "held-edge"};
  return names;
}

/// Reads one end; `subject` is "the first end of wire 'lunderquist'".
class EndReader {
 public:
  EndReader(std::string subject, EndTable& out, Reading& reading)
      : subject_(std::move(subject)), out_(out), reading_(reading) {}

  void read(const Node& node) {
    out_.position = node.position.text();
    if (!node.is_table()) return read_type(node);
    check_keys(node, subject_, {"type", "tangent", "move"}, {"position", "rotation", "axes", "turn"}, "remove it",
               reading_.report);
    if (const Entry* type = node.find("type")) {
      read_type(type->value);
    } else {
      fail(node, subject_ + " has no 'type'", quoted_alternatives(end_type_names()), "add type = \"<end>\"");
    }
    if (const Entry* tangent = node.find("tangent")) read_tangent(tangent->value);
    if (const Entry* move = node.find("move")) read_move(move->value);
  }

 private:
  void fail(const Node& node, const std::string& found, const std::string& expected, const std::string& mend) {
    reading_.report.error(node.position, found, expected, mend);
  }

  void read_type(const Node& node) {
    for (const EndType type : {EndType::free, EndType::pinned, EndType::clamped, EndType::held_edge}) {
      if (node.is_text() && node.text == end_type_name(type)) {
        out_.type = type;
        return;
      }
    }
    const std::vector<std::string> near = nearest_names(node.text, end_type_names());
    fail(node, subject_ + " is " + description(node), quoted_alternatives(end_type_names()),
         near.empty() ? "write one of them in quotes" : did_you_mean(near));
  }

  /// As many numbers as the scene has dimensions; false where something has been reported.
  bool read_numbers(const Node& node, const std::string& subject, const NumberRules& rules, const std::string& mend,
                    std::vector<double>& out) {
    const int dimension = reading_.dimension;
    const bool right_size = node.is_list() && (dimension == 0 || static_cast<int>(node.items.size()) == dimension);
    if (!right_size) {
      const std::string found =
          node.is_list() ? "has " + std::to_string(node.items.size()) + " entries" : "is " + description(node);
      fail(node, subject + " " + found, "a list of as many numbers as the scene has dimensions", mend);
      return false;
    }
    for (const Node& item : node.items) {
      const std::optional<Number> number = read_number(item, "an entry of " + subject, rules, reading_.report);
      if (!number) return false;
      out.push_back(number->value);
    }
    return true;
  }

  void read_move(const Node& node) {
    NumberRules millimetres;
    millimetres.units = {"mm"};
    const std::string subject = "'move' of " + subject_;
    if (!read_numbers(node, subject, millimetres, "write the displacement from State 1 in global axes", out_.move))
      return;
    if (out_.type != EndType::free) return;
    fail(node, subject + ", which is free", "an end whose position is held", "hold it, as in type = \"pinned\"");
  }

  void read_tangent(const Node& node) {
    const std::string subject = "'tangent' of " + subject_;
    if (!read_numbers(node, subject, {}, "write the direction that is held, along the curve", out_.tangent)) return;
    double square = 0.0;
    for (const double number : out_.tangent) square += number * number;
    if (square > 0.0 && std::isfinite(square)) return;
    fail(node, subject + (square > 0.0 ? " is too long" : " has no length"), "a direction",
         "write the direction that is held, along the curve");
  }

  std::string subject_;
  EndTable& out_;
  Reading& reading_;
};

}  // namespace

const char* end_type_name(EndType type) noexcept {
  switch (type) {
    case EndType::free:
      return "free";
    case EndType::pinned:
      return "pinned";
    case EndType::clamped:
      return "clamped";
    case EndType::held_edge:
      return "held-edge";
  }
  return "";
}

void read_ends(const Node& table, const std::string& owner, EndTable (&out)[2], Reading& reading) {
  const Entry* entry = table.find("ends");
  if (entry == nullptr) return;
  const Node& ends = entry->value;
  if (!ends.is_list() || ends.items.size() != 2) {
    const std::string found =
        ends.is_list() ? "has " + std::to_string(ends.items.size()) + " entries" : "is " + description(ends);
    reading.report.error(ends.position, "'ends' of " + owner + " " + found, "two: the first end and the last end",
                         "write ends = [\"pinned\", \"pinned\"]");
    return;
  }
  EndReader("the first end of " + owner, out[0], reading).read(ends.items[0]);
  EndReader("the last end of " + owner, out[1], reading).read(ends.items[1]);
}

}  // namespace bowstring
