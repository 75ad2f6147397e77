#include "study/store/folder.hpp"

#include <filesystem>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "core/composition/read_file.hpp"
#include "core/composition/sha256.hpp"
#include "core/result/provenance.hpp"
#include "core/result/write_file.hpp"
#include "study/store/gzip.hpp"

namespace bowstring::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* lock_format = "bowstring.study/1";
constexpr const char* lock_name = "study.lock.json";
constexpr const char* solve_again = "remove it, and the same command solves that run again";

std::string lock_text(const Plan& plan, bool reduced) {
  const StudyFile& study = plan.study;
  Json axes = Json::object();
  for (const Axis& axis : study.axes) {
    axes[axis.data.name] = {{"paths", axis.data.paths}, {"values", axis.data.label}};
  }
  Json libraries = Json::object();
  for (const auto& [name, sha256] : plan.libraries) libraries[name] = sha256;
  Json runs = Json::array();
  for (const PlannedRun& run : plan.runs) {
    runs.push_back(
        {{"hash", run.hash.empty() ? Json(nullptr) : Json(run.hash)},
         {"predecessor",
          run.predecessor < 0 ? Json(nullptr) : Json(plan.runs[static_cast<std::size_t>(run.predecessor)].hash)},
         {"choice", run.choice}});
  }
  const Json lock = {{"format", lock_format},   {"study", study.name},          {"title", study.title},
                     {"reduced", reduced},      {"version", bowstring_version}, {"libraries", std::move(libraries)},
                     {"axes", std::move(axes)}, {"runs", std::move(runs)}};
  return lock.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

/// The study that the folder belongs to; "" where there is no lock file.
std::string Folder::owner(std::string& why) const {
  std::error_code ignored;
  if (!fs::exists(file(lock_name), ignored)) return "";
  std::string text;
  why = read_file(file(lock_name), text);
  if (!why.empty()) return "";
  const Json lock = Json::parse(text, nullptr, false);
  if (lock.is_object() && lock.value("format", "") == lock_format && lock.contains("study")) {
    return lock["study"].is_string() ? lock["study"].get<std::string>() : "";
  }
  why = "it is damaged";
  return "";
}

void Folder::check(const std::string& study, bool to_write, std::vector<InputError>& errors) const {
  const auto fail = [&](const std::string& found, const std::string& expected, const std::string& mend) {
    errors.push_back({"--out " + path_, found, expected, mend});
  };
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error)) {
    return fail("it is no folder", "a folder, or a name for one", "name another");
  }
  std::string why;
  const std::string belongs_to = owner(why);
  if (!why.empty()) {
    return fail("'" + file(lock_name) + "' cannot be read (" + why + ")", "the lock file of a study",
                "remove it if the folder is this study's: the runs in it stay good");
  }
  if (!belongs_to.empty() && belongs_to != study) {
    return fail("the folder belongs to the study '" + belongs_to + "'",
                "a folder of the study '" + study + "', or a new one", "name another folder");
  }
  // An interrupted first start may have left these and nothing else.
  static const std::set<std::string> own{"runs", "claims.lock"};
  for (fs::directory_iterator entry(path_, error), end; belongs_to.empty() && !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (own.count(name) > 0 || name.rfind(std::string(lock_name) + ".part-", 0) == 0) continue;
    return fail("the folder holds '" + name + "' and no " + lock_name, "a folder of this study, or an empty or new one",
                "name another folder");
  }
  for (fs::path place = fs::path(path_) / "runs"; to_write && !place.empty(); place = place.parent_path()) {
    if (!fs::exists(place, error)) continue;
    const std::string obstructed = obstacle((place / "x").string());
    if (!obstructed.empty()) {
      fail("cannot write in '" + place.string() + "': " + obstructed, "a folder that can be written", "");
    }
    return;
  }
}

Status Folder::make() const {
  std::error_code error;
  fs::create_directories(path_ + "/runs", error);
  if (!error) return {};
  return Status::failure(Code::invalid_input, "cannot make '" + path_ + "/runs': " + error.message());
}

Stored Folder::load(const std::string& hash, RunRecord& record, std::string& why) const {
  const std::string place = record_file(hash);
  std::error_code ignored;
  if (!fs::exists(place, ignored)) return Stored::missing;
  std::string text;
  why = read_file(place, text);
  if (why.empty()) why = read_run_text(text, record);
  if (why.empty() && record.hash != hash) why = "it is the record of another run";
  if (why.empty()) return Stored::whole;
  why = place + ": the record of a run is damaged (" + why + "); expected it as it was written; " + solve_again;
  return Stored::damaged;
}

std::string Folder::load_document(const RunRecord& record, std::string& document) const {
  const std::string place = document_file(record.hash);
  if (record.document_sha256.empty()) return place + ": no document is kept of this run";
  std::string why = read_gzip(place, document);
  if (why.empty() && sha256_hex(document) != record.document_sha256) why = "it is not the one of its record";
  if (why.empty()) return "";
  return place + ": the document of a run cannot be used (" + why + "); expected it as it was written; remove " +
         record_file(record.hash) + " too, and the same command solves that run again";
}

Status Folder::store(const RunRecord& record, const std::string& document) const {
  if (!document.empty()) {
    const Status status = write_file(document_file(record.hash), gzip(document), Durability::of_the_process);
    if (!status.ok()) return status;
  }
  return write_file(record_file(record.hash), run_text(record), Durability::of_the_process);
}

Status Folder::write_lock(const Plan& plan, bool reduced) const {
  return write_file(file(lock_name), lock_text(plan, reduced));
}

std::vector<std::string> Folder::problems(const Plan& plan) const {
  std::vector<std::string> out;
  for (const PlannedRun& run : plan.runs) {
    if (run.hash.empty()) continue;
    RunRecord record;
    std::string why, document;
    const Stored stored = load(run.hash, record, why);
    if (stored == Stored::whole && !record.document_sha256.empty()) why = load_document(record, document);
    if (stored == Stored::missing) why = record_file(run.hash) + ": missing: " + run_label(plan.study, run.choice);
    if (!why.empty()) out.push_back(why);
  }
  return out;
}

void Folder::sweep(Claims& claims) const {
  std::vector<fs::path> left;
  std::error_code error;
  for (fs::directory_iterator entry(path_ + "/runs", error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().find(".part-") != std::string::npos) left.push_back(entry->path());
  }
  for (const fs::path& part : left) {
    const std::string hash = part.filename().string().substr(0, part.filename().string().find('.'));
    if (hash.size() != 64 || !claims.take(hash)) continue;
    fs::remove(part, error);
    claims.leave(hash);
  }
}

int Folder::strangers(const Plan& plan) const {
  std::set<std::string> known;
  for (const PlannedRun& run : plan.runs) known.insert(run.hash);
  std::set<std::string> unknown;
  std::error_code error;
  for (fs::directory_iterator entry(path_ + "/runs", error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::string hash = name.substr(0, name.find('.'));
    if (known.count(hash) == 0) unknown.insert(hash);
  }
  return static_cast<int>(unknown.size());
}

}  // namespace bowstring::study
