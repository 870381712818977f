// The public header's names over the job's: options as texts, faults, plain copies.
#define COLOD_NO_ALIAS
#include "colod/colod.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <utility>

#include "cli/job_options.h"
#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "job/job.h"

namespace colod_v0 {
namespace {

using Seconds = std::chrono::duration<double>;

Fault fault_of(colod::Stage stage) { return static_cast<Fault>(static_cast<int>(stage)); }

/// Runs `body`; what the rooms throw becomes what the header promises.
template <typename Body>
auto translated(const Body& body) {
  try {
    return body();
  } catch (const colod::Error& e) {
    throw Error(fault_of(e.stage), e.item, std::string(e.what()).substr(e.item.size() + 2));
  } catch (const std::bad_alloc&) {
    throw Error(Fault::kProcess, "memory", "there is not enough");
  }
}

/// The command line's options, without a command line.
struct Settings {
  colod::Job job;
  int threads = 0;
  CLI::App app;

  Settings() {
    app.set_help_flag();
    colod::cli::add_job_options(app, job);
    app.add_option("--threads", threads, "threads to use, 0 = all cores")
        ->check(colod::cli::number_between(0, 4096));
  }
  Settings(const Settings&) = delete;

  void set(const Options& options) {
    std::vector<std::string> words;
    for (const auto& [name, value] : options) {
      if (app.get_option_no_throw("--" + name) == nullptr)
        throw Error(Fault::kUsage, name, "is no option; list_options() names all");
      words.push_back("--" + name + "=" + value);
    }
    try {
      app.parse(std::move(words));
    } catch (const CLI::ParseError& e) {
      throw Error(Fault::kUsage, "options", e.what());
    }
  }
};

/// The caller's callbacks; what they throw is kept until the threads have come back.
class Listener {
 public:
  explicit Listener(const Callbacks& callbacks) : callbacks_(callbacks) {}

  colod::JobHooks hooks(const colod::Tell& tell) {
    return {.progress =
                [this](const std::string& building, const char* stage, int done, int total) {
                  if (callbacks_.progress)
                    guard([&] { callbacks_.progress({building, stage, done, total}); });
                },
            .is_cancelled =
                [this] {
                  if (!is_cancelled_ && callbacks_.cancel)
                    guard([&] { is_cancelled_ = is_cancelled_ || callbacks_.cancel(); });
                  return is_cancelled_.load();
                },
            .tell = tell,
            .ready = {}};
  }

  [[noreturn]] void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
    throw Error(Fault::kCancelled, "build", "cancelled");
  }

 private:
  template <typename Body>
  void guard(const Body& body) {
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!thrown_) thrown_ = std::current_exception();
      is_cancelled_ = true;
    }
  }

  const Callbacks& callbacks_;
  std::atomic<bool> is_cancelled_ = false;
  std::mutex mutex_;
  std::exception_ptr thrown_;
};

Point point_of(const colod::Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::vector<Point> points_of(const std::vector<colod::Vec3>& from) {
  std::vector<Point> to;
  to.reserve(from.size());
  for (const colod::Vec3& v : from) to.push_back(point_of(v));
  return to;
}

std::vector<colod::Vec3> vectors_of(const std::vector<Point>& from) {
  std::vector<colod::Vec3> to;
  to.reserve(from.size());
  for (const Point& p : from) to.emplace_back(p[0], p[1], p[2]);
  return to;
}

Mesh mesh_of(const colod::PolygonMesh& from) {
  Mesh to;
  to.points = points_of(from.vertices);
  to.triangles.assign(from.triangles.begin(), from.triangles.end());
  to.polygon_of_triangle.assign(from.facet_of_triangle.begin(), from.facet_of_triangle.end());
  to.polygon_rings = {0};
  to.ring_offsets = {0};
  for (const colod::PolygonMesh::Facet& facet : from.facets) {
    to.normals.push_back(point_of(facet.normal));
    for (const std::vector<int>& ring : facet.rings) {
      to.ring_points.insert(to.ring_points.end(), ring.begin(), ring.end());
      to.ring_offsets.push_back(static_cast<std::int32_t>(to.ring_points.size()));
    }
    to.polygon_rings.push_back(static_cast<std::int32_t>(to.ring_offsets.size()) - 1);
  }
  return to;
}

Building building_of(const colod::Building& from) {
  Building to;
  to.name = from.source.name;
  to.given_name = from.source.given_name;
  to.source = from.source.path;
  to.origin = point_of(from.frame.origin);
  to.failure = from.failure;
  to.has_lost = from.has_lost();
  for (const colod::Layer& l : from.layers)
    to.layers.push_back({l.layer, l.gsd, l.sight.deviation, l.sight.is_like_finer, l.failure});
  return to;
}

Message message_of(const colod::Message& from) {
  return {static_cast<Message::Level>(static_cast<int>(from.level)), from.text};
}

}  // namespace

struct Scene::Impl {
  colod::Job job;
  int threads = 0;
  colod::Product product;
  double seconds = 0;  // until there were meshes
  std::vector<Building> buildings;
  std::vector<Message> notes;  // of reading and of the last making of files

