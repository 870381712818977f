#include "output.h"

#include "exporters/files.h"

namespace colod::cli {

void add_output_arguments(CLI::App& app, OutputArguments& a) {
  app.add_option("-o,--out", a.out, "folder to write to")->required();
  add_output_options(app, a.options);
}

void log_problems(const Scene& scene, const Log& log) { log.messages(problems_of(scene)); }

int write_all(Scene& scene, const Options& options, std::chrono::steady_clock::time_point start,
              Pictures pictures, Depot& depot, const OutputArguments& a, const Log& log) {
  encode_scene(
      scene, a.options, depot, [&](const Encoded& file) { write_file(a.out, file); },
      [&](const Message& m) { log.message(m); }, &pictures);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  for (const Encoded& file : encode_report(scene, options, {seconds.count(), peak_memory_bytes()},
                                           std::move(pictures), a.options))
    write_file(a.out, file);
  log_problems(scene, log);
  log.message(summary_of(scene, tally_of(scene), seconds.count(), a.out));
  return exit_code(scene);
}

}  // namespace colod::cli
