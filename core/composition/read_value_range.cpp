#include "core/composition/read_value_range.hpp"

#include <cmath>
#include <cstddef>

#include "core/composition/units.hpp"

namespace bowstring {
namespace {

/// One end as it is written.
struct End {
  std::vector<double> numbers;
  std::string unit;
  bool list = false, whole = true;
};

class Reader {
 public:
  Reader(const std::string& owner, Report& report) : owner_(owner), report_(report) {}

  std::optional<End> read(const Entry& entry) {
    End end;
    end.list = entry.value.is_list();
    const std::vector<Node> single{entry.value};
    for (const Node& item : end.list ? entry.value.items : single) {
      if (!add(item, entry.key, end)) return std::nullopt;
    }
    if (!end.numbers.empty()) return end;
    fail(entry.value, "'" + entry.key + "' of " + owner_ + " is an empty list", "numbers",
         "write the value of the path at that end");
    return std::nullopt;
  }

  void fail(const Node& node, const std::string& found, const std::string& expected, const std::string& mend) {
    report_.error(node.position, found, expected, mend);
  }

 private:
  bool add(const Node& item, const std::string& key, End& end) {
    Quantity quantity;
    if (item.type == Node::Type::integer) {
      quantity.number = static_cast<double>(item.integer);
    } else if (item.type == Node::Type::number) {
      quantity.number = item.number;
      end.whole = false;
    } else {
      const std::optional<Quantity> split = item.is_text() ? split_quantity(item.text) : std::nullopt;
      if (!split) {
        fail(item, "'" + key + "' of " + owner_ + " is " + description(item), "a number, a quantity, or a list of them",
             "write the value of the path at that end");
        return false;
      }
      quantity = *split;
      end.whole = false;
    }
    if (end.numbers.empty()) end.unit = quantity.unit;
    if (quantity.unit != end.unit) {
      fail(item, "'" + key + "' of " + owner_ + " mixes '" + end.unit + "' and '" + quantity.unit + "'",
           "one unit for all its entries", "write them all in one");
      return false;
    }
    end.numbers.push_back(quantity.number);
    return true;
  }

  const std::string& owner_;
  Report& report_;
};

}  // namespace

std::vector<double> ValueRange::at(double t) const {
  std::vector<double> out;
  for (std::size_t i = 0; i < from.size(); ++i) {
    double value = logarithmic ? from[i] * std::pow(to[i] / from[i], t) : from[i] + t * (to[i] - from[i]);
    if (t == 0.0) value = from[i];
    if (t == 1.0) value = to[i];
    out.push_back(whole ? std::round(value) : value);
  }
  return out;
}

std::string ValueRange::text(double t) const {
  std::string out;
  for (const double value : at(t)) {
    const std::string number = whole ? std::to_string(static_cast<long>(value)) : decimal(value);
    out += (out.empty() ? "" : ", ") + (unit.empty() ? number : "\"" + number + " " + unit + "\"");
  }
  return list ? "[" + out + "]" : out;
}

std::optional<ValueRange> read_value_range(const Entry& from, const Entry& to, bool logarithmic,
                                           const std::string& owner, Report& report) {
  Reader reader(owner, report);
  const std::optional<End> first = reader.read(from), last = reader.read(to);
  if (!first || !last) return std::nullopt;
  if (first->list != last->list || first->numbers.size() != last->numbers.size()) {
    reader.fail(to.value,
                "'" + to.key + "' of " + owner + " is " + description(to.value) + ", '" + from.key + "' is " +
                    description(from.value),
                "two values of one kind", "write both as the path's value is written");
    return std::nullopt;
  }
  ValueRange out{first->numbers, last->numbers, last->unit, last->list, first->whole && last->whole, logarithmic};
  if (first->unit != last->unit) {
    const UnitConversion conversion = convert_unit(first->unit, last->unit);
    if (first->unit.empty() || last->unit.empty() || conversion.outcome != UnitOutcome::converted) {
      reader.fail(
          to.value,
          "'" + to.key + "' of " + owner + " is in '" + last->unit + "', '" + from.key + "' in '" + first->unit + "'",
          "two units of one dimension", "write both in one unit");
      return std::nullopt;
    }
    for (double& number : out.from) number = conversion(number);
  }
  if (out.from == out.to) {
    reader.fail(to.value, "'" + from.key + "' and '" + to.key + "' of " + owner + " are equal",
                "two values that differ", "walk from another value, or remove the table");
    return std::nullopt;
  }
  for (std::size_t i = 0; logarithmic && i < out.from.size(); ++i) {
    if (out.from[i] * out.to[i] > 0.0) continue;
    reader.fail(to.value, "a logarithmic scale of " + owner + " from " + out.text(0.0) + " to " + out.text(1.0),
                "two values of one sign, neither of them 0", "leave out scale = \"log\"");
    return std::nullopt;
  }
  return out;
}

}  // namespace bowstring
