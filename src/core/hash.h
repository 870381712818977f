// A hash by which a later run knows its inputs again.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace colod {

/// FNV-1a, 64 bits, of any bytes; two lanes make accidental equality as unlikely as needed for "did
/// the input change".
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) {
      a_ = (a_ ^ bytes[i]) * 1099511628211ULL;
      b_ = (b_ ^ bytes[i]) * 6364136223846793005ULL + 1442695040888963407ULL;
    }
  }
  template <typename T>
  void add(const std::vector<T>& v) {
    const std::size_t size = v.size();
    add(&size, sizeof size);
    add(v.data(), v.size() * sizeof(T));
  }
  std::array<std::uint64_t, 2> value() const { return {a_, b_}; }
  std::string hex() const {
    char text[33];
    std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(a_),
                  static_cast<unsigned long long>(b_));
    return text;
  }

 private:
  std::uint64_t a_ = 14695981039346656037ULL, b_ = 88172645463325252ULL;
};

inline std::string hash_of(const std::string& bytes) {
  Hash hash;
  hash.add(bytes.data(), bytes.size());
  return hash.hex();
}

}  // namespace colod
