// Based on: PROJ 9's C interface.
#include "proj_objects.h"

namespace colod {

namespace {

/// A CRS without a shift to WGS 84 that its text binds it to.
PjPtr unbound(PJ_CONTEXT* context, PjPtr crs) {
  if (!crs || proj_get_type(crs.get()) != PJ_TYPE_BOUND_CRS) return crs;
  return PjPtr(proj_get_source_crs(context, crs.get()));
}

}  // namespace

ContextPtr make_context() {
  ContextPtr context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  return context;
}

PjPtr horizontal_part(PJ_CONTEXT* context, PJ* crs, bool is_unbound) {
  PjPtr flat(proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS ? proj_crs_get_sub_crs(context, crs, 0)
                                                        : proj_clone(context, crs));
  return is_unbound ? unbound(context, std::move(flat)) : std::move(flat);
}

PjPtr vertical_part(PJ_CONTEXT* context, PJ* crs) {
  if (proj_get_type(crs) != PJ_TYPE_COMPOUND_CRS) return nullptr;
  return unbound(context, PjPtr(proj_crs_get_sub_crs(context, crs, 1)));
}

double axis_unit(PJ_CONTEXT* context, PJ* crs, int axis, std::string* name) {
  const PjPtr system(proj_crs_get_coordinate_system(context, crs));
  double metres = 1;
  const char* text = nullptr;
  if (system && axis < proj_cs_get_axis_count(context, system.get()))
    proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr, &metres, &text,
                          nullptr, nullptr);
  if (name && text) *name = text;
  return metres;
}

}  // namespace colod
