#include "rules.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "core/error.h"
#include "parts.h"

namespace colod {
namespace {

/// Least insertions, deletions and substitutions (Wagner, Fischer, 1974).
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// From a word to an id, or to what follows its room.
std::size_t distance(std::string_view word, std::string_view id) {
  return std::min(edits(word, id), edits(word, id.substr(id.find('.') + 1)) + 1);
}

/// FNV-1a, 64 bits.
std::string hash(const std::string& text) {
  std::uint64_t value = 14695981039346656037ULL;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(value));
  return hex;
}

}  // namespace

const std::vector<RuleInfo>& rule_table() {
  static const std::vector<RuleInfo> table = [] {
    using namespace rules;
    std::vector<RuleInfo> rows;
    for (auto part : {source_rules, relief_rules, plane_rules, outline_rules, segment_rules,
                      coanalysis_rules, extraction_rules, element_rules, chain_rules})
      for (RuleInfo& row : part()) rows.push_back(std::move(row));
    std::sort(rows.begin(), rows.end(),
              [](const RuleInfo& a, const RuleInfo& b) { return a.rule < b.rule; });
    return rows;
  }();
  return table;
}

const RuleInfo& info_of(Rule rule) { return rule_table()[static_cast<std::size_t>(rule)]; }

Rule rule_named(const std::string& id, const std::string& option) {
  const RuleInfo* nearest = nullptr;
  for (const RuleInfo& info : rule_table()) {
    if (info.id == id) return info.rule;
    if (!nearest || distance(id, info.id) < distance(id, nearest->id)) nearest = &info;
  }
  throw Error(Stage::kUsage, option,
              "there is no rule '" + id.substr(0, 80) + "'; the nearest is " +
                  std::string(nearest->id) + ", colod rules lists all");
}

RuleSet with_needs_met(RuleSet rules) {
  for (bool is_changed = true; is_changed;) {  // each round but the last switches one off
    is_changed = false;
    for (const RuleInfo& info : rule_table())
      if (rules.has(info.rule) && std::any_of(info.needs.begin(), info.needs.end(),
                                              [&](Rule need) { return !rules.has(need); }))
        rules = rules.without(info.rule), is_changed = true;
  }
  return rules;
}

std::vector<std::string> ids_off(const RuleSet& rules) {
  std::vector<std::string> ids;
  for (const RuleInfo& info : rule_table())
    if (!rules.has(info.rule)) ids.emplace_back(info.id);
  return ids;
}

std::string rules_version() {
  static const std::string version = [] {
    std::string text = "colod " COLOD_VERSION;
    char number[32];
    for (const RuleInfo& info : rule_table()) {
      text.append("\n").append(info.id);
      for (const Parameter& p : info.parameters) {
        std::snprintf(number, sizeof number, "=%a", p.value);
        text.append(" ").append(p.name).append(number);
      }
    }
    return hash(text);
  }();
  return version;
}

}  // namespace colod
