// Unit conversion by the UDUNITS-2 library (Unidata).
#include <udunits2.h>

#include <cmath>
#include <memory>
#include <mutex>
#include <string>

#include "core/composition/units.hpp"

namespace bowstring {
namespace {

struct Release {
  void operator()(ut_system* system) const noexcept { ut_free_system(system); }
  void operator()(ut_unit* unit) const noexcept { ut_free(unit); }
  void operator()(cv_converter* converter) const noexcept { cv_free(converter); }
};

using System = std::unique_ptr<ut_system, Release>;
using Unit = std::unique_ptr<ut_unit, Release>;
using Converter = std::unique_ptr<cv_converter, Release>;

/// In the database `Fr` is the franklin, a unit of charge, and `deg` is not there.
System load_database() {
  ut_set_error_message_handler(ut_ignore);
  System system(ut_read_xml(nullptr));
  if (system == nullptr) return system;
  const Unit degree(ut_parse(system.get(), "degree", UT_ASCII));
  const Unit french(ut_parse(system.get(), "(1/3) mm", UT_ASCII));
  ut_unmap_symbol_to_unit(system.get(), "Fr", UT_ASCII);
  if (degree != nullptr) ut_map_symbol_to_unit("deg", UT_ASCII, degree.get());
  if (french != nullptr) ut_map_symbol_to_unit("Fr", UT_ASCII, french.get());
  return system;
}

Unit parse(ut_system* system, const std::string& text) { return Unit(ut_parse(system, text.c_str(), UT_UTF8)); }

}  // namespace

UnitConversion convert_unit_by_udunits(std::string_view from, std::string_view to) {
  // The library's parser keeps its state in globals.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  static const System system = load_database();
  if (system == nullptr) return {UnitOutcome::no_database, 1.0, 1.0};

  const Unit source = parse(system.get(), ascii_unit(from));
  const Unit target = parse(system.get(), ascii_unit(to));
  if (source == nullptr || target == nullptr) return {UnitOutcome::unknown_unit, 1.0, 1.0};
  const Converter converter(ut_get_converter(source.get(), target.get()));
  if (converter == nullptr) return {UnitOutcome::other_dimension, 1.0, 1.0};
  const double factor = cv_convert_double(converter.get(), 1.0);
  const double at_zero = cv_convert_double(converter.get(), 0.0);
  // The library also converts between a unit and its reciprocal.
  if (!std::isfinite(at_zero)) return {UnitOutcome::other_dimension, 1.0, 1.0};
  if (at_zero != 0.0 || !std::isfinite(factor) || factor <= 0.0) return {UnitOutcome::unknown_unit, 1.0, 1.0};
  return {UnitOutcome::converted, factor, 1.0};
}

}  // namespace bowstring
