// --without and `colod rules`, from outside.
#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

using colod::test::Ended;
using colod::test::run_colod;
using colod::test::slurp;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

struct Folder : colod::test::TemporaryFolder {
  Ended colod(const std::string& arguments) const { return run_colod(path(), arguments); }
};

long lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

}  // namespace

TEST_CASE("the list says what is on, a page what a rule is, JSON all of it") {
  const Folder folder;
  const Ended list = folder.colod("rules --without planes.coplanar");
  CHECK(list.exit_code == 0);
  CHECK(list.out.find("planes.coplanar        off") != std::string::npos);
  CHECK(list.out.find("planes.sheets          off") != std::string::npos);
  CHECK(list.out.find("planes.floaters        on") != std::string::npos);
  CHECK(folder.colod("rules --rules paper").out.find("  on   ") == std::string::npos);
  CHECK(folder.colod("rules planes.floaters").out.starts_with("# planes.floaters\n"));
  const json all = json::parse(folder.colod("rules --json").out);
  CHECK(static_cast<long>(all.size()) == lines(folder.colod("rules").out));
  CHECK(all[0]["on"] == true);
  CHECK(folder.colod("rules --markdown pages").exit_code == 0);
  CHECK(slurp(folder.path() / "pages/planes.floaters.md") ==
        folder.colod("rules planes.floaters").out);
}

TEST_CASE("what is no rule, or has no effect, is refused before the work") {
  const Folder folder;
  for (const char* what : {"build x.obj -o out", "segment x.obj -o s.colod", "rules"}) {
    const Ended r = folder.colod(std::string(what) + " --without planes.floater");
    CHECK(r.exit_code == 2);
    CHECK(lines(r.err) == 1);
    CHECK(r.err.find("planes.floaters") != std::string::npos);
  }
  const Ended r = folder.colod("rules --rules paper --without planes.floaters");
  CHECK(r.exit_code == 2);
  CHECK(lines(r.err) == 1);
}

TEST_CASE("rules that are off reach the report, by options, config and scene file") {
  const Folder folder;
  REQUIRE(folder.colod("synth -o in --buildings 1").exit_code == 0);
  const std::string options = " --ns 16 --nr 20 --no-report-html --quiet";
  const auto without = [&](const std::string& arguments) {
    REQUIRE(folder.colod(arguments).exit_code <= 1);
    return json::parse(slurp(folder.path() / "out/report.json"))["parameters"].value("without",
                                                                                     json::array());
  };
  CHECK(without("build in -o out" + options).empty());
  const json expected = {"planes.coplanar", "planes.sheets", "chain.volume"};
  CHECK(without("build in -o out --without chain.volume --without planes.coplanar" + options) ==
        expected);
  std::ofstream(folder.path() / "c.toml") << "without = [\"chain.volume\", \"planes.coplanar\"]\n";
  CHECK(without("build in -o out --config c.toml" + options) == expected);

  const std::string some = " --without chain.volume,planes.coplanar --ns 16 --nr 20";
  const Ended segmented = folder.colod("segment in -o s.colod" + some);
  CHECK(segmented.err.find("planes.sheets") != std::string::npos);
  REQUIRE(folder.colod("analyze s.colod").exit_code == 0);
  REQUIRE(folder.colod("mesh s.colod").exit_code <= 1);
  CHECK(without("export s.colod -o out --no-report-html --quiet") == expected);

  REQUIRE(folder.colod("segment in -o t.colod --ns 16 --nr 20").exit_code == 0);
  const Ended both = folder.colod("analyze s.colod t.colod");
  CHECK(both.exit_code == 3);
  CHECK(both.err.find("other rules") != std::string::npos);
}
