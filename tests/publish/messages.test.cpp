// What a person reads of many buildings.
#include "publish/messages.h"

#include <catch2/catch.hpp>

using namespace colod;

namespace {

std::vector<Message> melted(int count, Level level = Level::kWarning) {
  std::vector<Message> all;
  for (int i = 0; i < count; ++i)
    all.push_back({level, "house-" + std::to_string(i) + ": bumps of 0." + std::to_string(i) +
                              " m: read as roofs"});
  return all;
}

}  // namespace

TEST_CASE("warnings of many buildings that differ in names and numbers alone are one line") {
  for (const int count : {6, 40, 500}) {
    std::vector<Message> all = melted(count);
    all.push_back(all[0]);  // of one building twice
    all.insert(all.begin() + 3, {Level::kError, "house-1: a body is on no layer"});
    all.insert(all.begin(), {Level::kWarning, "layers 0 and 1 are alike"});
    const std::vector<Message> told = gathered(all);
    REQUIRE(told.size() == 3);
    CHECK(told[0].text == "layers 0 and 1 are alike");
    CHECK(told[1].text == "house-0 and " + std::to_string(count - 1) +
                              " others: bumps of 0.0 m: read as roofs; --log-json tells of each");
    CHECK(told[2].level == Level::kError);
  }
}

TEST_CASE("few of a kind, errors and what has no name are told one by one") {
  CHECK(gathered(melted(5)).size() == 5);
  CHECK(gathered(melted(40, Level::kError)).size() == 40);
  CHECK(gathered(std::vector<Message>(9, {Level::kWarning, "no name"})).size() == 9);
  std::vector<Message> all = melted(4);
  for (int i = 0; i < 4; ++i)
    all.push_back({Level::kWarning, "house-" + std::to_string(i) + ": is turned"});
  CHECK(gathered(all).size() == 8);
}
