#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/composition/composition.hpp"

namespace bowstring::apps {

inline constexpr int exit_converged = 0;
inline constexpr int exit_fell_short = 1;
inline constexpr int exit_wrong_input = 2;
inline constexpr int exit_plugin_failed = 3;

struct CommonOptions {
  std::vector<std::string> plugin_path;  ///< --plugin-path, in order
};

struct SolveOptions {
  std::string file;
  std::vector<std::string> set;    ///< "path=value"
  std::optional<std::string> out;  ///< result document
  std::vector<std::string> write;  ///< "writer=file"
  bool json = false;
};

struct CheckCommandOptions {
  std::string file;
  std::vector<std::string> set;  ///< "path=value"
  bool json = false;
};

struct StudyOptions {
  std::string file;
  std::string out;            ///< the study's folder
  int jobs = 0;               ///< 0: one for each core
  std::string shard = "1/1";  ///< "i/n"
  std::string keep = "full";  ///< full | summary
  bool reduced = false, check = false;
};

struct CompareOptions {
  std::string a, b;
  bool json = false;
};

struct RerunOptions {
  std::string file;
  bool force = false;
  std::optional<std::string> out;
  bool json = false;
};

struct TransportOptions {
  std::string a, b;
  std::string method = "exact", cost = "euclidean";
  std::vector<std::string> set;  ///< "key=value"
  int points = 0;                ///< 0: the nodes of curves
  std::string weights;           ///< "": what files have, or else uniform
  int repeat = 0;
  std::optional<std::string> out;
  std::vector<std::string> write;  ///< "writer=file"
  bool json = false;
};

int solve(const CommonOptions& common, const SolveOptions& options);
int explain(const CommonOptions& common, const std::string& file, const std::vector<std::string>& set);
int check(const CommonOptions& common, const CheckCommandOptions& options);
int study(const CommonOptions& common, const StudyOptions& options);
int compare(const CommonOptions& common, const CompareOptions& options);
int rerun(const CommonOptions& common, const RerunOptions& options);
int transport(const CommonOptions& common, const TransportOptions& options);
/// `kind` "" for all.
int list_plugins(const CommonOptions& common, const std::string& kind, bool json);
/// `what`: "kind/name".
int describe(const CommonOptions& common, const std::string& what, bool json);

}  // namespace bowstring::apps
