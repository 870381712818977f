// The page of exporters/html_report/ as one text: CMake puts it together (colod_page).
#pragma once

#include <string_view>

namespace colod {

extern const std::string_view kHtmlReportShell;

}  // namespace colod
