// The options of the whole job but for inputs, folder and threads: those of `colod build`, and
// those that a caller of the library may set.
#pragma once

#include "cli.h"
#include "input_options.h"
#include "job/job.h"
#include "output_options.h"
#include "pipeline_options.h"

namespace colod::cli {

inline void add_job_options(CLI::App& app, Job& job) {
  add_output_options(app, job.output);
  add_input_options(app, job.read);
  add_folder_options(app, job.read);
  add_scene_options(app, job.scene);
  add_pipeline_options(app, job.options);
  add_prior_option(app, job.prior);
  app.add_option("--truth", job.truth,
                 "a ground truth of parts: how consistent the layers are goes into report.json")
      ->check(CLI::ExistingFile);
}

}  // namespace colod::cli
