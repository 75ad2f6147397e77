#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/transport/repeat.hpp"
#include "core/transport/transport_comparison.hpp"

namespace bowstring {

inline constexpr const char* transport_format = "bowstring.transport/1";

/// One of two measures that were compared.
struct TransportSide {
  std::string name;          ///< as the user calls it: "observed.csv", "result.json#iliac"; "" of one in memory
  std::string file, sha256;  ///< absolute; "" of one in memory
  bool is_curve = false;
  std::vector<double> arc;  ///< of a curve's places, mm
  Measure measure;
};

/// All that a document says of one comparison.
struct TransportReport {
  TransportSide a, b;
  TransportChoice choice;
  TransportResult result;
  double read_seconds = 0.0;
  std::optional<RepeatRecord> repeat;
  std::string provenance;  ///< JSON text (core/result/provenance.hpp)
};

/// The `bowstring.transport/1` document as JSON text, numbers with 17 significant digits. docs/transport.md describes
/// every key. The order of places, and with it the rows and columns of the plan, is that of the measures.
std::string transport_document(const TransportReport& report);

}  // namespace bowstring
