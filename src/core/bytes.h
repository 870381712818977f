// Numbers as files hold them.
#pragma once

#include <cstring>
#include <string>
#include <vector>

namespace colod {

/// Appends a number's bytes, little endian as all hosts are.
template <typename T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Likewise of a list of plain values.
template <typename T>
void put_all(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// Reads back so many; returns where they end.
template <typename T>
const char* take_all(const char* from, std::size_t count, std::vector<T>& values) {
  values.resize(count);
  if (count == 0) return from;
  std::memcpy(static_cast<void*>(values.data()), from, count * sizeof(T));
  return from + count * sizeof(T);
}

}  // namespace colod
