#include "rules/rules.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <regex>
#include <set>

#include "core/error.h"
#include "temporary_folder.h"

using namespace colod;
using test::slurp;
namespace fs = std::filesystem;

namespace {

const fs::path kRoot = COLOD_SOURCE_DIR;

/// The C++ text with literals that are only broken for length joined.
std::string with_whole_literals(const std::string& text) {
  static const std::regex line_break("\"\\s*\n\\s*\"");
  return std::regex_replace(text, line_break, "");
}

}  // namespace

TEST_CASE("every rule has a row, in order, under an id of its own") {
  REQUIRE(rule_table().size() == kRuleCount);
  std::set<std::string_view> ids, titles;
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const RuleInfo& info = rule_table()[i];
    INFO(info.id);
    CHECK(info.rule == static_cast<Rule>(i));
    CHECK(std::regex_match(std::string(info.id), std::regex("[a-z]+\\.[a-z_]+")));
    CHECK(rule_named(std::string(info.id), "") == info.rule);
    ids.insert(info.id), titles.insert(info.title);
    for (const std::string_view text : {info.title, info.sees, info.does, info.paper, info.reason})
      CHECK(!text.empty());
    std::set<std::string_view> names;
    for (const Parameter& p : info.parameters) {
      CHECK(std::isfinite(p.value));
      CHECK(!p.why.empty());
      names.insert(p.name);
    }
    CHECK(names.size() == info.parameters.size());
  }
  CHECK(ids.size() == kRuleCount);
  CHECK(titles.size() == kRuleCount);
}

TEST_CASE("every rule has a test that is there") {
  for (const RuleInfo& info : rule_table()) {
    INFO(info.id << " is shown by " << info.test);
    const std::size_t end = info.test.find(": ");
    REQUIRE(end != std::string_view::npos);
    const fs::path file = kRoot / "tests" / (std::string(info.test.substr(0, end)) + ".test.cpp");
    const std::string text = with_whole_literals(slurp(file));
    CHECK(text.find("\"" + std::string(info.test.substr(end + 2)) + "\"") != std::string::npos);
  }
}

TEST_CASE("what needs a rule that is off is off, too") {
  const RuleSet set = with_needs_met(RuleSet::all().without(Rule::kCoplanar));
  CHECK(!set.has(Rule::kSheetSides));
  CHECK(ids_off(set) == std::vector<std::string>{"planes.coplanar", "planes.sheets"});
  CHECK(with_needs_met(RuleSet::all()) == RuleSet::all());
  CHECK(with_needs_met(RuleSet::none()) == RuleSet::none());
  for (const RuleInfo& info : rule_table())
    for (const Rule need : info.needs) CHECK(need != info.rule);
}

TEST_CASE("all rules off one by one is none") {
  RuleSet set = RuleSet::all();
  for (const RuleInfo& info : rule_table()) {
    CHECK(set.has(info.rule));
    CHECK(set.without(info.rule).with(info.rule) == set);
    set = set.without(info.rule);
  }
  CHECK(set == RuleSet::none());
  CHECK(set.is_none());
}

TEST_CASE("an id that is none is refused with the nearest") {
  CHECK_THROWS_WITH(rule_named("planes.floater", "--without"),
                    Catch::Contains("--without") && Catch::Contains("nearest is planes.floaters"));
  CHECK_THROWS_WITH(rule_named("floaters", ""), Catch::Contains("planes.floaters"));
  CHECK_THROWS_AS(rule_named("", ""), Error);
}

TEST_CASE("docs/rules says what the program says") {
  const fs::path folder = kRoot / "docs" / "rules";
  INFO("colod rules --markdown docs/rules writes the pages anew");
  std::set<std::string> expected{"README.md"};
  CHECK(slurp(folder / "README.md") == rules_page());
  for (const RuleInfo& info : rule_table()) {
    const std::string name = std::string(info.id) + ".md";
    expected.insert(name);
    INFO(name);
    CHECK(slurp(folder / name) == rule_page(info));
  }
  std::set<std::string> there;
  for (const auto& entry : fs::directory_iterator(folder)) there.insert(entry.path().filename());
  CHECK(there == expected);
}