  std::mutex mutex;  // encoding notes sizes and failures in the scene
  std::string report;

  /// Makes all files; `report` is one of them.
  void encode(const colod::Take& take) {
    const auto start = std::chrono::steady_clock::now();
    std::vector<Message> told;
    colod::Pictures pictures = product.pictures;
    colod::in_threads(threads, [&] {
      colod::encode_scene(
          product.scene, job.output, *product.depot, take,
          [&](const colod::Message& m) { told.push_back(message_of(m)); }, &pictures);
    });
    if (report.empty()) notes.insert(notes.end(), told.begin(), told.end());
    const double total = seconds + Seconds(std::chrono::steady_clock::now() - start).count();
    for (const colod::Encoded& file :
         colod::encode_report(product.scene, job.options, {total, colod::peak_memory_bytes()},
                              std::move(pictures), job.output)) {
      if (file.path == "report.json") report = file.bytes;
      take(file);
    }
  }
};

/// Makes scenes, which nobody else can.
struct Access {
  template <typename Input>
  static Scene build(const Input& input, Settings& settings, const Callbacks& callbacks) {
    auto impl = std::make_unique<Scene::Impl>();
    impl->job = settings.job;
    impl->threads = settings.threads;
    Listener listener(callbacks);
    const auto start = std::chrono::steady_clock::now();
    const colod::Tell tell = [&](const colod::Message& m) { impl->notes.push_back(message_of(m)); };
    colod::switch_off_dependents(impl->job.options, tell);
    try {
      colod::in_threads(impl->threads, [&] {
        impl->product = colod::run_job(input, impl->job, listener.hooks(tell));
      });
    } catch (const colod::Cancelled&) {
      listener.rethrow();
    }
    impl->seconds = Seconds(std::chrono::steady_clock::now() - start).count();
    for (const colod::Building& b : impl->product.scene.buildings)
      impl->buildings.push_back(building_of(b));
    return Scene(std::move(impl));
  }
};

const char* version() { return COLOD_VERSION; }

Error::Error(Fault fault, const std::string& item, const std::string& cause)
    : std::runtime_error(item + ": " + cause), fault_(fault), item_(item) {}
Error::~Error() = default;

std::vector<OptionInfo> list_options() {
  Settings settings;
  std::vector<OptionInfo> all;
  for (const CLI::Option* option : settings.app.get_options())
    all.push_back(
        {option->get_lnames().front(), option->get_description(), option->get_expected_max() == 0});
  return all;
}

Scene::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

const std::vector<Building>& Scene::buildings() const { return impl_->buildings; }

Mesh Scene::mesh(std::size_t building, std::size_t layer) const {
  const std::vector<colod::Building>& all = impl_->product.scene.buildings;
  if (building >= all.size() || layer >= all[building].layers.size())
    throw Error(Fault::kUsage, "mesh",
                "there is no layer " + std::to_string(layer) + " of building " +
                    std::to_string(building) + " (both counted from 0)");
  return mesh_of(all[building].layers[layer].mesh);
}

std::vector<Message> Scene::messages() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<Message> all = impl_->notes;
  for (const colod::Message& m : colod::problems_of(impl_->product.scene))
    all.push_back(message_of(m));
  return all;
}

int Scene::status() const {
  const std::lock_guard lock(impl_->mutex);
  return colod::exit_code(impl_->product.scene);
}

std::string Scene::report_json() const {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->report.empty()) translated([&] { impl_->encode([](const colod::Encoded&) {}); });
  return impl_->report;
}

std::vector<File> Scene::files() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<File> all;
  std::mutex taking;
  translated([&] {
    impl_->encode([&](const colod::Encoded& file) {
      const std::lock_guard taken(taking);
      all.push_back({file.path, file.bytes});
    });
  });
  std::sort(all.begin(), all.end(), [](const File& a, const File& b) { return a.path < b.path; });
  return all;
}

void Scene::write(const std::string& folder) const {
  const std::lock_guard lock(impl_->mutex);
  translated([&] {
    colod::make_folder(folder);
    impl_->encode([&](const colod::Encoded& file) { colod::write_file(folder, file); });
  });
}

Scene build(const std::vector<std::string>& paths, const Options& options,
            const Callbacks& callbacks) {
  return translated([&] {
    Settings settings;
    settings.set(options);
    return Access::build(paths, settings, callbacks);
  });
}

Scene build_meshes(const std::vector<NamedMesh>& meshes, const Options& options,
                   const Callbacks& callbacks) {
  return translated([&] {
    Settings settings;
    for (const char* name : {"split", "recursive"})
      if (options.count(name) > 0) throw Error(Fault::kUsage, name, "is for files, not for arrays");
    settings.set(options);
    std::vector<colod::NamedArrays> arrays;
    for (const NamedMesh& m : meshes)
      arrays.push_back({m.name,
                        vectors_of(m.points),
                        vectors_of(m.normals),
                        {m.triangles.begin(), m.triangles.end()}});
    return Access::build(arrays, settings, callbacks);
  });
}

}  // namespace colod_v0
