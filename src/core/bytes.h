// Numbers as files hold them.
#pragma once

#include <string>

namespace colod {

/// Appends a number's bytes, little endian as all hosts are.
template <typename T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace colod
