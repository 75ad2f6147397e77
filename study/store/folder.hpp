#pragma once

#include <string>
#include <vector>

#include "core/composition/composition.hpp"
#include "core/interfaces/status.hpp"
#include "study/plan/plan.hpp"
#include "study/store/claim.hpp"
#include "study/store/run_record.hpp"

namespace bowstring::study {

/// What there is of a run.
enum class Stored : int { missing, whole, damaged };

/// The folder of a study:
///   study.lock.json   what the study is: its name, versions, hashes of libraries, the hash of every run
///   runs/HASH.json              the record of a run
///   runs/HASH.result.json.gz    its result document, where it is kept
///   results.csv, report.html    of all runs
///   claims.lock                 who solves what, while somebody does
/// Every file is written under another name and renamed, the document of a run before its record: a record that is
/// there is whole, or somebody has damaged it, which its digest tells.
class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {
    while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  }

  /// Whether the folder is this study's, or can become it, and can be written if it is `to_write`. What is wrong is in
  /// `errors`; nothing is written.
  void check(const std::string& study, bool to_write, std::vector<InputError>& errors) const;

  /// Makes it where it is not there yet.
  Status make() const;

  /// Of a run by its hash. `why`: what is wrong with a damaged one, with its file.
  Stored load(const std::string& hash, RunRecord& record, std::string& why) const;

  /// The result document of a run; "" or why it cannot be had, with its file.
  std::string load_document(const RunRecord& record, std::string& document) const;

  /// `document`: "" where it is not kept.
  Status store(const RunRecord& record, const std::string& document) const;

  /// `study.lock.json`. `reduced` as in read_study.
  Status write_lock(const Plan& plan, bool reduced) const;

  /// Damage of any file of the plan, and what does not fit; one line each. Reads everything.
  std::vector<std::string> problems(const Plan& plan) const;

  /// Removes what writers left behind that were killed; not what others are writing.
  void sweep(Claims& claims) const;

  /// Files in runs/ that belong to no run of the plan.
  int strangers(const Plan& plan) const;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string record_file(const std::string& hash) const { return path_ + "/runs/" + hash + ".json"; }
  std::string document_file(const std::string& hash) const { return path_ + "/runs/" + hash + ".result.json.gz"; }
  const std::string& path() const noexcept { return path_; }

 private:
  std::string owner(std::string& why) const;

  std::string path_;
};

}  // namespace bowstring::study
