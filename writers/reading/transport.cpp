#include "writers/reading/transport.hpp"

#include <cmath>

#include "writers/reading/fields.hpp"

namespace bowstring {

namespace {

using fields::Json;

ComparedMeasure read_measure(const Json& document, const char* key) {
  const Json& table = fields::member(document, key);
  ComparedMeasure out;
  out.name = fields::text(table, "name");
  out.curve = fields::text(table, "kind") == "curve";
  out.place = fields::points(table, "positions", 3, key);
  if (out.place.empty()) fields::refuse(std::string(key) + ".positions", "no place", "at least one");
  for (const Json& weight : fields::list(table, "weights", std::string(key) + ".")) {
    out.weight.push_back(fields::number(weight, std::string(key) + ".weights"));
  }
  if (out.weight.size() != out.place.size()) {
    fields::refuse(std::string(key) + ".weights", std::to_string(out.weight.size()) + " entries",
                   std::to_string(out.place.size()) + ", one per place");
  }
  return out;
}

std::size_t read_index(const Json& entry, std::size_t count, const char* where) {
  if (!entry.is_number_unsigned() || entry.get<std::size_t>() >= count) {
    fields::refuse(where, fields::found(entry), "the index of a place, below " + std::to_string(count));
  }
  return entry.get<std::size_t>();
}

void read_plan(const Json& document, TransportPicture& out) {
  const Json& plan = fields::member(document, "plan");
  const Json &row = fields::list(plan, "row", "plan."), &column = fields::list(plan, "column", "plan."),
             &mass = fields::list(plan, "mass", "plan.");
  if (row.size() != mass.size() || column.size() != mass.size()) {
    fields::refuse("plan", "lists of different lengths", "a row, a column and a mass for each entry");
  }
  for (std::size_t k = 0; k < mass.size(); ++k) {
    out.plan.push_back({read_index(row[k], out.a.place.size(), "plan.row"),
                        read_index(column[k], out.b.place.size(), "plan.column"),
                        fields::number(mass[k], "plan.mass")});
  }
}

}  // namespace

std::optional<TransportPicture> read_transport(const char* text) {
  const Json document = fields::parse(text);
  if (fields::text(document, "format") != "bowstring.transport/1") return std::nullopt;
  TransportPicture out;
  out.method = fields::text(fields::member(document, "method"), "type");
  out.cost = fields::text(fields::member(document, "ground_cost"), "type");
  out.unit = fields::text(document, "unit");
  out.value = fields::number(fields::member(document, "value"), "value");
  const Json& certificate = fields::member(document, "certificate");
  out.certified = certificate.is_object();
  out.holds = out.certified && fields::member(certificate, "holds") == true;
  const Json& unique = fields::member(document, "unique");
  out.uniqueness_known = unique.is_boolean();
  out.unique = unique == true;
  out.a = read_measure(document, "a");
  out.b = read_measure(document, "b");
  read_plan(document, out);
  return out;
}

}  // namespace bowstring
