// report.html: one page that shows what report.json says, with pictures. Nothing in it points
// outside.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "exporters/exporter.h"

namespace colod {

struct HtmlReport {
  std::string report;  ///< JSON text as in report.json
  std::string parts;   ///< JSON text: clusters and similarities of the co-analysis; may be empty
  std::vector<std::vector<std::string>> pictures;  ///< per building of the report: PNG bytes of the
                                                   ///< source, then of each layer; then, where it
                                                   ///< has textures, JPEGs of them; empty: none
  std::vector<std::string> layer_colors;           ///< CSS colours of the layers in the pictures
  /// Where `report` has no buildings: how many there are, and each one's JSON text.
  std::size_t buildings = 0;
  std::function<std::string(std::size_t)> building = {};
};

/// The page: the shell of exporters/html_report/ (HTML, styles and scripts) and the data, each as a
/// block of JSON in which nothing can end the block. Numbers are rounded to 6 digits, a building's
/// warnings to 20 of 400 characters: besides pictures about 3.3 kB a building of three layers. The
/// shell shows text as text, whatever is in it.
Encoded encode_html_report(const HtmlReport& report);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace colod
