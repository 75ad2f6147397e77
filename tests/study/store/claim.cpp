#include <doctest/doctest.h>

#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include "study/store/claim.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring::study {
namespace {

const std::string first(64, '1');
const std::string second(64, '2');

/// What a process of its own answers, as its exit status; it ends without tidying up.
template <class Answer>
int in_another_process(const std::string& file, Answer&& answer) {
  const pid_t process = ::fork();
  if (process == 0) {
    Claims* claims = new Claims;  // never destroyed: the system has to let go by itself
    if (!claims->open(file).ok()) ::_exit(99);
    ::_exit(answer(*claims));
  }
  int status = 0;
  ::waitpid(process, &status, 0);
  return WEXITSTATUS(status);
}

}  // namespace

TEST_CASE("a run belongs to one process at a time, and no claim outlives its process") {
  const testing::TemporaryFolder folder;
  const std::string file = folder.path() + "/claims.lock";
  Claims claims;
  REQUIRE(claims.open(file).ok());
  const auto takes = [&](const std::string& hash) {
    return in_another_process(file, [&](Claims& theirs) { return theirs.take(hash) ? 1 : 0; });
  };
  REQUIRE(claims.take(first));
  CHECK(takes(first) == 0);
  CHECK(takes(second) == 1);
  CHECK(claims.take(second));  // the other process is gone
  claims.leave(first);
  CHECK(takes(first) == 1);
  claims.take_folder();
  CHECK(takes(first) == 1);
}

TEST_CASE("a lock file that cannot be made is told") {
  Claims claims;
  CHECK(claims.open("/nonexistent/claims.lock").text ==
        "cannot write '/nonexistent/claims.lock': No such file or directory");
}

}  // namespace bowstring::study
