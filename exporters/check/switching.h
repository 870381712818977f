// Inside check: what files say of when levels switch, held against each other.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "check.h"

namespace colod {

/// One gsd a layer for all buildings, where the files say that the scene is the scope.
class ScopeCheck {
 public:
  /// What a file says of switching in its extras.
  void expect(const nlohmann::json& switching);
  /// Rows of a property table. Finest levels and stand-ins do not count.
  void add(const std::vector<GlbContent::Row>& rows, const std::string& where);
  void report(std::vector<Finding>& findings) const;

 private:
  struct Said {
    double gsd;
    std::string where;
  };
  bool is_scene_ = false;
  std::map<int, std::vector<Said>> said_;  // by layer
};

/// engine/lods.json: gsds rise from 0, distances are what they make them.
void check_lods(const std::string& text, const std::string& where, ScopeCheck& scope,
                std::vector<Finding>& findings);

}  // namespace colod
