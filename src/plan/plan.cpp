// Based on: longest processing time first (Graham, "Bounds on multiprocessing timing anomalies",
// SIAM J. Appl. Math. 17(2), 1969): the largest job goes to the machine that has least. Differs:
// what an earlier plan shared out stays where it is. Notation: –
#include "plan.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "place/cloud_place.h"
#include "store/options_text.h"

namespace colod {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

constexpr const char* kSplits[] = {"auto", "none", "object", "group", "component"};
constexpr const char* kUps[] = {"unsaid", "z", "y", "auto"};

template <typename Enum, std::size_t N>
Enum named(const char* const (&names)[N], const std::string& name) {
  const auto found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names)) throw std::invalid_argument("unknown word " + name);
  return static_cast<Enum>(found - std::begin(names));
}

Json read_options_json(const ReadOptions& o) {
  Json json{{"split", kSplits[static_cast<int>(o.split)]},
            {"up", kUps[static_cast<int>(o.up)]},
            {"input_memory", o.input_memory},
            {"recursive", o.is_recursive}};
  if (o.unit) json["unit"] = *o.unit;
  return json;
}

ReadOptions read_options_of(const Json& json) {
  ReadOptions o;
  o.split = named<Split>(kSplits, json.at("split"));
  o.up = named<Up>(kUps, json.at("up"));
  o.input_memory = json.at("input_memory");
  o.is_recursive = json.at("recursive");
  if (json.contains("unit")) o.unit = json.at("unit").get<double>();
  o.cloud_units = units_of_cloud;
  return o;
}

PlannedFile planned(const InputFile& file) {
  std::ifstream in(file.path, std::ios::binary);
  if (!in) throw Error(Stage::kInput, file.path, "cannot be opened any more");
  PlannedFile result{file, 0, {}};
  Hash hash;
  std::vector<char> piece(1 << 20);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())) || in.gcount() > 0) {
    hash.add(piece.data(), static_cast<std::size_t>(in.gcount()));
    result.bytes += static_cast<std::uint64_t>(in.gcount());
  }
  result.hash = hash.hex();
  return result;
}

/// In which cell a plan has each path.
std::map<std::string, std::size_t> cells_by_path(const Plan& plan) {
  std::map<std::string, std::size_t> cells;
  for (std::size_t c = 0; c < plan.cells.size(); ++c)
    for (const PlannedFile& f : plan.cells[c]) cells[f.file.path] = c;
  return cells;
}

void share_out(std::vector<PlannedFile> files, const Plan* previous, Plan& plan) {
  std::vector<std::uint64_t> load(plan.cells.size(), 0);
  std::map<std::string, std::size_t> known;
  if (previous && previous->cells.size() == plan.cells.size()) known = cells_by_path(*previous);
  const auto put = [&](PlannedFile&& file, std::size_t cell) {
    load[cell] += file.bytes;
    plan.cells[cell].push_back(std::move(file));
  };
  std::vector<PlannedFile> others;
  for (PlannedFile& f : files)
    if (const auto at = known.find(f.file.path); at != known.end())
      put(std::move(f), at->second);
    else
      others.push_back(std::move(f));
  std::stable_sort(others.begin(), others.end(), [](const PlannedFile& a, const PlannedFile& b) {
    return a.bytes != b.bytes ? a.bytes > b.bytes : a.file.path < b.file.path;
  });
  for (PlannedFile& f : others)
    put(std::move(f), std::min_element(load.begin(), load.end()) - load.begin());
  for (std::vector<PlannedFile>& cell : plan.cells)
    std::sort(cell.begin(), cell.end(),
              [](const PlannedFile& a, const PlannedFile& b) { return a.file.path < b.file.path; });
}

Json cell_json(const std::vector<PlannedFile>& cell) {
  Json files = Json::array();
  for (const PlannedFile& f : cell)
    files.push_back(
        {{"path", f.file.path}, {"names", f.file.names}, {"bytes", f.bytes}, {"hash", f.hash}});
  return {{"files", std::move(files)}};
}

std::vector<PlannedFile> cell_of(const Json& json) {
  std::vector<PlannedFile> cell;
  for (const Json& f : json.at("files"))
    cell.push_back({{f.at("path"), f.at("names").get<std::vector<std::string>>()},
                    f.at("bytes"),
                    f.at("hash")});
  return cell;
}

std::string beside(const std::string& plan_path, std::size_t cell, const char* suffix) {
  char name[32];
  std::snprintf(name, sizeof name, "cell-%04zu%s", cell, suffix);
  return (std::filesystem::path(plan_path).parent_path() / name).string();
}

/// A whole number, 0 or more, of a text; none: it is no such number.
std::optional<std::size_t> number(const char* text) {
  if (!text || !*text) return std::nullopt;
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text, &end, 10);
  if (*end || errno || value < 0) return std::nullopt;
  return static_cast<std::size_t>(value);
}

Shard checked(std::size_t index, std::size_t count, const std::string& text) {
  if (count == 0 || index >= count)
    throw Error(Stage::kUsage, "--shard", text + " is none: I/N with I from 0 to N - 1");
  return {index, count};
}

