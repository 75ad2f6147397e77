#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/interfaces/registry.hpp"

namespace bowstring::test {

/// Offers components that have a schema and nothing else, and remembers which of them were asked for.
class FakeRegistry : public Registry {
 public:
  FakeRegistry();

  std::vector<std::string> names(Kind kind) const override;
  const ComponentDescriptor* find(Kind kind, const std::string& name, Status& status) override;
  ComponentOrigin origin(Kind kind, const std::string& name) const override;

  /// Makes `find` answer `failed` with this text.
  void break_plugin(Kind kind, const std::string& name, const std::string& text);
  void add(Kind kind, const std::string& name, const std::vector<ParameterDeclaration>& schema);

  std::vector<std::string> opened;  ///< "energy/anchoring", each once, in order

 private:
  struct Offer {
    std::string name;
    std::vector<ParameterDeclaration> schema;
    ComponentDescriptor descriptor;
    std::string failure;
  };
  std::map<std::pair<Kind, std::string>, Offer> offers_;
};

}  // namespace bowstring::test
