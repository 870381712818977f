// From a finished scene to what exporters see.
#pragma once

#include "exporters/exporter.h"
#include "pipeline/pipeline.h"

namespace colod {

/// A building's levels after decide_switches: layers that are alike become one, which may stand
/// from where its finest may. No level where the building failed.
ExportBuilding export_building(const Building& building);

/// How the scene's switches were decided.
SwitchFacts switch_facts(const Switching& switching);

}  // namespace colod
