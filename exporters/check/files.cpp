// Based on: RFC 3986 for what a relative reference is.
// Differs: a reference may not leave the folder, whatever it names there.
#include "files.h"

#include <algorithm>
#include <fstream>

#include "core/error.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kLargest = std::uintmax_t{1} << 30;  // bytes of a file

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// A % that no two hexadecimal digits follow stands for itself.
std::string decoded_uri(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool is_escape = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
                           hex_digit(uri[i + 2]) >= 0;
    out +=
        is_escape ? static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2])) : uri[i];
    if (is_escape) i += 2;
  }
  return out;
}

/// Absolute, of another host or scheme, or with a byte that ends a name.
bool is_elsewhere(const std::string& uri) {
  const std::size_t colon = uri.find(':');
  return uri.starts_with('/') || uri.starts_with('\\') || uri.find('\0') != std::string::npos ||
         (colon != std::string::npos && colon < uri.find('/'));
}

bool nests_deeper(const std::string& text, int most) {
  int depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_string) {
      if (c == '\\') ++i;
      is_string = c != '"';
    } else if (c == '"') {
      is_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > most) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

}  // namespace

nlohmann::json parse_json(const std::string& text) {
  if (nests_deeper(text, kDeepestJson)) return nlohmann::json(nlohmann::json::value_t::discarded);
  return nlohmann::json::parse(text, nullptr, false);
}

CheckedFolder::CheckedFolder(const fs::path& root) {
  std::error_code error;
  root_ = fs::canonical(root.empty() ? fs::path(".") : root, error);
}

bool CheckedFolder::holds(const fs::path& path) const {
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  if (error) return false;
  return std::mismatch(root_.begin(), root_.end(), real.begin(), real.end()).first == root_.end();
}

fs::path CheckedFolder::resolve(const fs::path& base, const std::string& uri,
                                const std::string& where, std::vector<Finding>& findings) const {
  const auto refuse = [&](const std::string& code, const std::string& message) {
    findings.push_back({code, where, message});
    return fs::path();
  };
  const std::string name = decoded_uri(uri);
  if (is_elsewhere(name))
    return refuse("outside", "its content is no path below the folder and is not read");
  const fs::path path = base / name;
  if (!holds(path))
    return refuse("outside", "its content leads out of the folder, and is not read");
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return refuse("content", "no file " + path.string());
  return path;
}

std::string read_regular(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    throw Error(Stage::kInput, path.string(), "is not a regular file");
  if (fs::file_size(path, error) > kLargest || error)
    throw Error(Stage::kInput, path.string(), "is larger than 1 GiB, the most that is checked");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(Stage::kInput, path.string(), "cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace colod
