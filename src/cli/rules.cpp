#include "rules/rules.h"

#include <memory>

#include "cli.h"
#include "core/error.h"
#include "exporters/files.h"
#include "log.h"
#include "pipeline_options.h"

namespace colod::cli {
namespace {

struct RulesArguments {
  std::string id, markdown;
  bool is_json = false;
  Options options;
};

/// A page a rule and their table, for docs/rules.
void write_pages(const std::string& folder) {
  make_folder(folder);
  write_file(folder, {"README.md", rules_page()});
  for (const RuleInfo& info : rule_table())
    write_file(folder, {std::string(info.id) + ".md", rule_page(info)});
}

/// print_answer ends the line.
std::string without_last_line_end(std::string text) {
  text.pop_back();
  return text;
}

int rules(const RulesArguments& a) {
  const RuleSet on = with_needs_met(a.options.rules);
  if (!a.markdown.empty())
    write_pages(a.markdown);
  else if (a.is_json)
    print_answer(rules_json(on));
  else
    print_answer(without_last_line_end(
        a.id.empty() ? list_rules(on) : rule_page(info_of(rule_named(a.id, "RULE")))));
  return 0;
}

}  // namespace

Run add_rules(CLI::App& app) {
  auto a = std::make_shared<RulesArguments>();
  app.add_option("RULE", a->id, "the rule whose page is printed; without it a list of all");
  add_rule_options(app, a->options);
  app.add_flag("--json", a->is_json, "the whole table as JSON");
  app.add_option("--markdown", a->markdown, "a folder to write a page a rule and their index to");
  return [a] { return rules(*a); };
}

}  // namespace colod::cli
