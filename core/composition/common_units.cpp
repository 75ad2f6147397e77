#include "core/composition/common_units.hpp"

#include <cctype>
#include <cstddef>

namespace bowstring {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr int largest_power = 9;

struct Symbol {
  std::string_view name;
  CommonUnit unit;
};

constexpr Symbol symbols[] = {
    {"mm", {1.0, 1.0, 1, 0, 0}},   {"cm", {10.0, 1.0, 1, 0, 0}},  {"m", {1e3, 1.0, 1, 0, 0}},
    {"um", {1.0, 1e3, 1, 0, 0}},   {"in", {25.4, 1.0, 1, 0, 0}},  {"Fr", {1.0, 3.0, 1, 0, 0}},
    {"N", {1.0, 1.0, 0, 1, 0}},    {"mN", {1.0, 1e3, 0, 1, 0}},   {"kN", {1e3, 1.0, 0, 1, 0}},
    {"Pa", {1.0, 1e6, -2, 1, 0}},  {"kPa", {1.0, 1e3, -2, 1, 0}}, {"MPa", {1.0, 1.0, -2, 1, 0}},
    {"GPa", {1e3, 1.0, -2, 1, 0}}, {"rad", {1.0, 1.0, 0, 0, 1}},  {"deg", {pi, 180.0, 0, 0, 1}},
};

const CommonUnit* find_symbol(std::string_view name) {
  for (const Symbol& symbol : symbols) {
    if (symbol.name == name) return &symbol.unit;
  }
  return nullptr;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Reads what is left of a unit from the left.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  std::optional<CommonUnit> read() {
    CommonUnit product;
    bool divide = skip_one_over();
    do {
      if (!read_factor(product, divide)) return std::nullopt;
    } while (read_operator(divide));
    if (place_ != text_.size()) return std::nullopt;
    return product;
  }

 private:
  char peek() const { return place_ < text_.size() ? text_[place_] : '\0'; }

  bool skip(char c) {
    if (peek() != c) return false;
    ++place_;
    return true;
  }

  void skip_spaces() {
    while (skip(' ')) {
    }
  }

  bool skip_one_over() {
    const std::size_t start = place_;
    if (skip('1')) {
      skip_spaces();
      if (skip('/')) {
        skip_spaces();
        return true;
      }
    }
    place_ = start;
    return false;
  }

  /// False at the end of the unit.
  bool read_operator(bool& divide) {
    skip_spaces();
    divide = skip('/');
    if (!divide && peek() != '\0' && !skip('*')) skip('.');
    skip_spaces();
    return peek() != '\0';
  }

  /// "^2", "**2", "2", "^-1", or nothing: 1; 0 where it is none of them.
  int read_power() {
    const std::size_t start = place_;
    if (!skip('^') && skip('*') && !skip('*')) place_ = start;  // a single '*' is the next operator
    const bool marked = place_ > start;
    const bool negative = skip('-');
    if (!is_digit(peek())) return marked || negative ? 0 : 1;
    int power = 0;
    while (is_digit(peek()) && power <= largest_power) power = 10 * power + (text_[place_++] - '0');
    return power > largest_power ? 0 : (negative ? -power : power);
  }

  bool read_factor(CommonUnit& product, bool divide) {
    const std::size_t start = place_;
    while (is_letter(peek())) ++place_;
    const CommonUnit* symbol = find_symbol(text_.substr(start, place_ - start));
    if (symbol == nullptr) return false;
    const int power = read_power();
    if (power == 0) return false;
    multiply(product, *symbol, divide ? -power : power);
    return true;
  }

  static void multiply(CommonUnit& product, const CommonUnit& factor, int power) {
    product.length += power * factor.length;
    product.force += power * factor.force;
    product.angle += power * factor.angle;
    for (int i = 0; i < (power > 0 ? power : -power); ++i) {
      product.multiplier *= power > 0 ? factor.multiplier : factor.divisor;
      product.divisor *= power > 0 ? factor.divisor : factor.multiplier;
    }
  }

  std::string_view text_;
  std::size_t place_ = 0;
};

}  // namespace

std::optional<CommonUnit> read_common_unit(std::string_view unit) { return Reader(unit).read(); }

}  // namespace bowstring
