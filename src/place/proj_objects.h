// Inside room `place` only: PROJ's objects as owners, and what is asked of reference systems.
#pragma once

#include <proj.h>

#include <memory>
#include <string>

namespace colod {

struct ContextDeleter {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct PjDeleter {
  void operator()(PJ* pj) const { proj_destroy(pj); }
};
using ContextPtr = std::unique_ptr<PJ_CONTEXT, ContextDeleter>;
using PjPtr = std::unique_ptr<PJ, PjDeleter>;

/// Says nothing on stderr.
ContextPtr make_context();

/// The horizontal part of a compound CRS, else the CRS itself; without a shift to WGS 84 that its
/// text binds it to where `is_unbound`.
PjPtr horizontal_part(PJ_CONTEXT* context, PJ* crs, bool is_unbound);

/// The vertical part of a compound CRS; null: it has none.
PjPtr vertical_part(PJ_CONTEXT* context, PJ* crs);

/// Metres in the unit of a CRS's axis, and its name; 1 where it has no such axis.
double axis_unit(PJ_CONTEXT* context, PJ* crs, int axis, std::string* name = nullptr);

}  // namespace colod
