// Inside check: a GLB's container and the numbers in it. Nothing here trusts an offset, a count or
// a stride that the file states.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "check.h"

namespace colod {

/// A GLB that is being checked.
struct CheckedGlb {
  const std::string& where;
  std::vector<Finding>& findings;
  nlohmann::json json;
  std::string binary;
  std::size_t work = 0;  ///< spent so far

  void report(const std::string& code, const std::string& place, const std::string& message) {
    findings.push_back({code, where + (place.empty() ? "" : " " + place), message});
  }

  /// Before `steps` numbers are decoded or compared. Throws std::length_error when one file asks
  /// for more than any that a client could show.
  void spend(std::size_t steps);
};

/// Reads header and chunks; false, with a finding, where they are damaged.
bool open_container(CheckedGlb& glb, const std::string& bytes);

/// A number that counts something. Throws std::out_of_range for anything else.
std::size_t whole_number(const nlohmann::json& json);
/// The same of a member, 0 where there is none.
std::size_t whole_number_of(const nlohmann::json& object, const char* name);

/// Bytes of a range of the BIN chunk. Throws std::out_of_range.
std::string slice(const CheckedGlb& glb, const nlohmann::json& range);

/// 4 bytes, and any of glTF's component types. \pre The bytes are there.
std::uint32_t u32_at(const std::string& bytes, std::size_t at);
double element_at(const std::string& bytes, std::size_t at, int type);

/// All numbers of an accessor with a buffer view, `components` an element. Throws
/// std::out_of_range.
std::vector<double> read_accessor(CheckedGlb& glb, const nlohmann::json& accessor,
                                  std::size_t components);

}  // namespace colod
