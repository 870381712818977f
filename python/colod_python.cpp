// The Python module: colod.h with numpy arrays for vectors, a dict for the report, and Ctrl-C.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <functional>
#include <future>

#include "colod/colod.h"

namespace py = pybind11;
using namespace py::literals;

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// Rows of three as an array of shape (n, 3).
template <typename T>
py::array_t<T> rows(const std::vector<std::array<T, 3>>& from) {
  py::array_t<T> to({static_cast<py::ssize_t>(from.size()), py::ssize_t{3}});
  if (!from.empty()) std::memcpy(to.mutable_data(), from.data(), from.size() * sizeof from[0]);
  return to;
}

py::array_t<std::int32_t> column(const std::vector<std::int32_t>& from) {
  return py::array_t<std::int32_t>(static_cast<py::ssize_t>(from.size()), from.data());
}

template <typename T, typename Array>
std::vector<std::array<T, 3>> rows_of(const Array& from, const char* what) {
  if (from.size() == 0) return {};
  if (from.ndim() != 2 || from.shape(1) != 3)
    throw py::value_error(std::string(what) + " must have the shape (n, 3)");
  std::vector<std::array<T, 3>> to(static_cast<std::size_t>(from.shape(0)));
  std::memcpy(to.data(), from.data(), to.size() * sizeof to[0]);
  return to;
}

/// A dictionary name → points, (points, triangles) or (points, triangles, normals).
std::vector<colod::NamedMesh> meshes_of(const py::dict& from) {
  std::vector<colod::NamedMesh> to;
  for (const auto& [name, value] : from) {
    colod::NamedMesh mesh;
    mesh.name = py::str(name);
    py::tuple parts = py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)
                          ? py::tuple(py::reinterpret_borrow<py::object>(value))
                          : py::make_tuple(value);
    if (parts.empty() || parts.size() > 3)
      throw py::value_error(mesh.name +
                            ": must be points, (points, triangles) or (points, "
                            "triangles, normals)");
    mesh.points = rows_of<double>(parts[0].cast<Numbers>(), "points");
    if (parts.size() > 1 && !parts[1].is_none())
      mesh.triangles = rows_of<std::int32_t>(parts[1].cast<Indices>(), "triangles");
    if (parts.size() > 2) mesh.normals = rows_of<double>(parts[2].cast<Numbers>(), "normals");
    to.push_back(std::move(mesh));
  }
  return to;
}

std::vector<std::string> paths_of(const py::object& from) {
  const py::object path = py::module_::import("os").attr("fspath");
  if (py::isinstance<py::str>(from) || py::hasattr(from, "__fspath__"))
    return {path(from).cast<std::string>()};
  std::vector<std::string> to;
  for (const py::handle& item : from) to.push_back(path(item).cast<std::string>());
  return to;
}

/// An option's value as the command line spells it.
std::string spelled(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    std::string all;
    for (const py::handle& item : value)
      all += (all.empty() ? "" : ",") + std::string(py::str(item));
    return all;
  }
  return py::str(value);
}

colod::Options options_of(const py::kwargs& from) {
  colod::Options to;
  for (const auto& [key, value] : from) {
    std::string name = py::str(key);
    for (char& c : name)
      if (c == '_') c = '-';
    if (!value.is_none()) to[name] = spelled(value);
  }
  return to;
}

/// Waits for a job. This thread, which alone hears of Ctrl-C, then stops it and returns true.
bool listen_until(const std::future<colod::Scene>& job, std::atomic<bool>& is_stopped) {
  const py::gil_scoped_release unlock;
  while (job.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
    const py::gil_scoped_acquire lock;
    if (!is_stopped && PyErr_CheckSignals() != 0) is_stopped = true;
  }
  return is_stopped;
}

using Job = std::function<colod::Scene(const colod::Callbacks&)>;

/// A job in a thread of its own.
colod::Scene run(const Job& body, const py::object& progress) {
  std::atomic<bool> is_stopped = false;
  colod::Callbacks callbacks;
  callbacks.cancel = [&] { return is_stopped.load(); };
  if (!progress.is_none())
    callbacks.progress = [&](const colod::Progress& p) {
      const py::gil_scoped_acquire lock;
      progress(p.building, p.stage, p.done, p.total);
    };
  std::future<colod::Scene> job = std::async(std::launch::async, body, callbacks);
  if (listen_until(job, is_stopped)) throw py::error_already_set();
  return job.get();
}

