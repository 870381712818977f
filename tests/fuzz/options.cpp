// Any numbers as options: an Error, or options that all lie in their ranges.
//   fuzz_options CORPUS -max_len=256
#include "core/options.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  colod::Options options;
  for (const colod::OptionInfo& info : colod::option_table()) {
    double value = 0;
    if (size < sizeof value) break;
    std::memcpy(&value, data, sizeof value);
    data += sizeof value, size -= sizeof value;
    // Whole numbers are held to their range before they are stored.
    if (info.is_integer && !(value >= info.min && value <= info.max)) continue;
    info.set(options, value);
  }
  try {
    colod::validate(options);
  } catch (const colod::Error&) {
    return 0;
  }
  for (const colod::OptionInfo& info : colod::option_table())
    if (!std::isfinite(info.get(options))) std::abort();
  return 0;
}
