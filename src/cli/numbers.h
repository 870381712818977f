// What every numeric option is checked with. CLI::Range lets NaN pass, since NaN is neither below
// nor above anything.
#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "cli.h"

namespace colod::cli {

/// A number from `least` to `most`, both included; whole where these are of a whole type.
template <typename T>
CLI::Validator number_between(T least, T most) {
  std::ostringstream range;
  range << (std::is_integral_v<T> ? "whole number" : "number") << " from " << least << " to "
        << most;
  const auto check = [=, text = range.str()](std::string& given) {
    T value{};
    const bool is_inside =
        CLI::detail::lexical_cast(given, value) && value >= least && value <= most;
    return is_inside ? std::string() : "must be a " + text + ", not " + given;
  };
  return CLI::Validator(check, range.str());
}

/// Two or three numbers with commas, as --origin takes them; none farther than a point of the Earth
/// is from its middle, in metres, with room for false eastings.
inline CLI::Validator position() {
  constexpr double kFarthest = 1e8;
  const auto check = [=](std::string& given) {
    std::istringstream parts(given);
    for (std::string part; std::getline(parts, part, ',');) {
      double value = 0;
      if (!CLI::detail::lexical_cast(part, value) || !(std::abs(value) <= kFarthest))
        return "must be numbers of at most 1e8 with commas, not " + given;
    }
    return std::string();
  };
  return CLI::Validator(check, "a,b[,c]");
}

}  // namespace colod::cli
