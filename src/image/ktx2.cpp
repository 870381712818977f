// Based on: basisu, the Basis Universal compressor, as a program: no library of it is in Debian.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "codecs.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

constexpr const char* kMagic = "\xABKTX 20\xBB\r\n\x1A\n";

/// Empty: it is not on the PATH.
std::string find_basisu() {
  const char* path = std::getenv("PATH");
  const std::string folders = path ? path : "";
  for (std::size_t at = 0; at < folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    const std::string file = folders.substr(at, end - at) + "/basisu";
    std::error_code error;
    if (end > at && fs::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0)
      return file;
    at = end + 1;
  }
  return {};
}

/// Goes away with all that is in it.
class Workplace {
 public:
  Workplace() {
    std::string name = (fs::temp_directory_path() / "colod-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("KTX2: no room for temporary files");
    folder_ = name;
  }
  ~Workplace() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  std::string operator/(const char* name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

/// Its exit code; what it says is not heard.
int run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t process = 0;
  const int error = posix_spawn(&process, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int status = 0;
  if (error != 0 || waitpid(process, &status, 0) != process) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool can_encode_ktx2() { return !find_basisu().empty(); }

/// ETC1S, whose quality basisu counts from 1 to 255. One thread: buildings are encoded in parallel,
/// and the bytes do not depend on how many there are.
std::string codecs::encode_ktx2(const Raster& raster, int quality) {
  const std::string program = find_basisu();
  if (program.empty()) throw std::runtime_error("KTX2: the program basisu is not on the PATH");
  const Workplace place;
  const std::string in = place / "in.png", out = place / "out.ktx2";
  std::ofstream(in, std::ios::binary) << encode_png(raster);
  const int level = 1 + (quality - 1) * 254 / 99;
  const int code = run({program, "-ktx2", "-q", std::to_string(level), "-mipmap",
                        "-no_multithreading", "-file", in, "-output_file", out});
  if (code != 0)
    throw std::runtime_error("KTX2: " + program + " ended with exit code " + std::to_string(code));
  std::ifstream file(out, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!bytes.starts_with(kMagic))
    throw std::runtime_error("KTX2: " + program + " wrote no KTX2 file");
  return bytes;
}

}  // namespace colod
