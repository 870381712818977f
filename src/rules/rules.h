// Every rule by which colod differs from the paper, once: what it sees and does, why, its numbers
// and its test. `colod rules`, --without, docs/rules, the keys of scene files and bench/ablation
// --rules come from this table, so that none of them can disagree.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/rules.h"

namespace colod {

/// A number of a rule, as the room that it works in takes it.
struct Parameter {
  std::string_view name;
  std::string_view unit;  ///< "m", "m²", "°", "rad"; "": a count or a share
  double value;
  std::string_view why;  ///< what it is of, and why it is this
};

struct RuleInfo {
  Rule rule;
  std::string_view id;     ///< room.name, as on the command line
  std::string_view title;  ///< a few words
  std::string_view sees;   ///< what it looks at and when it applies
  std::string_view does;   ///< and what then happens
  std::string_view paper;  ///< what happens without it: the paper's way, where it has one
  std::string_view reason;
  std::vector<Parameter> parameters;
  std::vector<Rule> needs;  ///< without these it cannot do anything
  std::string_view test;    ///< room/file: the test case that shows it on the least input
  std::vector<std::string_view> made_on;  ///< sets that it was made on (bench/ablation --rules)
};

/// All rules in the order of Rule.
const std::vector<RuleInfo>& rule_table();
const RuleInfo& info_of(Rule rule);

/// The rule of an id. Throws Error{kUsage} in one line that names the nearest id.
Rule rule_named(const std::string& id, const std::string& option);

/// The set without the rules that need one that is off.
RuleSet with_needs_met(RuleSet rules);
/// Ids of the rules that are off, in order.
std::vector<std::string> ids_off(const RuleSet& rules);

/// A page of a rule, and the table of all of them, as Markdown.
std::string rule_page(const RuleInfo& info);
std::string rules_page();
/// The list with what is on and off, and the table as JSON.
std::string list_rules(const RuleSet& rules);
std::string rules_json(const RuleSet& rules);

/// Hash of this program's version, its rules and their numbers, for files that outlive it.
std::string rules_version();

}  // namespace colod
