#include "study/store/run_record.hpp"

#include <nlohmann/json.hpp>

#include "core/composition/sha256.hpp"

namespace bowstring::study {
namespace {

using Json = nlohmann::ordered_json;
using Number = RunRecord::Number;

constexpr const char* run_format = "bowstring.run/1";
constexpr const char* digest_opening = ",\n \"digest\": \"";
constexpr const char* digest_closing = "\"\n}\n";

Json number(const Number& value) { return value ? Json(*value) : Json(nullptr); }

Number number_of(const Json& value) { return value.is_number() ? Number(value.get<double>()) : Number(); }

Json text_or_null(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : ""; }

Json numbers(const std::map<std::string, Number>& values) {
  Json out = Json::object();
  for (const auto& [key, value] : values) out[key] = number(value);
  return out;
}

std::map<std::string, Number> numbers_of(const Json& table) {
  std::map<std::string, Number> out;
  for (const auto& [key, value] : table.items()) out[key] = number_of(value);
  return out;
}

Json json_of(const RunRecord& record) {
  Json energy = Json::object();
  for (const auto& [term, value] : record.energy) energy[term] = number(value);
  return {{"format", run_format},
          {"hash", record.hash},
          {"predecessor", text_or_null(record.predecessor)},
          {"status", record.status},
          {"reason", record.reason},
          {"warnings", record.warnings},
          {"problem", {{"unknowns", record.unknowns}}},
          {"solver",
           {{"iterations", record.iterations},
            {"factorizations", record.factorizations},
            {"evaluations", record.evaluations},
            {"epochs", record.epochs}}},
          {"second_order", text_or_null(record.second_order)},
          {"certificate", numbers(record.certificate)},
          {"energy", std::move(energy)},
          {"values", numbers(record.values)},
          {"seconds",
           {{"load", record.load_seconds},
            {"setup", record.setup_seconds},
            {"solve", record.solve_seconds},
            {"total", record.total_seconds}}},
          {"time_limit", record.time_limit > 0.0 ? Json(record.time_limit) : Json(nullptr)},
          {"host", record.host},
          {"peak_memory_MB", record.peak_memory_MB},
          {"document_sha256", text_or_null(record.document_sha256)}};
}

void read(const Json& json, RunRecord& out) {
  out.hash = text_of(json.at("hash"));
  out.predecessor = text_of(json.at("predecessor"));
  out.status = text_of(json.at("status"));
  out.reason = text_of(json.at("reason"));
  out.warnings = json.at("warnings").get<std::vector<std::string>>();
  out.unknowns = json.at("problem").at("unknowns").get<int>();
  const Json& solver = json.at("solver");
  out.iterations = solver.at("iterations").get<int>();
  out.factorizations = solver.at("factorizations").get<int>();
  out.evaluations = solver.at("evaluations").get<int>();
  out.epochs = solver.at("epochs").get<int>();
  out.second_order = text_of(json.at("second_order"));
  out.certificate = numbers_of(json.at("certificate"));
  for (const auto& [term, value] : json.at("energy").items()) out.energy.emplace_back(term, number_of(value));
  out.values = numbers_of(json.at("values"));
  const Json& seconds = json.at("seconds");
  out.load_seconds = seconds.at("load").get<double>();
  out.setup_seconds = seconds.at("setup").get<double>();
  out.solve_seconds = seconds.at("solve").get<std::vector<double>>();
  out.total_seconds = seconds.at("total").get<double>();
  out.time_limit = number_of(json.at("time_limit")).value_or(0.0);
  out.host = text_of(json.at("host"));
  out.peak_memory_MB = json.at("peak_memory_MB").get<double>();
  out.document_sha256 = text_of(json.at("document_sha256"));
}

}  // namespace

std::string run_text(const RunRecord& record) {
  std::string text = json_of(record).dump(1, ' ', false, Json::error_handler_t::replace);
  text.erase(text.rfind('\n'));  // the closing brace
  return text + digest_opening + sha256_hex(text) + digest_closing;
}

std::string read_run_text(const std::string& text, RunRecord& out) {
  const std::size_t end = text.rfind(digest_opening);
  if (end == std::string::npos) return "it ends before its digest";
  if (text.substr(end) != digest_opening + sha256_hex(text.substr(0, end)) + digest_closing) {
    return "its digest does not fit";
  }
  try {
    const Json json = Json::parse(text);
    if (const std::string format = text_of(json.at("format")); format != run_format) {
      return "its format is '" + format + "', this version reads '" + run_format + "'";
    }
    read(json, out);
  } catch (const Json::exception& error) {
    return std::string("it lacks what a run file has (") + error.what() + ")";
  }
  return "";
}

}  // namespace bowstring::study