colod::Scene build(const py::object& inputs, const py::object& progress,
                   const py::kwargs& keywords) {
  const colod::Options options = options_of(keywords);
  if (!py::isinstance<py::dict>(inputs)) {
    const std::vector<std::string> paths = paths_of(inputs);
    return run([&](const auto& calls) { return colod::build(paths, options, calls); }, progress);
  }
  const std::vector<colod::NamedMesh> meshes = meshes_of(inputs.cast<py::dict>());
  return run([&](const auto& calls) { return colod::build_meshes(meshes, options, calls); },
             progress);
}

/// A layer, which keeps its scene alive.
struct LayerOfScene {
  py::object scene;
  std::size_t building, layer;

  const colod::Layer& get() const {
    return scene.cast<const colod::Scene&>().buildings()[building].layers[layer];
  }
  colod::Mesh mesh() const { return scene.cast<const colod::Scene&>().mesh(building, layer); }
};

struct BuildingOfScene {
  py::object scene;
  std::size_t building;

  const colod::Building& get() const {
    return scene.cast<const colod::Scene&>().buildings()[building];
  }
  std::vector<LayerOfScene> layers() const {
    std::vector<LayerOfScene> all;
    for (std::size_t k = 0; k < get().layers.size(); ++k) all.push_back({scene, building, k});
    return all;
  }
};

/// Per polygon its rings, each an array of point numbers.
py::list polygons_of(const colod::Mesh& m) {
  py::list polygons;
  for (std::size_t p = 0; p + 1 < m.polygon_rings.size(); ++p) {
    py::list rings;
    for (int r = m.polygon_rings[p]; r < m.polygon_rings[p + 1]; ++r)
      rings.append(py::array_t<std::int32_t>(m.ring_offsets[r + 1] - m.ring_offsets[r],
                                             m.ring_points.data() + m.ring_offsets[r]));
    polygons.append(rings);
  }
  return polygons;
}

const char* level_name(colod::Message::Level level) {
  return level == colod::Message::Level::kError     ? "error"
         : level == colod::Message::Level::kWarning ? "warning"
                                                    : "info";
}

const char* fault_name(colod::Fault fault) {
  switch (fault) {
    case colod::Fault::kUsage:
      return "usage";
    case colod::Fault::kInput:
      return "input";
    case colod::Fault::kProcess:
      return "process";
    case colod::Fault::kOutput:
      return "output";
    case colod::Fault::kCancelled:
      return "cancelled";
  }
  return "";
}

void define_error(py::module_& m) {
  static py::handle type = py::exception<colod::Error>(m, "Error", PyExc_RuntimeError).inc_ref();
  type.attr("__doc__") =
      "Why a job stopped. `fault`: usage, input, process, output or cancelled; `item`: the option, "
      "file or building.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const colod::Error& e) {
      py::object error = type(e.what());
      error.attr("fault") = fault_name(e.fault());
      error.attr("item") = e.item();
      PyErr_SetObject(type.ptr(), error.ptr());
    }
  });
}

void define_mesh(py::module_& m) {
  py::class_<colod::Mesh>(m, "Mesh", "Polygons with holes, and the same surface as triangles.")
      .def_property_readonly(
          "points", [](const colod::Mesh& s) { return rows(s.points); },
          "(n, 3) metres, local to the building")
      .def_property_readonly(
          "triangles", [](const colod::Mesh& s) { return rows(s.triangles); },
          "(m, 3) numbers of points, counter-clockwise from outside")
      .def_property_readonly(
          "polygon_of_triangle", [](const colod::Mesh& s) { return column(s.polygon_of_triangle); },
          "(m,)")
      .def_property_readonly(
          "normals", [](const colod::Mesh& s) { return rows(s.normals); },
          "(p, 3), unit, outward; one a polygon")
      .def_property_readonly("polygons", polygons_of,
                             "per polygon its rings, each an array of numbers of points: the "
                             "border first, then holes");
}

