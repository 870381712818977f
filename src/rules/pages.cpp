// The table as people read it: `colod rules` and docs/rules.
#include <cctype>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "rules.h"

namespace colod {
namespace {

constexpr const char* kIntroduction =
    "# Rules\n\n"
    "Where colod differs from *Architectural Co-LOD Generation*, it does so by rules that have a "
    "name. `--rules robust`, the default, has all\n"
    "of them on, `--rules paper` none; `--without RULE[,RULE...]` switches single ones off, and "
    "with them what needs them. Each page says what a\n"
    "rule sees and does, why, which numbers it has and which test shows it. What they do to whole "
    "sets is measured in\n"
    "[../log/rules-measured.md](../log/rules-measured.md) and, rule by rule, by `bench/ablation "
    "--rules`.\n\n"
    "Written by `colod rules --markdown docs/rules`.\n\n";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string capitalized(std::string_view text) {
  std::string result(text);
  result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
  return result;
}

std::string link(const RuleInfo& info) {
  const std::string id(info.id);
  return "[" + id + "](" + id + ".md)";
}

std::string parameter_table(const RuleInfo& info) {
  std::string text = "| number | value | |\n|---|---|---|\n";
  for (const Parameter& p : info.parameters)
    text.append("| ")
        .append(p.name)
        .append(" | ")
        .append(number(p.value))
        .append(p.unit.empty() ? "" : " ")
        .append(p.unit)
        .append(" | ")
        .append(p.why)
        .append(" |\n");
  return text;
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

nlohmann::ordered_json rule_json(const RuleInfo& info, const RuleSet& rules) {
  nlohmann::ordered_json json{
      {"id", info.id},     {"title", info.title}, {"on", rules.has(info.rule)}, {"sees", info.sees},
      {"does", info.does}, {"paper", info.paper}, {"reason", info.reason}};
  json["parameters"] = nlohmann::ordered_json::array();
  for (const Parameter& p : info.parameters)
    json["parameters"].push_back(
        {{"name", p.name}, {"unit", p.unit}, {"value", p.value}, {"why", p.why}});
  json["needs"] = nlohmann::ordered_json::array();
  for (const Rule need : info.needs) json["needs"].push_back(info_of(need).id);
  json["test"] = info.test;
  json["made_on"] = info.made_on;
  return json;
}

}  // namespace

std::string rule_page(const RuleInfo& info) {
  std::string text = "# " + std::string(info.id) + "\n\n";
  const auto paragraph = [&](const char* head, std::string_view body) {
    text.append("**").append(head).append("** ").append(body).append("\n\n");
  };
  text.append(capitalized(info.title)).append(".\n\n");
  paragraph("Sees.", info.sees);
  paragraph("Does.", info.does);
  paragraph("Without it.", info.paper);
  paragraph("Why.", info.reason);
  if (!info.parameters.empty()) text += parameter_table(info) + "\n";
  std::vector<std::string_view> needs;
  for (const Rule need : info.needs) needs.push_back(info_of(need).id);
  if (!needs.empty()) paragraph("Needs.", joined(needs) + ".");
  paragraph("Made on.", info.made_on.empty()
                            ? "made-up shapes of its own test, no set of buildings."
                            : joined(info.made_on) + "; other sets test it.");
  const std::string_view file = info.test.substr(0, info.test.find(": "));
  text.append("**Test.** tests/").append(file).append(".test.cpp: \"");
  return text.append(info.test.substr(file.size() + 2)).append("\"\n");
}

std::string rules_page() {
  std::string text = kIntroduction;
  text += "| rule | what it does | without it |\n|---|---|---|\n";
  for (const RuleInfo& info : rule_table())
    text.append("| ")
        .append(link(info))
        .append(" | ")
        .append(info.title)
        .append(" | ")
        .append(info.paper)
        .append(" |\n");
  return text;
}

std::string list_rules(const RuleSet& rules) {
  std::string text;
  for (const RuleInfo& info : rule_table()) {
    std::string id(info.id);
    id.resize(22, ' ');
    text.append(id).append(rules.has(info.rule) ? " on   " : " off  ").append(info.title) += '\n';
  }
  return text;
}

std::string rules_json(const RuleSet& rules) {
  nlohmann::ordered_json json;
  for (const RuleInfo& info : rule_table()) json.push_back(rule_json(info, rules));
  return json.dump(2);
}

}  // namespace colod
