#include "tests/apps/command.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace bowstring::testing {

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr) throw std::runtime_error(std::string(name) + " is not set: run the tests with 'meson test'");
  return value;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File nameless_file() {
  File file(std::tmpfile());
  if (file == nullptr) throw std::runtime_error("no temporary file can be made");
  return file;
}

std::string content(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char buffer[4096];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, file)) > 0;) text.append(buffer, count);
  return text;
}

/// Where `word` stands, which must be once.
std::size_t only_place(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  if (at == std::string::npos || text.find(word, at + 1) != std::string::npos) {
    throw std::runtime_error("'" + word + "' does not stand exactly once in the text");
  }
  return at;
}

}  // namespace

CommandResult bowstring_command(const std::string& folder, const std::vector<std::string>& arguments) {
  const std::string binary = environment("BOWSTRING_BUILD_ROOT") + "/bowstring";
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), binary);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const File out = nameless_file();
  const File err = nameless_file();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(err.get()), STDERR_FILENO);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, binary.c_str(), &actions, nullptr, argv.data(), ::environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::runtime_error("'" + binary + "' cannot be run");

  int status = 0;
  if (::waitpid(process, &status, 0) != process) throw std::runtime_error("the command cannot be waited for");
  CommandResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = content(out.get());
  result.err = content(err.get());
  return result;
}

std::string source_root() { return environment("BOWSTRING_SOURCE_ROOT"); }

std::string read_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("'" + file + "' cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string shipped_scene(const std::string& name) { return read_text(source_root() + "/scenes/" + name); }

std::vector<std::string> entries(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string edited(std::string text, const std::string& word, const std::string& by) {
  return text.replace(only_place(text, word), word.size(), by);
}

std::string position(const std::string& file, const std::string& text, const std::string& word, std::size_t skip) {
  const std::size_t at = only_place(text, word) + skip;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const std::size_t before = text.rfind('\n', at);
  const std::size_t column = before == std::string::npos ? at + 1 : at - before;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace bowstring::testing