/// An array job's tasks are the shards: from the first task on, by its step.
Shard slurm_shard(std::size_t task) {
  const std::size_t first = number(getenv("SLURM_ARRAY_TASK_MIN")).value_or(0);
  const std::size_t step =
      std::max<std::size_t>(1, number(getenv("SLURM_ARRAY_TASK_STEP")).value_or(1));
  const auto last = number(getenv("SLURM_ARRAY_TASK_MAX"));
  if (!last || task < first || *last < task)
    throw Error(Stage::kUsage, "--shard",
                "is not given, and SLURM_ARRAY_TASK_ID does not come from an array of tasks");
  return {(task - first) / step, (*last - first) / step + 1};
}

}  // namespace

std::size_t Plan::building_count() const {
  std::size_t count = 0;
  for (const auto& cell : cells)
    for (const PlannedFile& f : cell) count += f.file.names.size();
  return count;
}

Plan make_plan(const Inventory& inventory, const ReadOptions& read, const Options& options,
               int cells, const Plan* previous) {
  Plan plan{read, options, std::vector<std::vector<PlannedFile>>(static_cast<std::size_t>(cells)),
            inventory.failures, inventory.warnings};
  std::vector<PlannedFile> files(inventory.files.size());
  parallel_for(files.size(), [&](std::size_t i) { files[i] = planned(inventory.files[i]); });
  share_out(std::move(files), previous, plan);
  return plan;
}

Inventory inventory_of(const Plan& plan, std::size_t cell) {
  Inventory inventory;
  for (const PlannedFile& f : plan.cells[cell]) inventory.files.push_back(f.file);
  return inventory;
}

std::string plan_text(const Plan& plan) {
  Json json{{"format", kFormat},
            {"read", read_options_json(plan.read)},
            {"options", Json::parse(options_text(plan.options))},
            {"failures", Json::array()},
            {"warnings", plan.warnings},
            {"cells", Json::array()}};
  for (const ReadFailure& f : plan.failures)
    json["failures"].push_back({{"path", f.path}, {"message", f.message}});
  for (const auto& cell : plan.cells) json["cells"].push_back(cell_json(cell));
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Plan parse_plan(const std::string& text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat)
      throw Error(Stage::kInput, where, "is a plan of another format: run colod plan again");
    Plan plan;
    plan.read = read_options_of(json.at("read"));
    plan.options = options_of(json.at("options").dump(), where);
    for (const Json& f : json.at("failures"))
      plan.failures.push_back({f.at("path"), f.at("message")});
    plan.warnings = json.at("warnings").get<std::vector<std::string>>();
    for (const Json& cell : json.at("cells")) plan.cells.push_back(cell_of(cell));
    if (plan.cells.empty()) throw Error(Stage::kInput, where, "has no cells: run colod plan again");
    return plan;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(Stage::kInput, where, std::string("is no plan of colod: ") + e.what());
  }
}

Plan read_plan(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(Stage::kInput, path, "cannot be opened: colod plan writes it");
  return parse_plan({std::istreambuf_iterator<char>(in), {}}, path);
}

std::string cell_stamp(const Plan& plan, std::size_t cell) {
  const std::string text = read_options_json(plan.read).dump() + options_text(plan.options) +
                           cell_json(plan.cells[cell]).dump();
  Hash hash;
  hash.add(text.data(), text.size());
  return hash.hex() + "\n";
}

std::string cell_scene(const std::string& plan_path, std::size_t cell) {
  return beside(plan_path, cell, ".colod");
}

std::string cell_stamp_file(const std::string& plan_path, std::size_t cell) {
  return beside(plan_path, cell, ".stamp");
}

std::string cell_export(const std::string& plan_path, std::size_t cell) {
  return beside(plan_path, cell, ".export");
}

namespace {

std::string beside(const std::string& plan_path, const char* name) {
  return (std::filesystem::path(plan_path).parent_path() / name).string();
}

}  // namespace

std::string kept_tiles_file(const std::string& plan_path) {
  return beside(plan_path, "merge.tiles");
}
std::string archived_tiles(const std::string& plan_path) { return beside(plan_path, "archived"); }
std::string kept_switching_file(const std::string& plan_path) {
  return beside(plan_path, "switching.json");
}

bool is_sharded(const std::string& text) {
  return !text.empty() || number(getenv("SLURM_ARRAY_TASK_ID")) ||
         number(getenv("JOB_COMPLETION_INDEX"));
}

Shard shard_of(const std::string& text, std::size_t cells) {
  if (!text.empty()) {
    const std::size_t slash = text.find('/');
    const auto index = number(text.substr(0, slash).c_str());
    const auto count = slash == text.npos ? std::nullopt : number(text.substr(slash + 1).c_str());
    if (!index || !count) return checked(1, 0, text);
    return checked(*index, *count, text);
  }
  if (const auto task = number(getenv("SLURM_ARRAY_TASK_ID"))) return slurm_shard(*task);
  if (const auto job = number(getenv("JOB_COMPLETION_INDEX")))
    return checked(*job, cells, "JOB_COMPLETION_INDEX beyond the plan's cells");
  return {};
}

std::vector<std::size_t> cells_of(const Shard& shard, std::size_t cells) {
  std::vector<std::size_t> own;
  for (std::size_t c = shard.index; c < cells; c += shard.count) own.push_back(c);
  return own;
}

}  // namespace colod
