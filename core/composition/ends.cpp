#include "core/composition/ends.hpp"

#include <algorithm>
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
    check_keys(node, subject_, {"type", "position", "rotation", "axes", "tangent", "move", "turn"}, "remove it",
               reading_.report);
    read_what_is_held(node);
    if (const Entry* axes = node.find("axes")) read_axes(axes->value);
    if (const Entry* tangent = node.find("tangent")) read_tangent(tangent->value);
    if (const Entry* move = node.find("move")) read_move(move->value);
    if (const Entry* turn = node.find("turn")) read_turn(turn->value);
  }

 private:
  void fail(const Node& node, const std::string& found, const std::string& expected, const std::string& mend) {
    reading_.report.error(node.position, found, expected, mend);
  }

  void read_what_is_held(const Node& node) {
    const Entry* type = node.find("type");
    const Entry* position = node.find("position");
    const Entry* rotation = node.find("rotation");
    if (type != nullptr && (position != nullptr || rotation != nullptr)) {
      const Entry& other = position != nullptr ? *position : *rotation;
      fail(other.value, "'" + other.key + "' of " + subject_ + " beside its 'type'",
           "a type, or what is held axis by axis", "remove one of the two");
    } else if (type != nullptr) {
      read_type(type->value);
    } else if (position == nullptr && rotation == nullptr) {
      fail(node, subject_ + " has no 'type'", quoted_alternatives(end_type_names()),
           "add type = \"<end>\", or position and rotation, each \"held\" or \"free\"");
    } else {
      out_.type = "";
      std::fill(out_.position_held, out_.position_held + 3, false);
      if (position != nullptr) read_position(position->value);
      if (rotation != nullptr) read_rotation(rotation->value);
    }
  }

  void read_type(const Node& node) {
    if (!node.is_text() || !contains_name(end_type_names(), node.text)) {
      const std::vector<std::string> near = nearest_names(node.text, end_type_names());
      return fail(node, subject_ + " is " + description(node), quoted_alternatives(end_type_names()),
                  near.empty() ? "write one of them in quotes" : did_you_mean(near));
    }
    out_.type = node.text;
    std::fill(out_.position_held, out_.position_held + 3, node.text != "free");
    out_.rotation_held = node.text == "clamped";
    out_.edge_held = node.text == "held-edge";
  }

  /// "held" or "free"; empty where something has been reported.
  std::optional<bool> read_held(const Node& node, const std::string& subject) {
    if (node.is_text() && (node.text == "held" || node.text == "free")) return node.text == "held";
    fail(node, subject + " is " + description(node), "'held' or 'free'", "write one of them in quotes");
    return std::nullopt;
  }

  void read_position(const Node& node) {
    const std::string subject = "'position' of " + subject_;
    const int dimension = reading_.dimension;
    if (!node.is_list()) {
      const std::optional<bool> held = read_held(node, subject);
      if (held) std::fill(out_.position_held, out_.position_held + 3, *held);
      return;
    }
    if (dimension != 0 && static_cast<int>(node.items.size()) != dimension) {
      return fail(node, subject + " has " + std::to_string(node.items.size()) + " entries",
                  "as many as the scene has dimensions", "write \"held\" or \"free\" for each axis");
    }
    for (std::size_t k = 0; k < node.items.size() && k < 3; ++k) {
      if (const auto held = read_held(node.items[k], "an entry of " + subject)) out_.position_held[k] = *held;
    }
  }

  void read_rotation(const Node& node) {
    const std::string subject = "'rotation' of " + subject_;
    if (!node.is_list()) {
      if (const auto held = read_held(node, subject)) out_.rotation_held = *held;
      return;
    }
    const std::size_t axes = reading_.dimension == 2 ? 1 : 3;
    if (reading_.dimension != 0 && node.items.size() != axes) {
      return fail(node, subject + " has " + std::to_string(node.items.size()) + " entries",
                  axes == 1 ? "one: the plane has one axis of rotation" : "three: one per axis",
                  "write \"held\" or \"free\" for each axis");
    }
    std::size_t held_axes = 0;
    for (const Node& item : node.items) {
      const auto held = read_held(item, "an entry of " + subject);
      if (!held) return;
      held_axes += *held ? 1 : 0;
    }
    if (held_axes != 0 && held_axes != node.items.size()) {
      return fail(node, subject + " is held about some axes and free about others",
                  "a rotation that is held or free as a whole", "hold all of its axes, or none");
    }
    out_.rotation_held = held_axes != 0;
  }

  void read_axes(const Node& node) {
    if (node.is_text() && (node.text == "global" || node.text == "end")) {
      out_.in_end_axes = node.text == "end";
      return;
    }
    fail(node, "'axes' of " + subject_ + " is " + description(node), "'global' or 'end'",
         "write one of them in quotes");
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
    return read_entries(node, subject, rules, out);
  }

  bool read_entries(const Node& node, const std::string& subject, const NumberRules& rules, std::vector<double>& out) {
    std::vector<double> numbers;
    for (const Node& item : node.items) {
      const std::optional<Number> number = read_number(item, "an entry of " + subject, rules, reading_.report);
      if (!number) return false;
      numbers.push_back(number->value);
    }
    out = numbers;
    return true;
  }

  void read_move(const Node& node) {
    NumberRules millimetres;
    millimetres.units = {"mm"};
    const std::string subject = "'move' of " + subject_;
    if (!read_numbers(node, subject, millimetres, "write the displacement from State 1, one number per axis",
                      out_.move)) {
      return;
    }
    for (std::size_t k = 0; k < out_.move.size() && k < 3; ++k) {
      if (out_.move[k] == 0.0 || out_.position_held[k]) continue;
      fail(node, subject + (out_.position_free() ? ", which is free" : " moves an axis that is free"),
           "an end whose position is held", "hold it, as in type = \"pinned\"");
      return;
    }
  }

  void read_turn(const Node& node) {
    NumberRules radians;
    radians.units = {"rad"};
    const std::string subject = "'turn' of " + subject_;
    if (!node.is_list()) {
      const std::optional<Number> angle = read_number(node, subject, radians, reading_.report);
      if (!angle) return;
      out_.turn = {angle->value};
    } else if (reading_.dimension == 2 || (reading_.dimension == 3 && node.items.size() != 3)) {
      return fail(node, subject + " has " + std::to_string(node.items.size()) + " entries",
                  reading_.dimension == 2 ? "one angle, not in a list"
                                          : "an angle about the tangent, or three: a "
                                            "rotation vector",
                  "write turn = \"90 deg\"");
    } else if (!read_entries(node, subject, radians, out_.turn)) {
      return;
    }
    if (out_.rotation_held) return;
    fail(node, subject + ", whose rotation is free", "an end whose rotation is held",
         "hold it, as in type = \"clamped\"");
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

std::string EndTable::text(int dimension) const {
  if (!type.empty()) return type;
  std::string out = "(position";
  const bool all = std::equal(position_held + 1, position_held + dimension, position_held);
  for (int k = 0; k < (all ? 1 : dimension); ++k) out += position_held[k] ? " held" : " free";
  return out + ", rotation " + (rotation_held ? "held)" : "free)");
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
