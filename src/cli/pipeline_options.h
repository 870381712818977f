// The options of the pipeline and of running it, shared by `build` and the stages.
#pragma once

#include <cmath>
#include <iomanip>
#include <sstream>

#include "cli.h"
#include "core/error.h"
#include "core/options.h"
#include "log.h"
#include "numbers.h"
#include "rules/rules.h"

namespace colod::cli {

struct RunArguments {
  int threads = 0;
  bool is_quiet = false, is_json_log = false;

  Log log() const { return {is_quiet, is_json_log}; }
};

inline void add_run_options(CLI::App& app, RunArguments& a) {
  app.add_option("--threads", a.threads, "threads to use, 0 = all cores")
      ->check(number_between(0, 4096));
  app.add_flag("--quiet", a.is_quiet, "errors only");
  app.add_flag("--log-json", a.is_json_log, "progress and messages as JSON lines on stderr");
}

/// --config FILE (TOML or INI): its values stand for options that the command line leaves out. Call
/// it before the options it may set are added: options are processed in the order in which they
/// were added. CLI11's own set_config reads files for the root command only.
inline void add_config_option(CLI::App& app) {
  app.add_option_function<std::string>(
         "--config",
         [&app](const std::string& path) {
           for (const CLI::ConfigItem& item : CLI::ConfigTOML().from_file(path)) {
             CLI::Option* option = app.get_option_no_throw("--" + item.fullname());
             if (option == nullptr || item.name == "config" || item.name == "help")
               throw Error(Stage::kUsage, path, "unknown option '" + item.fullname() + "'");
             if (option->count() == 0)
               for (const std::string& value : item.inputs) option->add_result(value);
           }
         },
         "TOML or INI file with any of these options")
      ->check(CLI::ExistingFile);
}

inline void add_prior_option(CLI::App& app, std::string& path) {
  app.add_option("--prior", path,
                 "an analysed scene file: each building for itself gets the layers it learnt")
      ->check(CLI::ExistingFile);
}

/// --rules, which the others' defaults hang on, and --without.
inline void add_rule_options(CLI::App& app, Options& options) {
  app.add_option_function<std::string>(
         "--rules",
         [&options](const std::string& v) {
           options = default_options(v == "paper" ? RuleSet::none() : RuleSet::all());
         },
         "robust (default) or the paper's letter")
      ->check(CLI::IsMember({"robust", "paper"}));
  app.add_option_function<std::vector<std::string>>(
         "--without",
         [&options](const std::vector<std::string>& ids) {
           if (options.rules.is_none())
             throw Error(Stage::kUsage, "--without", "--rules paper has no rule on");
           for (const std::string& id : ids)
             options.rules = options.rules.without(rule_named(id, "--without"));
         },
         "rules to switch off, with commas between them; colod rules lists them")
      ->delimiter(',')
      ->allow_extra_args(false);
}

/// --rules, --without, --visibility, --layering and every row of the option table.
inline void add_pipeline_options(CLI::App& app, Options& options) {
  add_rule_options(app, options);
  app.add_option_function<std::string>(
         "--visibility",
         [&options](const std::string& v) { options.visibility = visibility_of(v); },
         "what casts the rays: sweep (default), which asks Embree where it is in doubt, or embree "
         "for "
         "all of them (default with --rules paper): the same hits in several times the time")
      ->check(CLI::IsMember({"embree", "sweep"}));
  app.add_option_function<std::string>(
         "--layering", [&options](const std::string& v) { options.is_size_layering = v == "size"; },
         "layers beyond 0: spectral (default), or thresholds on size")
      ->check(CLI::IsMember({"spectral", "size"}));
  for (const OptionInfo& info : option_table()) {
    const auto set = [&options, &info](const double& value) {
      if (info.is_integer &&
          (!(value >= info.min && value <= info.max) || value != std::floor(value))) {
        std::ostringstream range;
        range << std::setprecision(16) << info.min << " to " << info.max;
        throw Error(Stage::kUsage, "--" + info.name, "must be a whole number from " + range.str());
      }
      info.set(options, value);
    };
    std::ostringstream help;
    help << info.help << (info.unit.empty() ? "" : " [" + info.unit + "]") << ", default "
         << info.get(Options{});
    std::ostringstream range;
    range << (info.is_integer ? "whole number" : "number") << " from " << info.min << " to "
          << info.max;
    app.add_option_function<double>("--" + info.name, set, help.str())->type_name(range.str());
  }
}

}  // namespace colod::cli