void define_parts(py::module_& m) {
  const auto layer = [](auto member) {
    return [member](const LayerOfScene& s) { return s.get().*member; };
  };
  py::class_<LayerOfScene>(m, "Layer", "A level of detail; layer 0 is the coarsest.")
      .def_property_readonly("layer", layer(&colod::Layer::layer))
      .def_property_readonly("gsd", layer(&colod::Layer::gsd),
                             "metres a pixel: it may be shown where a pixel covers at least that")
      .def_property_readonly("deviation", layer(&colod::Layer::deviation),
                             "metres, two-sided, from the finest layer")
      .def_property_readonly("is_like_finer", layer(&colod::Layer::is_like_finer))
      .def_property_readonly("failure", layer(&colod::Layer::failure),
                             "why it has no mesh; empty: it has")
      .def_property_readonly("mesh", &LayerOfScene::mesh, "a new Mesh");
  const auto building = [](auto member) {
    return [member](const BuildingOfScene& s) { return s.get().*member; };
  };
  py::class_<BuildingOfScene>(m, "Building")
      .def_property_readonly("name", building(&colod::Building::name))
      .def_property_readonly("given_name", building(&colod::Building::given_name))
      .def_property_readonly("source", building(&colod::Building::source))
      .def_property_readonly("origin", building(&colod::Building::origin),
                             "of its meshes, in the input's coordinates")
      .def_property_readonly("failure", building(&colod::Building::failure))
      .def_property_readonly("has_lost", building(&colod::Building::has_lost))
      .def_property_readonly("layers", &BuildingOfScene::layers, "coarsest first");
}

std::vector<BuildingOfScene> buildings_of(const py::object& scene) {
  std::vector<BuildingOfScene> all;
  for (std::size_t i = 0; i < scene.cast<const colod::Scene&>().buildings().size(); ++i)
    all.push_back({scene, i});
  return all;
}

py::dict files_of(const colod::Scene& scene) {
  std::vector<colod::File> files;
  {
    const py::gil_scoped_release unlock;
    files = scene.files();
  }
  py::dict all;
  for (const colod::File& f : files) all[py::str(f.path)] = py::bytes(f.bytes);
  return all;
}

py::list messages_of(const colod::Scene& scene) {
  py::list all;
  for (const colod::Message& message : scene.messages())
    all.append(py::make_tuple(level_name(message.level), message.text));
  return all;
}

void define_scene(py::module_& m) {
  py::class_<colod::Scene>(m, "Scene", "A finished scene.")
      .def_property_readonly("buildings", buildings_of, "sorted by name")
      .def_property_readonly("messages", messages_of, "(level, text): failures, losses, warnings")
      .def_property_readonly("status", &colod::Scene::status,
                             "0: all done and nothing lost; else as the program's exit code")
      .def_property_readonly(
          "report",
          [](const colod::Scene& s) {
            return py::module_::import("json").attr("loads")(s.report_json());
          },
          "report.json as a dict")
      .def("files", files_of, "All files that write() writes: {path: bytes}.")
      .def(
          "write",
          [](const colod::Scene& s, const py::object& folder) {
            const std::string path = paths_of(folder).front();
            const py::gil_scoped_release unlock;
            s.write(path);
          },
          "folder"_a, "Writes GLBs, tilesets and reports, as the option `format` asked.");
}

py::dict options_list() {
  py::dict all;
  for (const colod::OptionInfo& o : colod::list_options()) {
    std::string name = o.name;
    for (char& c : name)
      if (c == '-') c = '_';
    all[py::str(name)] = o.help;
  }
  return all;
}

}  // namespace

PYBIND11_MODULE(colod, m) {
  m.doc() = "Chains of clean, watertight levels of detail, consistent over all buildings.";
  m.attr("__version__") = colod::version();
  define_error(m);
  define_mesh(m);
  define_parts(m);
  define_scene(m);
  m.def("options", options_list, "What build() takes as keywords: {name: help}.");
  m.def("build", build, "inputs"_a, py::kw_only(), "progress"_a = py::none(),
        R"(The levels of detail of all buildings, as a Scene.

inputs: a path or several (files and folders), or a dict {name: points}, {name: (points, triangles)} or
{name: (points, triangles, normals)} of arrays of shape (n, 3); each entry is one building.
progress: called as progress(building, stage, done, total) from any thread; what it raises ends the job.
Keywords: the options of `colod build` with _ for -, such as layers=3, format=["glb", "obj"];
options() lists them. Ctrl-C ends the job. Raises colod.Error.)");
}
