#include "core/simulation/simulation_result.hpp"

#include <limits>
#include <utility>

#include "core/result/write_file.hpp"
#include "core/simulation/document_path.hpp"
#include "core/simulation/simulation_data.hpp"

namespace bowstring {

namespace {

using Json = nlohmann::ordered_json;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What a path is followed in: the small tables alone where it leads there.
const Json& root_of(const SimulationData& data, const std::string& path) {
  const std::string first = path.substr(0, path.find('.'));
  for (const char* table : {"quantities", "certificate", "energy"}) {
    if (first == table && path.size() > first.size()) return data.scalars();
  }
  return data.document();
}

/// The one value that a path leads to; null with `error` set where there is none.
const Json* one_value(const SimulationData& data, const std::string& path, std::string& error) {
  Selection selection;
  if (data.refusal.any()) {
    error = "there is no result: " + data.refusal.text();
  } else {
    error = follow_path(root_of(data, path), path, selection);
  }
  if (!error.empty()) return nullptr;
  if (!selection.of_every_entry) return selection.values.front();
  error = "path '" + path + "' leads to " + std::to_string(selection.values.size()) +
          " values, one of every entry of a list; expected one: name the entry, or number it from 0";
  return nullptr;
}

std::string mismatch(const std::string& path, const Json& value, const std::string& expected) {
  return "path '" + path + "' leads to " + json_description(value) +
         (value.is_null() ? ": not known, or not defined in this scene" : "") + "; expected " + expected;
}

bool numeric(const Json& value) { return value.is_number() || value.is_null(); }

double number_of(const Json& value) { return value.is_null() ? unknown : value.get<double>(); }

/// Appends a row: one number, or a list of numbers. False where it is neither, or not as long as the rows before.
bool add_row(const Json& value, NumberTable& table) {
  const std::size_t before = table.values.size();
  if (numeric(value)) {
    table.values.push_back(number_of(value));
  } else if (value.is_array()) {
    for (const Json& entry : value) {
      if (!numeric(entry)) return false;
      table.values.push_back(number_of(entry));
    }
  } else {
    return false;
  }
  const int columns = static_cast<int>(table.values.size() - before);
  if (table.rows++ == 0) table.columns = columns;
  return columns == table.columns;
}

}  // namespace

const std::string& SimulationData::text() const {
  std::call_once(text_once_, [&] {
    if (solved()) text_ = result_document(states);
  });
  return text_;
}

const nlohmann::ordered_json& SimulationData::document() const {
  std::call_once(document_once_, [&] {
    if (solved()) document_ = Json::parse(text());
  });
  return document_;
}

const nlohmann::ordered_json& SimulationData::scalars() const {
  std::call_once(scalars_once_, [&] {
    if (solved()) scalars_ = Json::parse(result_scalars(state()));
  });
  return scalars_;
}

SimulationResult::SimulationResult() {
  const auto data = std::make_shared<SimulationData>();
  data->refusal.plugin_failure = Status::failure(Code::failed, "nothing was solved yet");
  data_ = data;
}

SimulationResult::SimulationResult(std::shared_ptr<const SimulationData> data) noexcept : data_(std::move(data)) {}

bool SimulationResult::ok() const noexcept { return !data_->refusal.any(); }
const Refusal& SimulationResult::refusal() const noexcept { return data_->refusal; }
Verdict SimulationResult::status() const noexcept { return data_->status; }
const std::string& SimulationResult::reason() const noexcept { return data_->reason; }
const std::vector<std::string>& SimulationResult::warnings() const noexcept { return data_->warnings; }
const std::string& SimulationResult::json() const { return data_->text(); }
const SimulationData& SimulationResult::data() const noexcept { return *data_; }

Found<double> SimulationResult::number(const std::string& path) const {
  Found<double> out{unknown, ""};
  const Json* value = one_value(*data_, path, out.error);
  if (value == nullptr) return out;
  if (value->is_number()) {
    out.value = value->get<double>();
  } else {
    out.error = mismatch(path, *value, "a number");
  }
  return out;
}

Found<NumberTable> SimulationResult::numbers(const std::string& path) const {
  Found<NumberTable> out;
  Selection selection;
  if (!ok()) {
    one_value(*data_, path, out.error);
    return out;
  }
  out.error = follow_path(root_of(*data_, path), path, selection);
  if (!out.ok()) return out;
  if (!selection.of_every_entry && selection.values.front()->is_array()) {
    const Json& list = *selection.values.front();
    selection = {{}, true};
    for (const Json& entry : list) selection.values.push_back(&entry);
  } else if (!selection.of_every_entry && !selection.values.front()->is_number()) {
    out.error = mismatch(path, *selection.values.front(), "numbers");
    return out;
  }
  for (const Json* value : selection.values) {
    if (add_row(*value, out.value)) continue;
    out.error = mismatch(path, *value, "numbers, or rows of equally many numbers") + ", in row " +
                std::to_string(out.value.rows > 0 ? out.value.rows - 1 : 0);
    out.value = {};
    break;
  }
  return out;
}

Found<std::string> SimulationResult::text(const std::string& path) const {
  Found<std::string> out;
  const Json* value = one_value(*data_, path, out.error);
  if (value == nullptr) return out;
  if (value->is_string()) {
    out.value = value->get<std::string>();
  } else {
    out.error = mismatch(path, *value, "text");
  }
  return out;
}

Found<std::vector<std::string>> SimulationResult::names(const std::string& path) const {
  Found<std::vector<std::string>> out;
  const Json* value = one_value(*data_, path, out.error);
  if (value == nullptr) return out;
  if (value->is_object()) {
    for (const auto& entry : value->items()) out.value.push_back(entry.key());
  } else if (value->is_array()) {
    for (const Json& entry : *value) {
      const std::string label = entry_label(entry);
      out.value.push_back(label.empty() ? std::to_string(out.value.size()) : label);
    }
  } else {
    out.error = mismatch(path, *value, "a table or a list");
  }
  return out;
}

Status SimulationResult::write(const std::string& file) const {
  const auto refuse = [&](const std::string& why) {
    return Status::failure(Code::invalid_input, "cannot write '" + file + "': " + why);
  };
  if (!ok()) return refuse("there is no result: " + refusal().text());
  const std::string target = behind_links(file);
  if (const std::string why = obstacle(target); !why.empty()) return refuse(why);
  for (const std::string& input : data_->input_files) {
    if (same_file(target, input)) return refuse("it is what the composition reads; expected another file");
  }
  return write_file(target, data_->text());
}

}  // namespace bowstring
