// What is new in scene files that were analysed before → its layers, the others' as they were.
#pragma once

#include <string>
#include <vector>

#include "log.h"
#include "store/store.h"

namespace colod::cli {

/// Places the buildings of `scene` that no analysis knows by what the others learnt, and keeps that
/// in their files. `file_of`: per building. Throws Error{kInput} where nothing of an analysis is
/// left, or a file has other options than when it was analysed.
void update_analysis(const std::vector<std::string>& files, std::vector<Store>& stores, Scene scene,
                     std::vector<std::size_t> file_of, const Log& log);

}  // namespace colod::cli
