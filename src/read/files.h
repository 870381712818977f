// Inside room `read` only: which files an INPUT stands for, and their bytes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace colod::mesh_io {

std::string lower(std::string s);

/// By its extension.
bool is_supported(const std::filesystem::path& path);

/// A file of a folder that is no model for all its name: macOS' shadows, offsets, texts that are no
/// table.
bool is_passed_over(const std::filesystem::path& path);

/// How a file of a known format that is not read becomes one that is; empty: unknown format.
std::string foreign_advice(const std::filesystem::path& path);

struct InputList {
  std::vector<std::string> files;     ///< in order, each once, links resolved for that only
  std::vector<std::string> warnings;  ///< what was passed over, one line each
};

/// The files of all INPUTs. Of a folder those that can be read, sorted by name, with `is_recursive`
/// also of its subfolders; what colod itself wrote, which is named, `._` files of macOS and texts
/// that are no point table are passed over. Throws Error{kInput} when an INPUT does not exist or a
/// folder holds nothing to read or what colod wrote.
InputList list_files(const std::vector<std::string>& inputs, bool is_recursive);

/// The first bytes of a regular file, fewer where it ends; empty for anything else.
std::string file_head(const std::filesystem::path& path, std::size_t bytes);

/// A regular file of at most `input_memory` MiB, which is checked before anything is read. Throws
/// Error{kInput} for anything else, such as pipes, devices and links that lead to themselves.
std::string read_bytes(const std::string& path, double input_memory);

/// Without a byte order mark, UTF-16 turned into UTF-8.
std::string as_text(std::string bytes);

}  // namespace colod::mesh_io
