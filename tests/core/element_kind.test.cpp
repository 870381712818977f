#include "core/element_kind.h"

#include <catch2/catch.hpp>
#include <set>

using namespace colod;

TEST_CASE("every kind has a name of its own, and is found by it") {
  std::set<std::string> names;
  for (int k = 0; k <= static_cast<int>(ElementKind::kOther); ++k) {
    const auto kind = static_cast<ElementKind>(k);
    names.insert(name_of(kind));
    CHECK(kind_named(name_of(kind)) == kind);
  }
  CHECK(names.size() == static_cast<std::size_t>(ElementKind::kOther) + 1);
  CHECK(kind_named("garage") == ElementKind::kOther);
}
