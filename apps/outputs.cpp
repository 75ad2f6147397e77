#include "apps/outputs.hpp"

#include <cstdio>
#include <filesystem>

#include "apps/shell.hpp"
#include "core/composition/defaults.hpp"
#include "core/interfaces/writer.hpp"
#include "core/result/write_file.hpp"

namespace bowstring::apps {

namespace fs = std::filesystem;

int Outputs::prepare(const std::optional<std::string>& out, const std::vector<std::string>& write, Registry& registry) {
  int code = exit_converged;
  if (out && out->empty()) {
    complain("--out: found no file; expected for instance --out result.json");
    code = exit_wrong_input;
  } else if (out) {
    targets_.push_back({"--out", behind_links(*out), {}});
  }
  for (const std::string& text : write) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      complain("--write " + text + ": found no writer=file; expected for instance --write svg=picture.svg");
      code = exit_wrong_input;
      continue;
    }
    Target target{"--write " + text, behind_links(text.substr(equals + 1)), {}};
    target.writer.kind = Kind::writer;
    target.writer.name = text.substr(0, equals);
    Status status;
    target.writer.descriptor = registry.find(Kind::writer, target.writer.name, status);
    if (target.writer.descriptor == nullptr) {
      complain(target.label + ": " + status.text);
      code = status.code == Code::invalid_input ? exit_wrong_input : exit_plugin_failed;
      continue;
    }
    target.writer.parameters = default_parameters(*target.writer.descriptor);
    targets_.push_back(std::move(target));
  }
  return code != exit_converged ? code : check_places();
}

int Outputs::check_places() const {
  int code = exit_converged;
  const auto refuse = [&](const Target& target, const std::string& why) {
    complain(target.label + ": " + why);
    code = exit_wrong_input;
  };
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const Target& target = targets_[i];
    const std::string why = obstacle(target.file);
    if (!why.empty()) refuse(target, "cannot write '" + target.file + "': " + why);
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(target.file, targets_[j].file)) continue;
      refuse(target, "'" + target.file + "' is written by " + targets_[j].label + " too; expected one file each");
    }
  }
  return code;
}

int Outputs::spare(const std::vector<std::string>& input_files, const char* reader) const {
  int code = exit_converged;
  for (const Target& target : targets_) {
    for (const std::string& input : input_files) {
      if (!same_file(target.file, input)) continue;
      complain(target.label + ": '" + target.file + "' is what " + reader + " reads; expected another file");
      code = exit_wrong_input;
      break;
    }
  }
  return code;
}

int Outputs::write(const std::string& document) const {
  int code = exit_converged;
  const auto fail = [&](const Target& target, const Status& status, int how) {
    complain(target.label + ": " + status.text);
    if (code == exit_converged) code = how;
  };
  for (const Target& target : targets_) {
    const std::string temporary = temporary_name(target.file);
    Status status;
    if (target.writer.descriptor == nullptr) {
      status = write_file(temporary, document);
      if (!status.ok()) fail(target, status, exit_wrong_input);
      continue;
    }
    const auto writer = create<Writer>(target.writer, status);
    if (status.ok()) status = writer->write(document.c_str(), temporary.c_str());
    if (std::error_code ignored; status.ok() && !fs::exists(temporary, ignored)) {
      status = Status::failure(Code::failed, "writer '" + target.writer.name + "' wrote no file");
    }
    const bool by_choice = status.code == Code::unsupported;  // another writer would do
    if (!status.ok()) fail(target, status, by_choice ? exit_wrong_input : exit_plugin_failed);
  }
  for (const Target& target : targets_) {
    const std::string temporary = temporary_name(target.file);
    if (code != exit_converged) {
      std::remove(temporary.c_str());
    } else if (Status status = publish_file(temporary, target.file); !status.ok()) {
      fail(target, status, exit_wrong_input);
    }
  }
  return code;
}

}  // namespace bowstring::apps
