#include "core/options.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/error.h"

using namespace colod;

TEST_CASE("the paper's defaults stand in the table and are valid") {
  const Options options;
  CHECK_NOTHROW(validate(options));
  for (const OptionInfo& info : option_table()) {
    const double value = info.get(options);
    CHECK(value >= info.min);
    CHECK(value <= info.max);
  }
}

TEST_CASE("the paper's rules bring the paper's n_s") {
  CHECK(default_options(RuleSet::none()).ns == 150);
  CHECK(default_options(RuleSet::all()).ns == Options{}.ns);
}

TEST_CASE("NaN and values out of range are refused by name") {
  for (const OptionInfo& info : option_table()) {
    Options options;
    if (info.is_integer)
      info.set(options, info.max > 1e9 ? info.min : info.max + 1);
    else
      info.set(options, std::nan(""));
    if (info.is_integer && info.max > 1e9)
      continue;  // beyond int: the command line refuses the text
    CHECK_THROWS_WITH(validate(options), Catch::Contains("--" + info.name));
  }
}
