#include <doctest/doctest.h>

#include <filesystem>

#include "study/store/folder.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::study {

using bowstring::testing::replaced;
using bowstring::testing::TemporaryFolder;

namespace {

std::string check(const Folder& folder, const std::string& study, const std::string& root) {
  std::vector<InputError> errors;
  folder.check(study, true, errors);
  std::string out;
  for (const InputError& error : errors) out += (out.empty() ? "" : "\n") + error.text();
  return replaced(out, root, "DIR");
}

Plan small_plan() {
  Plan plan;
  plan.study.name = "mine";
  PlannedRun run;
  run.hash = std::string(64, 'a');
  plan.runs = {run};
  return plan;
}

RunRecord small_record() {
  RunRecord record;
  record.hash = std::string(64, 'a');
  record.status = "converged";
  return record;
}

}  // namespace

TEST_CASE("a folder is this study's, new, or refused; checking writes nothing") {
  const TemporaryFolder root;
  const Folder folder(root.path() + "/out/deep/");
  CHECK(folder.path() == root.path() + "/out/deep");
  CHECK(check(folder, "mine", root.path()) == "");
  CHECK(!std::filesystem::exists(root.path() + "/out"));
  REQUIRE(folder.make().ok());
  CHECK(check(folder, "mine", root.path()) == "");
  REQUIRE(folder.write_lock(small_plan(), false).ok());
  CHECK(check(folder, "mine", root.path()) == "");
  CHECK(check(folder, "yours", root.path()) ==
        "--out DIR/out/deep: the folder belongs to the study 'mine'; expected a folder of the study 'yours', or a new "
        "one; name another folder");
  root.write("out/deep/study.lock.json", "{");
  CHECK(
      check(folder, "mine", root.path()) ==
      "--out DIR/out/deep: 'DIR/out/deep/study.lock.json' cannot be read (it is damaged); expected the lock file of a "
      "study; remove it if the folder is this study's: the runs in it stay good");
  CHECK(
      check(Folder(root.path() + "/out"), "mine", root.path()) ==
      "--out DIR/out: the folder holds 'deep' and no study.lock.json; expected a folder of this study, or an empty or "
      "new one; name another folder");
  root.write("file", "");
  CHECK(check(Folder(root.path() + "/file"), "mine", root.path()) ==
        "--out DIR/file: it is no folder; expected a folder, or a name for one; name another");
}

TEST_CASE("records and documents come back as they were stored, or are told to be damaged") {
  const TemporaryFolder root;
  const Folder folder(root.path());
  REQUIRE(folder.make().ok());
  RunRecord record = small_record(), again;
  std::string why, document;
  CHECK(folder.load(record.hash, again, why) == Stored::missing);
  CHECK(folder.problems(small_plan()).size() == 1);
  record.document_sha256 = "wrong";
  REQUIRE(folder.store(record, "{}").ok());
  REQUIRE(folder.load(record.hash, again, why) == Stored::whole);
  why = folder.load_document(again, document);
  CHECK(why.find("cannot be used (it is not the one of its record)") != std::string::npos);
  CHECK(folder.problems(small_plan()) == std::vector<std::string>{why});
  root.write("runs/" + record.hash + ".json", "{}");
  CHECK(folder.load(record.hash, again, why) == Stored::damaged);
  CHECK(folder.strangers(small_plan()) == 0);
  root.write("runs/" + std::string(64, 'f') + ".json", "{}");
  CHECK(folder.strangers(small_plan()) == 1);
}

TEST_CASE("what killed writers leave is removed, what others write is not") {
  const TemporaryFolder root;
  const Folder folder(root.path());
  REQUIRE(folder.make().ok());
  const std::string left = "runs/" + std::string(64, 'a') + ".json.part-1";
  const std::string busy = "runs/" + std::string(64, 'b') + ".json.part-2";
  root.write(left, "{");
  root.write(busy, "{");
  Claims ours, theirs;
  REQUIRE(ours.open(folder.file("claims.lock")).ok());
  REQUIRE(theirs.open(folder.file("claims.lock")).ok());
  REQUIRE(theirs.take(std::string(64, 'b')));
  folder.sweep(ours);
  CHECK(!std::filesystem::exists(root.path() + "/" + left));
  CHECK(std::filesystem::exists(root.path() + "/" + busy));
}

}  // namespace bowstring::study
