// How a scene was opened ↔ a line of JSON, so that a later stage opens it again.
#pragma once

#include <string>
#include <vector>

#include "pipeline/pipeline.h"
#include "publish/messages.h"
#include "read/read.h"
#include "scene_choice.h"
#include "scene_input.h"

namespace colod {

struct PlaceRecord {
  std::string input;  ///< where it lies, whatever folder a later stage runs in
  ReadOptions read;
  SceneChoice choice;
};

std::string to_json(const PlaceRecord& record);
/// Throws std::exception where that is no record.
PlaceRecord place_record_of(const std::string& json);

/// Opens a place again and gives a scene of its buildings what it has beside them (add_place).
/// Where that cannot be, or the place has other buildings now, a failure of the scene says so: it
/// is written without.
void add_place_again(const PlaceRecord& record, const SceneOutput& output, const Tell& tell,
                     Scene& built);

}  // namespace colod
