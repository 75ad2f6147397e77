#include <doctest/doctest.h>

#include <thread>
#include <vector>

#include "plugins/host/plugin_host.hpp"
#include "tests/plugins/plugin_folders.hpp"

namespace bowstring {

namespace {

struct Answer {
  const ComponentDescriptor* component = nullptr;
  std::string text, file;
};

/// What a host says of every component that it knows, the kinds in an order that each thread begins elsewhere.
std::vector<Answer> answers(PluginHost& host, int first) {
  std::vector<Answer> out(static_cast<std::size_t>(kind_count));
  for (int k = 0; k < kind_count; ++k) {
    const int kind = (first + k) % kind_count;
    for (const std::string& name : host.names(static_cast<Kind>(kind))) {
      Status status;
      Answer& answer = out[static_cast<std::size_t>(kind)];
      answer.component = host.find(static_cast<Kind>(kind), name, status);
      answer.text += status.text;
      answer.file += host.origin(static_cast<Kind>(kind), name).file;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("threads that ask one host at once are answered alike") {
  PluginHostOptions options;
  options.command_line_path = {testing::fixture_folder()};
  PluginHost host(options);
  constexpr int count = 4;
  std::vector<std::vector<Answer>> told(count);
  std::vector<std::thread> threads;
  for (int i = 0; i < count; ++i) {
    threads.emplace_back([&, i] { told[static_cast<std::size_t>(i)] = answers(host, 3 * i); });
  }
  for (std::thread& thread : threads) thread.join();
  const std::vector<Answer> expected = answers(host, 0);
  int found = 0;
  for (std::size_t kind = 0; kind < expected.size(); ++kind) {
    found += expected[kind].component != nullptr;
    for (const std::vector<Answer>& one : told) {
      CHECK(one[kind].component == expected[kind].component);
      CHECK(one[kind].text == expected[kind].text);
      CHECK(one[kind].file == expected[kind].file);
    }
  }
  CHECK(found > 5);
}

}  // namespace bowstring
